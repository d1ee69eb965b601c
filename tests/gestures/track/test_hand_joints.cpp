// SPDX-License-Identifier: Apache-2.0
//
// Joints that are told of a depth image, against those of the simulator's hand, whose proportions
// are its own.
#include <algorithm>
#include <cstdio>
#include <map>
#include <vector>

#include <gtest/gtest.h>
#include <xtrack/hand_tracker.hpp>
#include <xtrack/sim.hpp>

namespace xtrack::test {
namespace {

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Errors of every joint, mm, over two seconds of an open hand at rest, in perfect depth.
std::map<Joint, std::vector<double>> errors_of(SimHand side, double hand_length_mm) {
    SimSettings settings = *SimSettings::preset("ideal-60");
    settings.user.hand_length_mm = hand_length_mm;
    settings.user.visible_body = false;
    settings.script = {{SimAction::idle, side, -1.0, 2.0, Vec3f::Zero()}};
    auto rig = std::move(*SimulatedRig::create(settings));
    auto tracker = std::move(*HandTracker::create(rig->rig(), rig->rig().camera.size));
    std::map<Joint, std::vector<double>> errors;
    for (int i = 0; rig->next(std::chrono::seconds{1}).status == SourceStatus::ok; ++i) {
        if (i % 10 != 0) {
            continue;
        }
        const SimTruth& truth = rig->truth();
        DepthFrame depth;
        depth.stamp = truth.stamp;
        depth.depth = truth.depth;
        depth.depth_unit_mm = kDepthUnitMm;
        const HandFrame& seen = tracker.track(depth);
        if (seen.count != 1 || i < 30) {
            continue;
        }
        for (std::size_t j = 0; j < kJointCount; ++j) {
            const TrackedPoint& joint = seen.hands[0].joints[j];
            if (joint.valid) {
                errors[static_cast<Joint>(j)].push_back(
                    static_cast<double>((joint.position_mm - truth.hands[0].joints_mm[j]).norm()));
            }
        }
        EXPECT_FALSE(seen.hands[0].articulated);
    }
    return errors;
}

class JointsOf : public ::testing::TestWithParam<std::tuple<SimHand, double>> {};

TEST_P(JointsOf, AnOpenHandLieWithinAFingersWidth) {
    const auto [side, length_mm] = GetParam();
    const auto errors = errors_of(side, length_mm);
    EXPECT_EQ(errors.size(), kJointCount) << "all joints of an open hand are told";
    std::vector<double> all;
    for (const auto& [joint, mm] : errors) {
        std::printf("%-20s %5.1f mm, %zu images\n", to_string(joint), median(mm), mm.size());
        EXPECT_LE(median(mm), 25.0) << to_string(joint);
        all.push_back(median(mm));
    }
    EXPECT_LE(median(all), 15.0);
}

INSTANTIATE_TEST_SUITE_P(Hands, JointsOf,
                         ::testing::Combine(::testing::Values(SimHand::left, SimHand::right),
                                            ::testing::Values(165.0, 200.0)));

}  // namespace
}  // namespace xtrack::test
