// SPDX-License-Identifier: Apache-2.0
//
// Joints that are told of a depth image, against those of the simulator's hand, whose proportions
// are its own.
#include <algorithm>
#include <array>
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

/// Errors of every joint, mm, over two seconds of a hand at rest, in perfect depth.
/// @param path how it is held; empty: open
std::map<Joint, std::vector<double>> errors_of(SimHand side, double hand_length_mm,
                                               const std::vector<SimPath>& path = {}) {
    SimSettings settings = *SimSettings::preset("ideal-60");
    settings.user.hand_length_mm = hand_length_mm;
    settings.user.visible_body = false;
    if (path.empty()) {
        settings.script = {{SimAction::idle, side, -1.0, 2.0, Vec3f::Zero()}};
    } else {
        settings.paths = path;
        settings.duration_s = 2.0;
    }
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

using Fingers = std::array<float, kSimAngleCount>;

/// Fingers that are folded, but for the first `straight` of index to little finger.
Fingers folded_but(int straight, float share) {
    constexpr std::array<float, 4> kFolded{1.45F, 0.0F, 1.7F, 0.9F};
    constexpr std::array<float, 4> kStraight{0.05F, 0.0F, 0.05F, 0.03F};
    constexpr std::array<float, 4> kThumb{0.9F, -0.1F, 0.6F, 0.8F};
    Fingers fingers{};
    for (std::size_t i = 0; i < fingers.size(); ++i) {
        const std::size_t finger = i / 4;
        const bool is_straight = finger >= 1 && static_cast<int>(finger) <= straight;
        fingers[i] = finger == 0   ? share * kThumb[i % 4]
                     : is_straight ? kStraight[i % 4]
                                   : share * kFolded[i % 4];
    }
    return fingers;
}

/// A camera does not see the joints of a bent finger: they are not told, and what is told holds.
TEST_P(JointsOf, ABentHandAreToldWhereTheyAreOrNotAtAll) {
    const auto [side, length_mm] = GetParam();
    struct Shape {
        const char* name;
        Fingers fingers;
        double most_far;  ///< share of what is told that is off by more than 30 mm
        double wrist_mm;
    };
    // Half bent fingers look like straight ones from before, and a knuckle like a thumb's tip.
    const std::array<Shape, 4> shapes{{{"fist", folded_but(0, 1.0F), 0.05, 40.0},
                                       {"half closed", folded_but(0, 0.5F), 0.30, 55.0},
                                       {"pointing", folded_but(1, 1.0F), 0.30, 40.0},
                                       {"victory", folded_but(2, 1.0F), 0.05, 40.0}}};
    for (const Shape& shape : shapes) {
        SimPath path;
        path.hand = side;
        for (const double t_s : {0.0, 1.0, 2.0}) {
            SimPose pose;
            pose.t_s = t_s;
            pose.palm_mm = {t_s == 1.0 ? 10.0F : 0.0F, 20.0F, 600.0F};
            pose.fingers_rad = shape.fingers;
            path.poses.push_back(pose);
        }
        auto errors = errors_of(side, length_mm, {path});
        ASSERT_TRUE(errors.contains(Joint::palm) && errors.contains(Joint::wrist)) << shape.name;
        const double palm_mm = median(errors[Joint::palm]);
        const double wrist_mm = median(errors[Joint::wrist]);
        errors.erase(Joint::wrist);
        std::vector<double> all;
        double far = 0.0;
        for (const auto& [joint, mm] : errors) {
            for (const double off : mm) {
                all.push_back(off);
                far += off > 30.0 ? 1.0 : 0.0;
            }
        }
        const double share = far / static_cast<double>(all.size());
        std::printf(
            "%-12s palm %4.1f mm, wrist %4.1f mm; %2zu joints told, median %4.1f mm, over 30 "
            "mm %.1f %%\n",
            shape.name, palm_mm, wrist_mm, errors.size() + 1, median(all), 100.0 * share);
        EXPECT_LE(palm_mm, 20.0) << shape.name;
        EXPECT_LE(wrist_mm, shape.wrist_mm) << shape.name;
        EXPECT_LE(median(all), 25.0) << shape.name;
        EXPECT_LE(share, shape.most_far) << shape.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Hands, JointsOf,
                         ::testing::Combine(::testing::Values(SimHand::left, SimHand::right),
                                            ::testing::Values(165.0, 200.0)));

}  // namespace
}  // namespace xtrack::test
