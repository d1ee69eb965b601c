// SPDX-License-Identifier: Apache-2.0
// Compiled with -march=native; the other side of every call here is compiled for the baseline CPU.
#include <gmock/gmock.h>

#include "tests/support/abi_echo.hpp"

namespace xtrack::abi {
namespace {

template <typename T>
class PublicType : public ::testing::Test {};
using PublicTypes =
    ::testing::Types<Stamp, Result<Stamp>, Frame, Pattern, PatternSequence, Rig, PhaseMap,
                     DepthFrame, PointCloud, Hand, HandFrame, GestureEvent>;
TYPED_TEST_SUITE(PublicType, PublicTypes);

TYPED_TEST(PublicType, HasTheLayoutThatTheLibraryBelieves) {
    const Layout here{sizeof(TypeParam), alignof(TypeParam)};
    EXPECT_EQ(layout_in_library<TypeParam>().size, here.size);
    EXPECT_EQ(layout_in_library<TypeParam>().alignment, here.alignment);
}

// Different in every element, so that a field read at the wrong place shows.
template <typename Matrix>
Matrix ramp(typename Matrix::Scalar first) {
    Matrix m;
    for (Eigen::Index i = 0; i < m.size(); ++i) {
        m.data()[i] = first + static_cast<typename Matrix::Scalar>(i) * 10;
    }
    return m;
}

template <typename Matrix>
void expect_grown(const Matrix& after, const Matrix& before) {
    const Matrix expected = (before.array() + typename Matrix::Scalar{1}).matrix();
    EXPECT_EQ(after, expected);
}

template <typename T>
Image<T> ramp_image(int width, int height) {
    Image<T> image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            image.at(x, y) = static_cast<T>(y * width + x);
        }
    }
    return image;
}

template <typename T>
void expect_grown_image(const Image<T>& after, const Image<T>& before) {
    ASSERT_EQ(after.size(), before.size());
    for (int y = 0; y < after.height(); ++y) {
        for (int x = 0; x < after.width(); ++x) {
            EXPECT_EQ(after.at(x, y), static_cast<T>(before.at(x, y) + T{1}));
        }
    }
}

TEST(RoundTrip, Stamp) { EXPECT_EQ(echo(Stamp{41}).ns, 42); }

TEST(RoundTrip, ResultWithValue) {
    const Result<Stamp> after = echo(Result<Stamp>(Stamp{41}));
    ASSERT_TRUE(after.ok());
    EXPECT_EQ(after->ns, 42);
}

TEST(RoundTrip, ResultWithError) {
    const Result<Stamp> after = echo(
        Result<Stamp>(Error{ErrorCode::device_lost, "a message too long to live in a string"}));
    ASSERT_FALSE(after.ok());
    EXPECT_EQ(after.error().code, ErrorCode::device_lost);
    EXPECT_EQ(after.error().message, "a message too long to live in a string!");
}

TEST(RoundTrip, Frame) {
    Frame before;
    before.stamp = Stamp{1};
    before.sequence = 2;
    before.pattern = 3;
    before.clean_row_begin = 4;
    before.clean_row_end = 5;
    before.pixels = ramp_image<std::uint8_t>(12, 3);
    const Frame after = echo(before);
    EXPECT_EQ(after.status, FrameStatus::damaged);
    EXPECT_EQ(after.format, PixelFormat::bgr8);
    EXPECT_EQ(after.width(), 4);
    EXPECT_EQ(after.stamp, Stamp{2});
    EXPECT_EQ(after.sequence, 3U);
    EXPECT_EQ(after.pattern, 4);
    EXPECT_EQ(after.clean_row_begin, 5);
    EXPECT_EQ(after.clean_row_end, 6);
    expect_grown_image(after.pixels, before.pixels);
}

Pattern some_pattern() {
    return {PatternKind::sine, 10.0, {20.0, 30.0, 40.0}, 5, 6, 70.0, 80.0, false, 90.0};
}
Pattern grown_pattern() {
    return {PatternKind::gray_code, 11.0, {21.0, 31.0, 41.0}, 6, 7, 71.0, 81.0, true, 91.0};
}

TEST(RoundTrip, Pattern) { EXPECT_EQ(echo(some_pattern()), grown_pattern()); }

TEST(RoundTrip, PatternSequence) {
    const PatternSequence before{Axis::x,
                                 {1280, 720},
                                 2.2,
                                 ProjectorResponse{{{{0.0, 1.0}, {0.0, 0.5, 1.0}, {}}}},
                                 {some_pattern(), some_pattern()}};
    const PatternSequence after = echo(before);
    EXPECT_EQ(after.axis, Axis::y);
    EXPECT_EQ(after.projector_size, (Size{1281, 721}));
    EXPECT_EQ(after.gamma, 2.2 + 1.0);
    ASSERT_TRUE(after.response.has_value());
    EXPECT_THAT(after.response->light[1], ::testing::ElementsAre(1.0, 1.5, 2.0));
    EXPECT_THAT(after.patterns, ::testing::ElementsAre(grown_pattern(), grown_pattern()));
}

TEST(RoundTrip, Rig) {
    Rig before;
    before.camera = {ramp<Mat3d>(1.0), {1, 2, 3, 4, 5, 6, 7, 8}, {640, 480}};
    before.projector = Pinhole{ramp<Mat3d>(2.0), {8, 7, 6, 5, 4, 3, 2, 1}, {1280, 720}};
    before.projector_from_camera_R = ramp<Mat3d>(3.0);
    before.projector_from_camera_T = ramp<Vec3d>(4.0);
    before.interaction_from_camera = ramp<Mat4d>(5.0);
    before.working_volume = WorkingVolume{300.0, 900.0};
    before.camera_from_projector_rgb = ramp<Mat3d>(6.0);
    const Rig after = echo(before);
    expect_grown(after.camera.matrix, before.camera.matrix);
    EXPECT_THAT(after.camera.distortion, ::testing::ElementsAre(2, 3, 4, 5, 6, 7, 8, 9));
    EXPECT_EQ(after.camera.size, (Size{641, 481}));
    ASSERT_TRUE(after.projector.has_value());
    expect_grown(after.projector->matrix, before.projector->matrix);
    EXPECT_THAT(after.projector->distortion, ::testing::ElementsAre(9, 8, 7, 6, 5, 4, 3, 2));
    EXPECT_EQ(after.projector->size, (Size{1281, 721}));
    expect_grown(after.projector_from_camera_R, before.projector_from_camera_R);
    expect_grown(after.projector_from_camera_T, before.projector_from_camera_T);
    ASSERT_TRUE(after.interaction_from_camera.has_value());
    expect_grown(*after.interaction_from_camera, *before.interaction_from_camera);
    ASSERT_TRUE(after.working_volume.has_value());
    EXPECT_EQ(after.working_volume->near_mm, 301.0);
    EXPECT_EQ(after.working_volume->far_mm, 901.0);
    ASSERT_TRUE(after.camera_from_projector_rgb.has_value());
    expect_grown(*after.camera_from_projector_rgb, *before.camera_from_projector_rgb);
}

TEST(RoundTrip, RigWithoutTheOptionalParts) {
    const Rig after = echo(Rig{});
    EXPECT_FALSE(after.projector || after.interaction_from_camera || after.working_volume ||
                 after.camera_from_projector_rgb);
}

TEST(RoundTrip, PhaseMap) {
    PhaseMap before;
    before.stamp = Stamp{1};
    before.period_px = 32.0;
    before.phase_rad = ramp_image<float>(5, 3);
    before.modulation = ramp_image<float>(5, 3);
    const PhaseMap after = echo(before);
    EXPECT_EQ(after.stamp, Stamp{2});
    EXPECT_EQ(after.period_px, 33.0);
    expect_grown_image(after.phase_rad, before.phase_rad);
    expect_grown_image(after.modulation, before.modulation);
}

TEST(RoundTrip, DepthFrame) {
    DepthFrame before;
    before.stamp = Stamp{1};
    before.sequence = 2;
    before.span = Duration{7};
    before.depth_unit_mm = 0.5;
    before.depth = ramp_image<std::uint16_t>(7, 4);
    before.quality = ramp_image<std::uint8_t>(7, 4);
    const DepthFrame after = echo(before);
    EXPECT_EQ(after.stamp, Stamp{2});
    EXPECT_EQ(after.sequence, 3U);
    EXPECT_EQ(after.span, Duration{8});
    EXPECT_EQ(after.depth_unit_mm, 1.5);
    EXPECT_FALSE(after.metric);
    expect_grown_image(after.depth, before.depth);
    expect_grown_image(after.quality, before.quality);
}

TEST(RoundTrip, PointCloud) {
    PointCloud before;
    before.points_mm = {ramp<Vec3f>(1.0F), ramp<Vec3f>(2.0F)};
    before.colours_rgb = {{1, 2, 3}, {4, 5, 6}};
    const PointCloud after = echo(before);
    EXPECT_FALSE(after.metric);
    ASSERT_EQ(after.points_mm.size(), 3U);
    expect_grown(after.points_mm[0], before.points_mm[0]);
    expect_grown(after.points_mm[1], before.points_mm[1]);
    EXPECT_EQ(after.points_mm[2], Vec3f::Constant(9.0F).eval());
    ASSERT_EQ(after.colours_rgb.size(), 3U);
    EXPECT_THAT(after.colours_rgb[1], ::testing::ElementsAre(5, 6, 7));
}

Hand some_hand(int id) {
    const auto n = static_cast<float>(id);
    Hand hand;
    hand.id = id;
    hand.chirality = Chirality::left;
    hand.chirality_confidence = n + 1.0F;
    hand.confidence = n + 2.0F;
    hand.palm_mm = ramp<Vec3f>(n + 3.0F);
    hand.palm_radius_mm = n + 4.0F;
    hand.palm_normal = ramp<Vec3f>(n + 5.0F);
    hand.palm_velocity_mmps = ramp<Vec3f>(n + 6.0F);
    for (std::size_t i = 0; i < kFingerCount; ++i) {
        hand.fingertips[i] = {ramp<Vec3f>(n + static_cast<float>(i)), i % 2 == 0};
        hand.finger_extension[i] = n + static_cast<float>(i) * 2.0F;
    }
    hand.extended_fingers = id + 7;
    hand.pinch_aperture_mm = n + 8.0F;
    hand.pinch_value = n + 9.0F;
    hand.grab_value = n + 10.0F;
    for (std::size_t i = 0; i < kJointCount; ++i) {
        hand.joints[i] = {ramp<Vec3f>(n + static_cast<float>(i) * 3.0F), i % 2 == 1};
    }
    return hand;
}

void expect_grown_hand(const Hand& after, const Hand& before) {
    EXPECT_EQ(after.id, before.id + 1);
    EXPECT_EQ(after.chirality, Chirality::right);
    EXPECT_EQ(after.chirality_confidence, before.chirality_confidence + 1.0F);
    EXPECT_EQ(after.confidence, before.confidence + 1.0F);
    EXPECT_NE(after.touches_border, before.touches_border);
    expect_grown(after.palm_mm, before.palm_mm);
    EXPECT_EQ(after.palm_radius_mm, before.palm_radius_mm + 1.0F);
    expect_grown(after.palm_normal, before.palm_normal);
    expect_grown(after.palm_velocity_mmps, before.palm_velocity_mmps);
    for (std::size_t i = 0; i < kFingerCount; ++i) {
        expect_grown(after.fingertips[i].position_mm, before.fingertips[i].position_mm);
        EXPECT_NE(after.fingertips[i].valid, before.fingertips[i].valid);
        EXPECT_EQ(after.finger_extension[i], before.finger_extension[i] + 1.0F);
    }
    EXPECT_EQ(after.extended_fingers, before.extended_fingers + 1);
    EXPECT_EQ(after.pinch_aperture_mm, before.pinch_aperture_mm + 1.0F);
    EXPECT_EQ(after.pinch_value, before.pinch_value + 1.0F);
    EXPECT_EQ(after.grab_value, before.grab_value + 1.0F);
    for (std::size_t i = 0; i < kJointCount; ++i) {
        expect_grown(after.joints[i].position_mm, before.joints[i].position_mm);
        EXPECT_NE(after.joints[i].valid, before.joints[i].valid);
    }
}

TEST(RoundTrip, Hand) { expect_grown_hand(echo(some_hand(3)), some_hand(3)); }

TEST(RoundTrip, HandFrame) {
    HandFrame before;
    before.stamp = Stamp{1};
    before.span = Duration{7};
    before.hands = {some_hand(1), some_hand(2)};
    before.count = 1;
    const HandFrame after = echo(before);
    EXPECT_EQ(after.stamp, Stamp{2});
    EXPECT_EQ(after.span, Duration{8});
    EXPECT_EQ(after.coordinates, CoordinateFrame::interaction);
    EXPECT_EQ(after.count, 2U);
    expect_grown_hand(after.hands[0], before.hands[0]);
    expect_grown_hand(after.hands[1], before.hands[1]);
}

TEST(RoundTrip, GestureEvent) {
    GestureEvent before;
    before.gesture_id = 1;
    before.hand_id = 2;
    before.hand_confidence = 3.0F;
    before.onset = Stamp{4};
    before.sensor = Stamp{5};
    before.emit = Stamp{6};
    before.position_mm = ramp<Vec3f>(7.0F);
    before.velocity_mmps = ramp<Vec3f>(8.0F);
    before.progress = 9.0F;
    before.value = 10.0F;
    before.confidence = 11.0F;
    const GestureEvent after = echo(before);
    EXPECT_EQ(after.type, GestureType::pinch);
    EXPECT_EQ(after.direction, Direction::down);
    EXPECT_EQ(after.phase, EventPhase::cancel);
    EXPECT_EQ(after.cancel_reason, CancelReason::edge);
    EXPECT_EQ(after.gesture_id, 2);
    EXPECT_EQ(after.hand_id, 3);
    EXPECT_EQ(after.hand, Chirality::right);
    EXPECT_EQ(after.hand_confidence, 4.0F);
    EXPECT_EQ(after.onset, Stamp{5});
    EXPECT_EQ(after.sensor, Stamp{6});
    EXPECT_EQ(after.emit, Stamp{7});
    expect_grown(after.position_mm, before.position_mm);
    expect_grown(after.velocity_mmps, before.velocity_mmps);
    EXPECT_EQ(after.progress, 10.0F);
    EXPECT_EQ(after.value, 11.0F);
    EXPECT_EQ(after.confidence, 12.0F);
    EXPECT_FALSE(after.metric);
}

}  // namespace
}  // namespace xtrack::abi
