// SPDX-License-Identifier: Apache-2.0
// Hands that lie on a table, and hands that touch their owner's body.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>

#include <gtest/gtest.h>

#include <xtrack/gesture_recogniser.hpp>
#include <xtrack/hand_tracker.hpp>

#include "tests/gestures/track/synthetic_hand.hpp"

namespace xtrack {
namespace {

using test::Scene;
using test::SyntheticHand;

constexpr int kFramesPerSecond = 30;
constexpr float kNearMm = 15.0F;

/// Like a camera at the screen: x to the user's right, y up, z from the screen.
Mat4d user_from_camera() {
    Mat4d m = Mat4d::Identity();
    m(0, 0) = m(1, 1) = -1.0;
    return m;
}

/// What becomes of one hand in a time of a scene.
struct Count {
    int frames = 0;
    int found = 0;   ///< within kNearMm of the truth
    int others = 0;  ///< hands elsewhere
    int first_id = 0;
    int last_id = 0;
    float least_confidence = 1.0F;
    float worst_mm = 0.0F;

    void add(const HandFrame& hands, const Vec3f& truth_mm) {
        ++frames;
        bool here = false;
        for (const Hand& hand : hands.all()) {
            const float off_mm = (hand.palm_mm - truth_mm).norm();
            if (off_mm > kNearMm) {
                ++others;
                continue;
            }
            found += std::exchange(here, true) ? 0 : 1;
            first_id = first_id == 0 ? hand.id : first_id;
            last_id = hand.id;
            worst_mm = std::max(worst_mm, off_mm);
            least_confidence = std::min(least_confidence, hand.confidence);
        }
    }
    void print(const char* what) const {
        std::printf(
            "%s: found in %d of %d images, within %.1f mm, confidence %.2f and more, "
            "elsewhere %d, ids %d..%d\n",
            what, found, frames, static_cast<double>(worst_mm),
            static_cast<double>(least_confidence), others, first_id, last_id);
    }
};

/// Plays a scene whose hand is at `palm(t)`.
class Play {
 public:
    Play(Size size, const std::function<void(Scene&)>& room, std::function<Vec3f(float)> palm,
         const Vec3f& elbow_mm)
        : scene_(size, 600.0 / 640.0 * size.width),
          palm_(std::move(palm)),
          elbow_mm_(elbow_mm),
          tracker_(std::move(*HandTracker::create(scene_.rig, size, {}))),
          recogniser_(std::move(*GestureRecogniser::create({}))) {
        room(scene_);
        room_ = scene_.depth;
    }

    Count until(float end_s) {
        Count count;
        for (; static_cast<float>(k_) < end_s * kFramesPerSecond; ++k_) {
            SyntheticHand hand;
            hand.elbow_mm = elbow_mm_;
            hand.palm_mm = palm_(static_cast<float>(k_) / kFramesPerSecond);
            scene_.depth = room_;
            if (hand.palm_mm.z() > 0.0F) {
                hand.draw(scene_);
            }
            scene_.noise(1.5, 0.03, static_cast<unsigned>(k_));
            scene_.depth.stamp = Stamp::from_us(k_ * 1000000LL / kFramesPerSecond);
            const HandFrame& hands = tracker_.track(scene_.depth);
            for (const GestureEvent& e :
                 recogniser_.push(to_interaction(hands, user_from_camera()))) {
                gestures_ += e.type != GestureType::hand && e.phase == EventPhase::begin ? 1 : 0;
            }
            count.add(hands, hand.palm_mm);
        }
        return count;
    }

    [[nodiscard]] int gestures() const { return gestures_; }

 private:
    Scene scene_;
    DepthFrame room_;
    std::function<Vec3f(float)> palm_;
    Vec3f elbow_mm_;
    HandTracker tracker_;
    GestureRecogniser recogniser_;
    int gestures_ = 0;
    int k_ = 0;
};

class Contact : public testing::TestWithParam<Size> {};

/// Seen from above, 600 mm over a table: it comes down flat on it, lies there, and is lifted again.
TEST_P(Contact, AHandThatLiesOnATable) {
    constexpr float kTableMm = 700.0F;
    constexpr float kLiesMm = kTableMm - 30.0F;  // the back of a flat hand is so high
    const auto palm = [](float t) {
        const float up = std::clamp(std::abs(t - 5.6F) - 2.0F, 0.0F, 0.6F) * 200.0F;
        return t < 2.8F ? Vec3f(0.0F, 0.0F, -1.0F) : Vec3f(20.0F, 10.0F, kLiesMm - up);
    };
    Play play(
        GetParam(), [](Scene& scene) { scene.wall(kTableMm); }, palm, Vec3f(40.0F, 280.0F, 5.0F));
    play.until(3.3F);
    const Count comes = play.until(3.6F);
    const Count lies = play.until(7.6F);
    const Count lifted = play.until(8.6F);
    comes.print("over a table");
    lies.print("on it");
    lifted.print("over it again");
    EXPECT_EQ(comes.found, comes.frames);
    EXPECT_EQ(lies.found, lies.frames);
    EXPECT_LT(lies.worst_mm, 6.0F);
    EXPECT_GT(lies.least_confidence, 0.9F);
    EXPECT_EQ(lifted.found, lifted.frames);
    EXPECT_EQ(comes.first_id, lifted.last_id);
    EXPECT_EQ(comes.others + lies.others + lifted.others, 0);
    EXPECT_EQ(play.gestures(), 0);
}

/// It goes to the chest at 0.3 m/s, touches it for a second, and comes back.
TEST_P(Contact, AHandThatTouchesTheTorso) {
    constexpr float kChestMm = 800.0F;
    const auto palm = [](float t) {
        const float away = std::clamp(std::abs(t - 2.5F) - 0.5F, 0.0F, 0.7F) * 300.0F;
        return Vec3f(30.0F, 110.0F, kChestMm - 30.0F - away);
    };
    Play play(
        GetParam(),
        [](Scene& scene) {
            scene.wall(1500.0F);
            scene.person(0.0F, kChestMm);
            for (const float x : {-150.0F, 150.0F}) {  // shoulders, and arms that hang
                scene.capsule({x, 70.0F, kChestMm + 120.0F}, {x, 400.0F, kChestMm + 120.0F}, 110.0F,
                              110.0F);
            }
        },
        palm, Vec3f(200.0F, 170.0F, -20.0F));
    const Count before = play.until(1.6F);
    const Count touches = play.until(3.4F);
    const Count after = play.until(4.5F);
    before.print("before the chest");
    touches.print("at it, 100 mm and less");
    after.print("before it again");
    EXPECT_EQ(before.found, before.frames);
    EXPECT_EQ(before.others, 0);
    // Of 54 images 30 are of a hand that touches, which is one surface with the chest; all others
    // see it.
    EXPECT_GE(touches.found, 22);
    EXPECT_LT(touches.worst_mm, 6.0F);
    EXPECT_LE(touches.others, 12);  // patches of arm and chest, for single images
    EXPECT_EQ(after.found, after.frames);
    EXPECT_EQ(after.others, 0);
    EXPECT_EQ(play.gestures(), 0);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Contact, testing::Values(Size{640, 480}, Size{320, 240}));

}  // namespace
}  // namespace xtrack
