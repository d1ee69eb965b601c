// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/tools/command.hpp"
#include "tools/bench/motion/stroke.hpp"
#include "tools/bench/motion/sweep.hpp"

namespace xtrack::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
namespace bench = tools::bench;

bench::MotionMethod method_named(std::string_view name) {
    const auto methods = bench::motion_methods(bench::motion_rig()).value();
    return *std::find_if(methods.begin(), methods.end(),
                         [&](const bench::MotionMethod& m) { return m.name == name; });
}

bench::Stroke stroke_of(const bench::MotionMethod& method, const Vec3f& velocity_mmps,
                        std::uint64_t seed = 1) {
    return bench::simulate_stroke(bench::MotionCamera::ideal_60, method.patterns, method.colour,
                                  velocity_mmps, seed)
        .value();
}

tools::HandAccuracy measure(const bench::Stroke& stroke, const bench::MotionMethod& method) {
    return bench::measure_stroke(stroke, method.patterns, method.settings).value();
}

TEST(BenchMotion, AHandThatIsHeldStillIsMeasured) {
    const auto method = method_named("three-step");
    const auto stroke = stroke_of(method, Vec3f::Zero());
    ASSERT_EQ(stroke.truths.size(), 12U);
    const auto hand = measure(stroke, method);
    EXPECT_GT(hand.pixels, 12U * 5000U);
    EXPECT_LT(hand.off_percent(), 0.1);
    EXPECT_LT(hand.missing_percent(), 1.0);
    EXPECT_LT(hand.rms_mm(), 3.0);
    EXPECT_GT(hand.rms_mm(), 0.3);  // the camera has noise
}

TEST(BenchMotion, TruthThatIsDisplacedCountsAsOff) {
    const auto method = method_named("three-step");
    auto stroke = stroke_of(method, Vec3f::Zero());
    for (SimTruth& truth : stroke.truths) {
        for (int y = 0; y < truth.depth.height(); ++y) {
            for (int x = 0; x < truth.depth.width(); ++x) {
                truth.depth.at(x, y) = static_cast<std::uint16_t>(truth.depth.at(x, y) + 300);
            }
        }
    }
    EXPECT_GT(measure(stroke, method).off_percent(), 99.0);
}

TEST(BenchMotion, TheHandMovesSoManyMillimetresAFrame) {
    const auto method = method_named("three-step");
    const auto stroke = stroke_of(method, {60.0F * 20.0F, 0.0F, 0.0F});
    ASSERT_EQ(stroke.truths.size(), 9U);  // of 20 mm within 80 mm of the middle
    const auto& first = stroke.truths.front().hands[0];
    const auto& last = stroke.truths.back().hands[0];
    EXPECT_NEAR(last.joints_mm[0].x() - first.joints_mm[0].x(), 8.0 * 20.0, 5.0);
    EXPECT_NEAR(last.joints_mm[0].x() + first.joints_mm[0].x(), 0.0, 30.0);
    // Three steps that are not followed go wrong then.
    EXPECT_GT(measure(stroke, method).off_percent(), 20.0);
}

// An arm goes through the depth at which it looks as the wall behind it: what is cut off by that is
// no wall that came to light, and its turns go on from the rest of the arm.
TEST(BenchMotion, AnArmThatCrossesTheWallsFringeKeepsItsTurns) {
    const auto method = method_named("rgb-static");
    const auto hand = measure(stroke_of(method, {-60.0F * 33.0F, 0.0F, 0.0F}, 2), method);
    EXPECT_GT(hand.pixels, 10'000U);
    EXPECT_LT(hand.off_percent(), 2.0);
    EXPECT_LT(hand.missing_percent(), 1.0);
}

// A hand that came out of the wall's fringe is a fringe off at first; a few images' shadows mend
// it.
TEST(BenchMotion, AWrongFringeIsMendedByWhatShadowsSay) {
    const auto method = method_named("rgb-static");
    const auto hand = measure(stroke_of(method, {0.0F, 0.0F, -60.0F * 10.0F}, 2), method);
    EXPECT_GT(hand.pixels, 10'000U);
    EXPECT_LT(hand.off_percent(), 5.0);
}

TEST(BenchMotion, AStrokeWithoutAnyDepthIsMissing) {
    const auto method = method_named("three-step");
    auto stroke = stroke_of(method, Vec3f::Zero());
    stroke.frames.resize(2);
    const auto hand = measure(stroke, method);
    EXPECT_GT(hand.pixels, 0U);
    EXPECT_EQ(hand.missing_percent(), 100.0);
    EXPECT_FALSE(bench::works(hand));
}

TEST(BenchMotion, WorksIsWhatTheDocumentationSays) {
    tools::HandAccuracy hand;
    EXPECT_FALSE(bench::works(hand));
    hand.pixels = 1000;
    hand.off = 50;
    hand.missing = 150;
    EXPECT_TRUE(bench::works(hand));
    hand.off = 51;
    EXPECT_FALSE(bench::works(hand));
    hand.off = 50;
    hand.missing = 151;
    EXPECT_FALSE(bench::works(hand));
}

TEST(BenchMotion, SaysFiguresAndReferenceAsJson) {
    const Outcome outcome =
        xtrack_command({"bench", "--motion", "--json", "--parts", "speeds", "--methods", "grey"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json motion = json::parse(outcome.out).at("motion");
    ASSERT_EQ(motion.at("methods").size(), 1U);
    const json& grey = motion.at("methods")[0];
    EXPECT_EQ(grey.at("name"), "grey");
    EXPECT_TRUE(grey.at("not_decoded").is_null());
    ASSERT_EQ(grey.at("sideways").size(), bench::kSideways_mm.size());
    ASSERT_EQ(grey.at("toward").size(), bench::kToward_mm.size());
    EXPECT_TRUE(motion.at("fastest").empty());
    const json& five = grey.at("sideways")[2];
    EXPECT_EQ(five.at("mm_per_frame"), 5.0);
    EXPECT_EQ(five.at("reference").at("off_percent"), 4.0);
    EXPECT_GT(five.at("pixels"), 10'000);
    // What the project promises.
    EXPECT_LE(five.at("off_percent"), 5.0);
    // Fast hands are no worse than the reference's, off and missing together.
    const json& fast = grey.at("sideways")[5];
    EXPECT_EQ(fast.at("mm_per_frame"), 17.0);
    EXPECT_LE(fast.at("off_percent").get<double>() + fast.at("missing_percent").get<double>(),
              36.0);
    const json& targets = motion.at("targets");
    EXPECT_EQ(targets[0].at("name"), "rgb");
    EXPECT_TRUE(targets[0].at("reached").is_null());
    EXPECT_EQ(targets[1].at("name"), "grey");
    EXPECT_EQ(targets[1].at("reached"), true);
}

TEST(BenchMotion, RefusesWhatItCannotMeasure) {
    const Outcome missing = xtrack_command(
        {"bench", "--motion", "--parts", "recordings", "--recordings", "/does/not/exist"});
    EXPECT_EQ(missing.status, 1);
    EXPECT_THAT(missing.err, HasSubstr("/does/not/exist"));
    EXPECT_EQ(missing.out, "");
    EXPECT_EQ(xtrack_command({"bench", "--motion", "--methods", "telepathy"}).status, 2);
    EXPECT_EQ(xtrack_command({"bench", "--methods", "grey"}).status, 2);
}

}  // namespace
}  // namespace xtrack::test
