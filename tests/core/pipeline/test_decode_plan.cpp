// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <xtrack/depth_decoder.hpp>

#include "tests/core/pipeline/plane_scene.hpp"

namespace xtrack {
namespace {

constexpr Size kProjector{512, 384};

Error refusal(const PatternSequence& patterns, DecodeSettings settings = {},
              const Rig& rig = test::plane_rig()) {
    auto made = DepthDecoder::create(rig, patterns, {96, 64}, settings);
    EXPECT_FALSE(made);
    return made ? Error{} : made.error();
}
bool says(const Error& error, ErrorCode code, const char* text) {
    EXPECT_EQ(error.code, code) << error.message;
    EXPECT_NE(error.message.find(text), std::string::npos) << error.message;
    return error.code == code;
}

TEST(DecodePlan, RefusesSequencesThatItHasNoMethodFor) {
    says(refusal(rgb_sequence(Axis::x, kProjector, {32.0})), ErrorCode::unsupported,
         "repeats inside the working volume");
    says(refusal(three_step_sequence(Axis::x, kProjector, 32.0)), ErrorCode::unsupported,
         "repeats inside the working volume");
    Rig open = test::plane_rig();
    open.working_volume.reset();
    says(refusal(three_step_sequence(Axis::x, kProjector, 300.0), {}, open), ErrorCode::unsupported,
         "working_volume_mm");
    PatternSequence two = three_step_sequence(Axis::x, kProjector, 512.0);
    two.patterns.pop_back();
    says(refusal(two), ErrorCode::invalid_argument, "needs 3");
    PatternSequence torn = gray_code_sequence(Axis::x, kProjector, 32.0);
    torn.patterns.erase(torn.patterns.begin() + 3);
    says(refusal(torn), ErrorCode::invalid_argument, "is missing");
    PatternSequence blind = gray_code_sequence(Axis::x, kProjector, 32.0);
    blind.patterns.erase(blind.patterns.begin());
    says(refusal(blind), ErrorCode::unsupported, "flat patterns");
    PatternSequence empty;
    empty.projector_size = kProjector;
    says(refusal(empty), ErrorCode::invalid_argument, "sequence is 0 patterns long");
    PatternSequence other = three_step_sequence(Axis::x, {640, 480}, 640.0);
    says(refusal(other), ErrorCode::invalid_argument, "projector_size");
    DecodeSettings taps;
    taps.taps = PhaseTaps::three_plus_two;
    says(refusal(dual_sequence(Axis::x, kProjector, 512.0, 64.0), taps), ErrorCode::unsupported,
         "least_squares");
    PatternSequence code = gray_code_sequence(Axis::x, kProjector, 32.0);
    std::erase_if(code.patterns, [](const Pattern& p) { return p.kind == PatternKind::sine; });
    for (const OrderSource order : {OrderSource::none, OrderSource::depth_image}) {
        DecodeSettings other_order;
        other_order.order = order;
        says(refusal(code, other_order), ErrorCode::unsupported, "Gray code without sines");
    }
}

TEST(DecodePlan, RefusesSettingsOutOfTheirRange) {
    const PatternSequence wide = three_step_sequence(Axis::x, kProjector, 512.0);
    DecodeSettings settings;
    settings.min_modulation = -1.0;
    says(refusal(wide, settings), ErrorCode::invalid_argument, "min_modulation");
    settings = {};
    settings.order_tolerance = 0.6;
    says(refusal(wide, settings), ErrorCode::invalid_argument, "order_tolerance");
    settings = {};
    settings.motion_tolerance = NAN;
    says(refusal(wide, settings), ErrorCode::invalid_argument, "motion_tolerance");
    EXPECT_TRUE(validate(DecodeSettings{}));
}

}  // namespace
}  // namespace xtrack
