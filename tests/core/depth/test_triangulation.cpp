// SPDX-License-Identifier: Apache-2.0
#include "core/depth/triangulation.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/depth/distortion.hpp"

namespace xtrack {
namespace {

Rig small_rig() {
    Rig rig;
    rig.camera.matrix << 150.0, 0.0, 80.0, 0.0, 150.0, 60.0, 0.0, 0.0, 1.0;
    rig.camera.size = {160, 120};
    Pinhole projector;
    projector.matrix << 700.0, 0.0, 510.0, 0.0, 690.0, 380.0, 0.0, 0.0, 1.0;
    projector.size = {1024, 768};
    rig.projector = projector;
    const double angle = 0.2;
    rig.projector_from_camera_R << std::cos(angle), 0.0, std::sin(angle), 0.0, 1.0, 0.0,
        -std::sin(angle), 0.0, std::cos(angle);
    rig.projector_from_camera_T << -150.0, 90.0, 20.0;
    rig.working_volume = WorkingVolume{300.0, 1200.0};
    return rig;
}

// Where the projector shows a camera point: the definition, step by step.
double projected(const Rig& rig, Axis axis, int u, int v, double z) {
    const RayXY ray = ray_of_pixel(rig.camera, u, v);
    const Vec3d p =
        rig.projector_from_camera_R * Vec3d(ray.x * z, ray.y * z, z) + rig.projector_from_camera_T;
    const RayXY seen = distort(*rig.projector, {p.x() / p.z(), p.y() / p.z()});
    const Vec3d pixel = rig.projector->matrix * Vec3d(seen.x, seen.y, 1.0);
    return axis == Axis::x ? pixel.x() : pixel.y();
}

TEST(Triangulation, ReturnsTheDepthThatWasProjected) {
    for (const Axis axis : {Axis::x, Axis::y}) {
        for (const bool camera_lens : {false, true}) {
            for (const bool projector_lens : {false, true}) {
                Rig rig = small_rig();
                if (camera_lens) {
                    rig.camera.distortion = {-0.2, 0.05, 0.001, -0.002, 0.0, 0.0, 0.0, 0.0};
                }
                if (projector_lens) {
                    rig.projector->distortion = {-0.05, 0.01, 0.001, 0.001, 0.0, 0.0, 0.0, 0.0};
                }
                auto made = Triangulation::create(rig, axis, rig.camera.size);
                ASSERT_TRUE(made) << made.error().message;
                const int w = rig.camera.size.width;
                std::vector<float> scratch(static_cast<std::size_t>(2 * w)),
                    x(static_cast<std::size_t>(w)), b(static_cast<std::size_t>(w), 60.0F);
                std::vector<std::uint16_t> depth(static_cast<std::size_t>(w));
                std::vector<std::uint8_t> quality(static_cast<std::size_t>(w));
                for (const int v : {0, 61, 119}) {
                    for (int u = 0; u < w; ++u) {
                        const double z = 400.0 + 4.0 * u;
                        x[static_cast<std::size_t>(u)] =
                            static_cast<float>(projected(rig, axis, u, v, z));
                        EXPECT_NEAR(made->coordinate_of_depth(u, v, z),
                                    projected(rig, axis, u, v, z), 1e-6);
                    }
                    made->undistort_projector_row(v, w, x.data());
                    DepthRow row;
                    made->prepare_row(v, scratch.data(), row);
                    row.count = w;
                    row.coordinate_px = x.data();
                    row.modulation = b.data();
                    row.depth = depth.data();
                    row.quality = quality.data();
                    depth_row(row);
                    for (int u = 0; u < w; ++u) {
                        ASSERT_NEAR(depth[static_cast<std::size_t>(u)], 4000 + 40 * u, 1)
                            << u << " " << v << " lenses " << camera_lens << projector_lens;
                    }
                }
            }
        }
    }
}

TEST(Triangulation, UndistortInvertsDistort) {
    Pinhole lens;
    lens.distortion = {-0.28, 0.09, 0.001, -0.0005, -0.01, 0.02, 0.0, 0.001};
    for (double x = -0.5; x <= 0.5; x += 0.1) {
        for (double y = -0.4; y <= 0.4; y += 0.1) {
            const RayXY back = undistort(lens, distort(lens, {x, y}));
            EXPECT_NEAR(back.x, x, 1e-7);
            EXPECT_NEAR(back.y, y, 1e-7);
        }
    }
}

struct BadRig {
    const char* name;
    void (*spoil)(Rig&);
    const char* says;
};
class Refusal : public testing::TestWithParam<BadRig> {};

TEST_P(Refusal, NamesTheFault) {
    Rig rig = small_rig();
    GetParam().spoil(rig);
    const auto made = Triangulation::create(rig, Axis::x, {160, 120});
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(made.error().message.find(GetParam().says), std::string::npos)
        << made.error().message;
}

INSTANTIATE_TEST_SUITE_P(
    Rigs, Refusal,
    testing::Values(
        BadRig{"projector", [](Rig& r) { r.projector.reset(); }, "no projector"},
        BadRig{"singular", [](Rig& r) { r.camera.matrix(0, 0) = 0.0; }, "camera_matrix"},
        BadRig{"zeros", [](Rig& r) { r.projector->matrix.setZero(); }, "projector_matrix"},
        BadRig{"nan", [](Rig& r) { r.projector_from_camera_T(1) = NAN; }, "not finite"},
        BadRig{"lens", [](Rig& r) { r.camera.distortion[2] = INFINITY; }, "camera_distortion"},
        BadRig{"rotation", [](Rig& r) { r.projector_from_camera_R *= 2.0; }, "not a rotation"},
        BadRig{"mirror", [](Rig& r) { r.projector_from_camera_R.row(0) *= -1.0; },
               "not a rotation"},
        BadRig{"size",
               [](Rig& r) {
                   r.camera.size = {640, 480};
               },
               "640 x 480"},
        BadRig{"volume",
               [](Rig& r) {
                   r.working_volume = WorkingVolume{900.0, 300.0};
               },
               "working_volume_mm"},
        BadRig{"far",
               [](Rig& r) {
                   r.working_volume = WorkingVolume{7000.0, 9000.0};
               },
               "6553.5"},
        BadRig{"baseline",
               [](Rig& r) {
                   r.projector_from_camera_R.setIdentity();
                   r.projector_from_camera_T << 0.0, 200.0, 0.0;
               },
               "no baseline along the coded axis x"}),
    [](const auto& bad) { return std::string(bad.param.name); });

}  // namespace
}  // namespace xtrack
