// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <xtrack/pattern.hpp>
#include <xtrack/rig.hpp>

namespace xtrack {
namespace {

using testing::HasSubstr;

Rig good_rig() {
    Rig rig;
    rig.camera.matrix << 860.0, 0.0, 320.0, 0.0, 860.0, 240.0, 0.0, 0.0, 1.0;
    rig.camera.size = {640, 480};
    rig.projector.emplace();
    rig.projector->matrix << 1000.0, 0.0, 512.0, 0.0, 1000.0, 384.0, 0.0, 0.0, 1.0;
    rig.projector->size = {1024, 768};
    rig.projector_from_camera_T = {0.0, 200.0, 0.0};
    rig.working_volume = WorkingVolume{500.0, 2000.0};
    return rig;
}

void expect_refused(const Rig& rig, const std::string& field) {
    const auto result = validate(rig);
    ASSERT_FALSE(result.ok()) << field;
    EXPECT_THAT(result.error().message, HasSubstr(field));
    EXPECT_THAT(result.error().message, HasSubstr(";"));
}

TEST(Rig, AGoodOneIsAccepted) { EXPECT_TRUE(validate(good_rig()).ok()); }

TEST(Rig, ADepthCameraNeedsNoProjector) {
    Rig rig = good_rig();
    rig.projector.reset();
    rig.projector_from_camera_T.setZero();
    EXPECT_TRUE(validate(rig).ok());
}

TEST(Rig, SingularAndBrokenMatricesAreRefused) {
    Rig rig = good_rig();
    rig.camera.matrix(0, 0) = 0.0;
    expect_refused(rig, "camera_matrix");
    rig = good_rig();
    rig.projector->matrix.setZero();
    expect_refused(rig, "projector_matrix");
    rig = good_rig();
    rig.camera.matrix.transposeInPlace();
    expect_refused(rig, "camera_matrix");
    rig = good_rig();
    rig.projector_from_camera_R(0, 0) = 2.0;
    expect_refused(rig, "projector_from_camera_R");
    rig = good_rig();
    rig.projector_from_camera_R(0, 0) = -1.0;
    expect_refused(rig, "projector_from_camera_R");
    rig = good_rig();
    rig.projector_from_camera_T.setZero();
    expect_refused(rig, "projector_from_camera_T");
    rig = good_rig();
    rig.camera_from_projector_rgb = Mat3d::Ones();
    expect_refused(rig, "camera_from_projector_rgb");
}

TEST(Rig, NanAndAbsurdNumbersAreRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Rig rig = good_rig();
    rig.camera.matrix(0, 2) = nan;
    expect_refused(rig, "camera_matrix");
    rig = good_rig();
    rig.camera.matrix(0, 2) = 1e300;
    expect_refused(rig, "camera_matrix");
    rig = good_rig();
    rig.projector->distortion[4] = nan;
    expect_refused(rig, "projector_distortion");
    rig = good_rig();
    rig.projector->distortion[4] = -1e300;
    expect_refused(rig, "projector_distortion");
    rig = good_rig();
    rig.interaction_from_camera = Mat4d::Identity();
    (*rig.interaction_from_camera)(1, 3) = 1e300;
    expect_refused(rig, "interaction_from_camera");
    rig = good_rig();
    rig.projector_from_camera_R(1, 1) = nan;
    expect_refused(rig, "projector_from_camera_R");
    rig = good_rig();
    rig.camera.size = {1000000000, 480};
    expect_refused(rig, "camera_size");
    rig = good_rig();
    rig.working_volume = WorkingVolume{900.0, 400.0};
    expect_refused(rig, "working_volume_mm");
    rig = good_rig();
    rig.working_volume = WorkingVolume{nan, 400.0};
    expect_refused(rig, "working_volume_mm");
}

TEST(Rig, InteractionMayReflectButNotScale) {
    Rig rig = good_rig();
    rig.interaction_from_camera = Mat4d::Identity();
    (*rig.interaction_from_camera)(1, 1) = -1.0;
    EXPECT_TRUE(validate(rig).ok());
    (*rig.interaction_from_camera)(1, 1) = -2.0;
    expect_refused(rig, "interaction_from_camera");
}

// Camera and projector side by side: x differs by f b (1/near - 1/far) = 1000 * 200 * 1.5e-3 = 300.
TEST(Rig, VolumeWidePeriodCoversTheVolume) {
    const auto period = volume_wide_period_px(good_rig(), Axis::y);
    ASSERT_TRUE(period.ok()) << period.error().message;
    EXPECT_NEAR(*period, 306.0, 1.0);
    const auto across = volume_wide_period_px(good_rig(), Axis::x);
    ASSERT_FALSE(across.ok());
    EXPECT_THAT(across.error().message, HasSubstr("projector_from_camera_T"));
    Rig rig = good_rig();
    rig.working_volume.reset();
    EXPECT_FALSE(volume_wide_period_px(rig, Axis::y).ok());
    rig = good_rig();
    rig.projector.reset();
    EXPECT_FALSE(volume_wide_period_px(rig, Axis::y).ok());
}

}  // namespace
}  // namespace xtrack
