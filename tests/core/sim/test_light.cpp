// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "core/sim/sensor.hpp"
#include "tests/core/sim/small_rig.hpp"

namespace xtrack {
namespace {

Vec3d to_projector(const Rig& rig, const Vec3d& camera_mm) {
    return rig.projector_from_camera_R * camera_mm + rig.projector_from_camera_T;
}

Vec2f pixel_of(const Pinhole& pinhole, const Vec3d& p) {
    const Vec3d q = pinhole.matrix * p;
    return {static_cast<float>(q.x() / q.z()), static_cast<float>(q.y() / q.z())};
}

/// A bare wall, square to the camera.
SimSettings wall_alone() {
    SimSettings s = test::small_settings();
    s.script.clear();
    s.user.visible_body = false;
    s.room.wall_yaw_rad = 0.0;
    s.duration_s = 0.1;
    test::make_clean(s);
    return s;
}

TEST(SimLight, APlaneHasThePhaseOfGeometry) {
    SimSettings s = wall_alone();
    constexpr double kPeriodPx = 128.0;
    constexpr double kPhaseRad = 0.7;
    test::show_flat(s, {1.0});
    Pattern sine;
    sine.kind = PatternKind::sine;
    sine.period_px = kPeriodPx;
    sine.phase_rad[0] = kPhaseRad;
    s.patterns.patterns.push_back(sine);
    s.projector.light_grey = 400.0;
    const auto rig = test::make_rig(s);
    const FramePtr flat = rig->next({}).frame;
    const FramePtr fringe = rig->next({}).frame;
    int bright = 0;
    for (const int u : {30, 61, 90, 121}) {
        for (const int v : {25, 40, 55, 71, 88, 104}) {
            const Vec3d ray((u - s.rig.camera.matrix(0, 2)) / s.rig.camera.matrix(0, 0),
                            (v - s.rig.camera.matrix(1, 2)) / s.rig.camera.matrix(1, 1), 1.0);
            const Vec3d p = to_projector(s.rig, ray * s.room.wall_distance_mm);
            const double coordinate = pixel_of(*s.rig.projector, p).y();
            const double expected =
                0.5 + 0.5 * std::cos(2.0 * std::numbers::pi * coordinate / kPeriodPx + kPhaseRad);
            const double ratio =
                static_cast<double>(fringe->pixels.at(u, v)) / flat->pixels.at(u, v);
            EXPECT_NEAR(ratio, expected, 0.025) << u << " " << v;
            bright += expected > 0.5 ? 1 : 0;
        }
    }
    EXPECT_GT(bright, 4);  // the pixels see both halves of the fringe
    EXPECT_LT(bright, 20);
}

TEST(SimLight, FallsWithTheSquareOfTheDistance) {
    SimSettings s = wall_alone();
    test::show_flat(s, {1.0});
    s.rig.working_volume.reset();
    const auto near = test::make_rig(s)->next({}).frame;
    const double near_mm = s.room.wall_distance_mm;
    s.room.wall_distance_mm = 2000.0;
    const auto far = test::make_rig(s)->next({}).frame;
    const auto mean = [](const Frame& f) {
        double sum = 0.0;
        for (int y = 50; y < 70; ++y) {
            for (int x = 60; x < 100; ++x) {
                sum += f.pixels.at(x, y);
            }
        }
        return sum;
    };
    // The projector is a little above: its distance and its slant change a little less.
    EXPECT_NEAR(mean(*near) / mean(*far), (2000.0 / near_mm) * (2000.0 / near_mm), 0.12);
}

TEST(SimLight, GammaBendsTheLight) {
    SimSettings s = wall_alone();
    test::show_flat(s, {1.0, 0.5});
    s.projector.gamma = 2.2;
    s.projector.light_grey = 400.0;
    const auto rig = test::make_rig(s);
    const auto full = rig->next({}).frame;
    const auto half = rig->next({}).frame;
    EXPECT_NEAR(static_cast<double>(half->pixels.at(80, 60)) / full->pixels.at(80, 60),
                std::pow(0.5, 2.2), 0.02);
}

TEST(SimLight, ADriverThatCompensatesShowsWhatIsWanted) {
    SimSettings s = wall_alone();
    test::show_flat(s, {1.0, 0.5});
    s.projector.gamma = 2.2;
    s.projector.light_grey = 400.0;
    ProjectorResponse response;
    for (int i = 0; i <= 51; ++i) {
        for (auto& light : response.light) {
            light.push_back(std::pow(i / 51.0, 2.2));
        }
    }
    s.projector.compensation = response;
    const auto rig = test::make_rig(s);
    const auto full = rig->next({}).frame;
    const auto half = rig->next({}).frame;
    EXPECT_NEAR(static_cast<double>(half->pixels.at(80, 60)) / full->pixels.at(80, 60), 0.5, 0.02);
    s.projector.compensation->light[1][3] = 2.0;
    EXPECT_FALSE(SimulatedRig::create(s));
}

TEST(SimLight, AHandCastsItsShadowWhereGeometrySays) {
    SimSettings s = test::small_still_hand();
    s.user.visible_body = false;
    s.room.wall_yaw_rad = 0.0;
    test::make_clean(s);
    test::show_flat(s, {1.0});
    const auto rig = test::make_rig(s);
    const auto with_hand = rig->next({}).frame;
    const SimTruth& truth = rig->truth();
    SimSettings bare = s;
    bare.script.clear();
    const auto without = test::make_rig(bare)->next({}).frame;
    // Through palm and middle knuckle, from the projector's centre to the wall.
    const Vec3d centre =
        -(s.rig.projector_from_camera_R.transpose() * s.rig.projector_from_camera_T);
    int looked_at = 0;
    for (const std::size_t joint : {0U, 7U, 12U}) {
        const Vec3d p = truth.hands[0].joints_mm[joint].cast<double>();
        const double t = (s.room.wall_distance_mm - centre.z()) / (p.z() - centre.z());
        const Vec2f at = pixel_of(s.rig.camera, centre + (p - centre) * t);
        const int x = static_cast<int>(std::lround(at.x()));
        const int y = static_cast<int>(std::lround(at.y()));
        if (truth.mask.at(x, y) != static_cast<std::uint8_t>(SimPart::wall)) {
            continue;  // the hand or its arm hides its own shadow here
        }
        ++looked_at;
        EXPECT_GT(without->pixels.at(x, y), 20) << joint;
        EXPECT_LT(with_hand->pixels.at(x, y), 3) << joint;
    }
    EXPECT_GE(looked_at, 1);
    // And nowhere else does the wall change by more than rounding and the noise that is left.
    int darkened = 0;
    int wall = 0;
    for (int y = 0; y < truth.mask.height(); ++y) {
        for (int x = 0; x < truth.mask.width(); ++x) {
            if (truth.mask.at(x, y) == static_cast<std::uint8_t>(SimPart::wall)) {
                ++wall;
                const int change = without->pixels.at(x, y) - with_hand->pixels.at(x, y);
                EXPECT_GT(change, -4);
                darkened += change > 4 ? 1 : 0;
            }
        }
    }
    EXPECT_GT(darkened, 100);
    EXPECT_LT(darkened, wall / 4);
}

TEST(SimLight, AnOpenHandDoesNotShadeItself) {
    SimSettings s = test::small_still_hand();
    test::make_clean(s);
    test::show_flat(s, {1.0});
    const auto rig = test::make_rig(s);
    const auto frame = rig->next({}).frame;
    const SimTruth& truth = rig->truth();
    int hand = 0;
    int dark = 0;
    for (int y = 1; y + 1 < truth.mask.height(); ++y) {
        for (int x = 1; x + 1 < truth.mask.width(); ++x) {
            bool inside = true;
            for (int dy = -1; dy <= 1; ++dy) {
                for (int dx = -1; dx <= 1; ++dx) {
                    inside = inside && truth.mask.at(x + dx, y + dy) == 1;
                }
            }
            hand += inside ? 1 : 0;
            dark += inside && frame->pixels.at(x, y) < 40 ? 1 : 0;
        }
    }
    EXPECT_GT(hand, 300);
    EXPECT_LT(dark, hand / 50);
}

TEST(SimLight, ARedProjectorLightsOnlyRedThroughAPerfectCamera) {
    SimSettings s = wall_alone();
    s.camera.colour = true;
    s.patterns = rgb_sequence(Axis::y, s.patterns.projector_size, {64.0});
    s.projector.light_grey = 400.0;
    const auto rig = test::make_rig(s);
    const auto frame = rig->next({}).frame;
    ASSERT_EQ(frame->format, PixelFormat::bgr8);
    // The three channels carry sines a third of a turn apart: their sum is even, they are not.
    int low = 765;
    int high = 0;
    int differ = 0;
    for (int y = 40; y < 80; ++y) {
        const std::uint8_t* p = frame->pixels.row(y) + 80 * 3;
        low = std::min(low, p[0] + p[1] + p[2]);
        high = std::max(high, p[0] + p[1] + p[2]);
        differ = std::max(differ, std::abs(p[0] - p[2]));
    }
    EXPECT_LT(high - low, (high + low) / 8);
    EXPECT_GT(differ, high / 4);
}

TEST(SimSensor, NoiseHasTheVarianceOfItsModel) {
    SimCamera camera;
    camera.blur_px = 0.0;
    camera.full_well_e = 8000.0;
    camera.read_noise_e = 20.0;
    sim::Sensor sensor(camera, 7, {320, 200});
    for (const float grey : {20.0F, 100.0F, 200.0F}) {
        Image<std::uint8_t> out(320, 200);
        double sum = 0.0;
        double square = 0.0;
        constexpr int kFrames = 3;
        for (int frame = 0; frame < kFrames; ++frame) {
            for (int y = 0; y < 200; ++y) {
                std::fill(sensor.light().row(y), sensor.light().row(y) + 320, grey);
            }
            sensor.read_out(static_cast<std::uint64_t>(frame), out.view());
            for (int y = 0; y < 200; ++y) {
                for (int x = 0; x < 320; ++x) {
                    sum += out.at(x, y);
                    square += static_cast<double>(out.at(x, y)) * out.at(x, y);
                }
            }
        }
        constexpr double kCount = 320.0 * 200.0 * kFrames;
        const double mean = sum / kCount;
        const double variance = square / kCount - mean * mean;
        constexpr double kRounding = 1.0 / 12.0;
        // Electrons: shot noise is their square root, read noise comes on top.
        const double gain = 255.0 / camera.full_well_e;
        const double expected = (grey / gain + 400.0) * gain * gain + kRounding;
        EXPECT_NEAR(mean, grey, 0.03);
        EXPECT_NEAR(variance / expected, 1.0, 0.02) << grey;
    }
}

TEST(SimSensor, ChromaIsSharedByTwoPixels) {
    SimCamera camera;
    camera.blur_px = 0.0;
    camera.full_well_e = 200000.0;
    camera.read_noise_e = 0.0;
    camera.colour = true;
    camera.chroma_422 = true;
    sim::Sensor sensor(camera, 7, {4, 1});
    Image<std::uint8_t> out(12, 1);
    // A red pixel beside a blue one of the same pair, then two of one grey.
    const std::array<float, 12> bgr{0.0F,   0.0F,   200.0F, 200.0F, 0.0F,   0.0F,
                                    120.0F, 120.0F, 120.0F, 120.0F, 120.0F, 120.0F};
    std::copy(bgr.begin(), bgr.end(), sensor.light().row(0));
    sensor.read_out(0, out.view());
    EXPECT_GT(out.at(0, 0), 40);   // blue leaks into the red pixel
    EXPECT_LT(out.at(2, 0), 170);  // and the red fades
    for (int i = 6; i < 12; ++i) {
        EXPECT_NEAR(out.at(i, 0), 120, 3) << i;
    }
}

}  // namespace
}  // namespace xtrack
