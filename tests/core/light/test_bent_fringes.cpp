// SPDX-License-Identifier: Apache-2.0
// Depth from a projector that bends its fringes, before and after its response was measured.
#include <cmath>
#include <cstdio>
#include <optional>

#include <gtest/gtest.h>

#include <xtrack/depth_decoder.hpp>
#include <xtrack/phase_ripple.hpp>

#include "tests/core/light/shown_light.hpp"

namespace xtrack {
namespace {

class BentFringes : public testing::TestWithParam<test::BentProjector> {};

struct Seen {
    double rms_mm = 0.0;
    double ripple_rad = 0.0;
};

// Depth of the wall, and the ripple of the shorter fringes, by the whole camera: of a quarter of
// its pixels they would be blurred.
Seen decode(SimSettings s, Method method, int frames,
            const std::optional<ProjectorResponse>& response) {
    s.rig.camera = SimSettings::preset("ideal-60")->rig.camera;
    s.patterns = method_sequence(method, s.rig, s.patterns.axis).value();
    s.duration_s = frames / s.camera.frame_hz;
    PatternSequence believed = s.patterns;
    believed.response = response;
    DecodeSettings settings;
    settings.motion = MotionHandling::off;
    settings.keep_maps = true;
    auto decoder = DepthDecoder::create(s.rig, believed, s.rig.camera.size, settings).value();
    const auto rig = test::make_rig(s);
    for (int i = 0; i < frames; ++i) {
        EXPECT_NE(decoder.push(rig->next({}).frame).state, DecodeState::rejected);
    }
    const SimTruth& truth = rig->truth();
    Seen seen;
    double squares = 0.0;
    double count = 0.0;
    for (int y = 0; y < truth.depth.height(); ++y) {
        for (int x = 0; x < truth.depth.width(); ++x) {
            const int error = static_cast<int>(decoder.depth().depth.at(x, y)) -
                              static_cast<int>(truth.depth.at(x, y));
            if (decoder.depth().depth.at(x, y) != 0) {
                squares += 0.01 * error * error;
                count += 1.0;
            }
        }
    }
    seen.rms_mm = std::sqrt(squares / count);
    const auto ripple = measure_ripple(decoder.phase(), 3);
    EXPECT_TRUE(ripple) << ripple.error().message;
    seen.ripple_rad = ripple ? ripple->gamma_rad : 0.0;
    return seen;
}

TEST_P(BentFringes, AreStraightOnceTheResponseIsMeasured) {
    const SimSettings s = test::bent_wall(GetParam());
    const auto found = test::calibrate(s);
    ASSERT_TRUE(found) << found.error().message;
    SimSettings straight = s;
    straight.projector.gamma = 1.0;
    straight.projector.s_curve = {};
    const Seen best = decode(straight, Method::dual, 6, std::nullopt);
    const Seen before = decode(s, Method::dual, 6, std::nullopt);
    const Seen after = decode(s, Method::dual, 6, found->response->response);
    std::printf(
        "%s: depth RMS %.2f -> %.2f mm (linear projector %.2f), ripple at three times the phase "
        "%.4f -> %.4f rad\n",
        GetParam().name, before.rms_mm, after.rms_mm, best.rms_mm, before.ripple_rad,
        after.ripple_rad);
    EXPECT_LT(after.ripple_rad, 0.007);
    EXPECT_GT(before.ripple_rad, 8.0 * after.ripple_rad);
    EXPECT_GT(before.rms_mm, 2.0 * after.rms_mm);
    EXPECT_LT(after.rms_mm, 1.3 * best.rms_mm);
}

// Two colour patterns. What surfaces do to colours is learnt from how fringes are bent, so that
// correcting the phase afterwards is little help; a projector that is handed other values is.
TEST_P(BentFringes, OfColoursAreStraightOnceCompensated) {
    SimSettings s = test::bent_wall(GetParam());
    s.camera.colour = true;
    const auto found = test::calibrate(s);
    ASSERT_TRUE(found) << found.error().message;
    SimSettings straight = s;
    straight.projector.gamma = 1.0;
    straight.projector.s_curve = {};
    SimSettings compensated = s;
    compensated.projector.compensation = found->response->response;
    const Seen best = decode(straight, Method::rgb, 10, std::nullopt);
    const Seen before = decode(s, Method::rgb, 10, std::nullopt);
    const Seen corrected = decode(s, Method::rgb, 10, found->response->response);
    const Seen after = decode(compensated, Method::rgb, 10, std::nullopt);
    std::printf(
        "%s, colour fringes: depth RMS %.1f, phases corrected %.1f, compensated %.1f mm (linear "
        "projector %.1f)\n",
        GetParam().name, before.rms_mm, corrected.rms_mm, after.rms_mm, best.rms_mm);
    EXPECT_LT(corrected.rms_mm, before.rms_mm);
    EXPECT_LT(after.rms_mm, 1.3 * best.rms_mm);
    EXPECT_LT(after.rms_mm, 0.5 * before.rms_mm);
}

INSTANTIATE_TEST_SUITE_P(Simulated, BentFringes, testing::ValuesIn(test::kBentProjectors),
                         test::name_of_projector);

}  // namespace
}  // namespace xtrack
