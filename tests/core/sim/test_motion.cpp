// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "core/sim/hand_model.hpp"
#include "core/sim/motion.hpp"
#include "tests/core/sim/small_rig.hpp"

namespace xtrack::sim {
namespace {

double seconds(Stamp s) { return static_cast<double>(s.ns) * 1e-9; }

struct Demo {
    explicit Demo(std::uint64_t seed) : settings(SimSettings::preset("ideal-60").value()) {
        settings.vary(seed);
        hand = settings.script.front().hand;
    }
    [[nodiscard]] HandMotion motion() const { return {settings, hand, hand_model()}; }
    [[nodiscard]] float aperture(const HandMotion& m, double t_s) const {
        const auto scale = static_cast<float>(settings.user.hand_length_mm / kModelHandLengthMm);
        return aperture_mm(hand_model(), pose_bones(m.at(t_s), hand, scale));
    }
    SimSettings settings;
    SimHand hand;
};

TEST(HandModel, IsOneClosedSkin) {
    const HandModel& model = hand_model();
    ASSERT_GT(model.vertices.size(), 4000U);
    // Each edge of a closed surface belongs to two triangles, once in each direction.
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : model.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            ASSERT_LT(t[i], model.vertices.size());
            ++edges[{t[i], t[(i + 1) % 3]}];
        }
    }
    for (const auto& [edge, count] : edges) {
        const auto back = edges.find({edge.second, edge.first});
        ASSERT_TRUE(back != edges.end() && back->second == count);
    }
    for (const HandModel::Vertex& v : model.vertices) {
        EXPECT_NEAR(v.weights[0] + v.weights[1] + v.weights[2] + v.weights[3], 1.0F, 1e-4F);
    }
}

TEST(HandModel, BendsWithoutTearing) {
    // No edge of the skin gets much longer when a pinch closes.
    const HandModel& model = hand_model();
    HandPose pose;
    pose.palm_mm = {0.0F, 0.0F, 650.0F};
    pose.shoulder_mm = {-185.0F, -35.0F, 1000.0F};
    pose.fingers = solve_pinch_closed(model);
    const PosedBones bones = pose_bones(pose, SimHand::right, 1.0F);
    EXPECT_LT(aperture_mm(model, bones), 6.0F);
    std::vector<Vec3f> positions(model.vertices.size());
    std::vector<Vec3f> normals(model.vertices.size());
    skin(model, bones, positions, normals);
    for (const auto& t : model.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = t[i];
            const std::uint32_t b = t[(i + 1) % 3];
            const float rest =
                (model.vertices[a].position_mm - model.vertices[b].position_mm).norm();
            EXPECT_LT((positions[a] - positions[b]).norm(), 4.0F * rest + 3.0F);
        }
    }
}

TEST(HandMotion, LabelsFollowFromTheMovement) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const Demo demo(seed);
        const HandMotion motion = demo.motion();
        std::map<std::string, int> count;
        double before = 0.0;
        for (const SimLabel& label : motion.labels()) {
            SCOPED_TRACE(label.gesture + " of seed " + std::to_string(seed));
            ++count[label.gesture];
            const double start = seconds(label.start);
            const double end = seconds(label.end);
            const double commit = seconds(label.commit);
            EXPECT_EQ(label.hand, demo.hand);
            EXPECT_GT(start, before);
            EXPECT_GT(commit, start);
            EXPECT_LT(commit, end);
            before = end;
            const Vec3f moved = motion.at(end).palm_mm - motion.at(start).palm_mm;
            if (label.gesture == "swipe_left") {
                EXPECT_GT(moved.x(), 200.0F);
            } else if (label.gesture == "swipe_right") {
                EXPECT_LT(moved.x(), -200.0F);
            } else if (label.gesture == "swipe_up") {
                EXPECT_LT(moved.y(), -180.0F);
            } else if (label.gesture == "swipe_down") {
                EXPECT_GT(moved.y(), 180.0F);
            } else if (label.gesture == "push") {
                EXPECT_LT(moved.z(), -120.0F);
                const float push =
                    motion.at(commit - 0.240).palm_mm.z() - motion.at(commit).palm_mm.z();
                EXPECT_GT(push / 0.240F, 320.0F);
            } else {
                ASSERT_EQ(label.gesture, "pinch");
                EXPECT_GE(demo.aperture(motion, start), 50.0F);
                EXPECT_GE(demo.aperture(motion, end), 50.0F);
                EXPECT_LE(demo.aperture(motion, commit - 0.050), 20.5F);
                EXPECT_LE(demo.aperture(motion, commit), 20.0F);
                float least = 100.0F;
                for (double t = start; t < end; t += 0.01) {
                    least = std::min(least, demo.aperture(motion, t));
                }
                EXPECT_LE(least, 12.0F);
            }
        }
        EXPECT_EQ(count["pinch"], 2);
        for (const char* name : {"swipe_left", "swipe_right", "swipe_up", "swipe_down", "push"}) {
            EXPECT_EQ(count[name], 1) << name;
        }
    }
}

TEST(HandMotion, OutsideLabelsNothingFulfilsADefinition) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Demo demo(seed);
        const HandMotion motion = demo.motion();
        const auto labelled = [&](double t) {
            return std::any_of(
                motion.labels().begin(), motion.labels().end(), [t](const SimLabel& l) {
                    return t >= seconds(l.start) - 0.01 && t <= seconds(l.end) + 0.35;
                });
        };
        // After entering, before leaving.
        const double from = 3.0;
        const double to = motion.end_s() - 2.0;
        for (double t = from; t < to; t += 0.02) {
            if (labelled(t) || labelled(t - 0.3)) {
                continue;
            }
            const Vec3f moved = motion.at(t).palm_mm - motion.at(t - 0.3).palm_mm;
            EXPECT_LT(moved.norm(), 0.3F * 300.0F) << seed << " at " << t;
            EXPECT_GT(demo.aperture(motion, t), 25.0F) << seed << " at " << t;
        }
    }
}

TEST(HandMotion, StrokesAreSmooth) {
    const Demo demo(2);
    const HandMotion motion = demo.motion();
    // No jumps: between samples of a millisecond the palm moves 1.2 mm at most.
    for (double t = 0.0; t < motion.end_s(); t += 0.001) {
        ASSERT_LT((motion.at(t + 0.001).palm_mm - motion.at(t).palm_mm).norm(), 1.3F) << t;
    }
}

TEST(HandMotion, SlidesThroughItsRestingPlaceAtConstantVelocity) {
    SimSettings settings = SimSettings::preset("ideal-60").value();
    const Vec3f velocity(900.0F, 0.0F, -300.0F);
    settings.script = {{SimAction::slide, SimHand::right, 0.5, 0.8, velocity}};
    const HandMotion motion(settings, SimHand::right, hand_model());
    EXPECT_DOUBLE_EQ(motion.end_s(), 1.3);
    EXPECT_TRUE(motion.labels().empty());
    const Vec3f home(static_cast<float>(settings.user.hand_x_mm),
                     static_cast<float>(settings.user.hand_y_mm),
                     static_cast<float>(settings.user.hand_distance_mm));
    // The sway of a living hand comes on top, at most some millimetres.
    constexpr float kSway_mm = 12.0F;
    for (const double t : {0.5, 0.7, 0.9, 1.1, 1.2999}) {
        const Vec3f wanted = home + velocity * static_cast<float>(t - 0.9);
        EXPECT_LT((motion.at(t).palm_mm - wanted).norm(), kSway_mm) << t;
    }
    // In the first and the last moment it is as fast as in the middle.
    for (const double t : {0.5, 0.9, 1.28}) {
        const Vec3f moved = motion.at(t + 0.02).palm_mm - motion.at(t).palm_mm;
        EXPECT_LT((moved - velocity * 0.02F).norm(), 0.8F) << t;
    }
    // It stays where the slide ends.
    EXPECT_LT((motion.at(2.0).palm_mm - (home + velocity * 0.4F)).norm(), kSway_mm);
}

TEST(HandMotion, FollowsAPathWithoutASwayOfItsOwn) {
    SimSettings settings = SimSettings::preset("ideal-60").value();
    SimPath path;
    path.hand = SimHand::left;
    path.poses.resize(2);
    path.poses[0].t_s = 1.0;
    path.poses[0].palm_mm = {0.0F, 10.0F, 600.0F};
    path.poses[1].t_s = 2.0;
    path.poses[1].palm_mm = {100.0F, 10.0F, 500.0F};
    path.poses[1].turn_rad = {0.2F, 0.0F, 0.0F};
    path.poses[1].fingers_rad[4] = 1.0F;
    settings.paths = {path};
    ASSERT_TRUE(settings.validate());
    const HandMotion motion(settings, path);
    EXPECT_EQ(motion.hand(), SimHand::left);
    EXPECT_DOUBLE_EQ(motion.end_s(), 2.0);
    EXPECT_EQ(motion.at(0.0).palm_mm, path.poses[0].palm_mm);
    EXPECT_LT((motion.at(1.25).palm_mm - Vec3f(25.0F, 10.0F, 575.0F)).norm(), 1e-3F);
    EXPECT_NEAR(motion.at(1.5).turn_rad.x(), 0.1F, 1e-5F);
    EXPECT_NEAR(motion.at(1.5).fingers[4], 0.5F, 1e-5F);
    EXPECT_EQ(motion.at(9.0).palm_mm, path.poses[1].palm_mm);
    EXPECT_TRUE(motion.labels().empty());
}

TEST(SimSettings, RefusesPathsThatAreNone) {
    const auto refuses = [](std::vector<SimPath> paths) {
        SimSettings settings = SimSettings::preset("ideal-60").value();
        settings.paths = std::move(paths);
        const auto valid = settings.validate();
        return !valid && valid.error().message.find("paths") != std::string::npos;
    };
    SimPath still;
    still.poses.resize(1);
    EXPECT_FALSE(refuses({still}));
    EXPECT_FALSE(refuses({still, still}));
    EXPECT_TRUE(refuses({still, still, still}));
    EXPECT_TRUE(refuses({SimPath{}}));
    SimPath backwards;
    backwards.poses.resize(2);  // both at 0 s
    EXPECT_TRUE(refuses({backwards}));
    SimPath nowhere = still;
    nowhere.poses[0].palm_mm.x() = NAN;
    EXPECT_TRUE(refuses({nowhere}));
}

TEST(SimSettings, RefusesASlideThatIsNoMovement) {
    SimSettings settings = SimSettings::preset("ideal-60").value();
    settings.script = {{SimAction::slide, SimHand::right, -1.0, 0.0}};
    EXPECT_FALSE(settings.validate());
    settings.script = {{SimAction::slide, SimHand::right, -1.0, 1.0, {NAN, 0.0F, 0.0F}}};
    const auto refused = settings.validate();
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("velocity_mmps"), std::string::npos);
}

TEST(SimSettings, VariesThePersonAndTheOrder) {
    int left = 0;
    std::map<std::string, int> first;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const Demo demo(seed);
        EXPECT_TRUE(demo.settings.validate().ok()) << seed;
        left += demo.hand == SimHand::left ? 1 : 0;
        ++first[demo.motion().labels().front().gesture];
    }
    EXPECT_GT(left, 3);
    EXPECT_LT(left, 17);
    EXPECT_GE(first.size(), 3U);
}

}  // namespace
}  // namespace xtrack::sim
