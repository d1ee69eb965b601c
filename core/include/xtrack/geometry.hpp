// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace xtrack {

// Eigen's own fixed-size types are aligned to 16 or 32 bytes depending on the compiler's flags, so
// a library built for the baseline CPU and a program built with -march=native would disagree about
// the layout of every struct that holds one. Public types therefore use unaligned storage only.
using Vec2f = Eigen::Matrix<float, 2, 1, Eigen::DontAlign>;
using Vec3f = Eigen::Matrix<float, 3, 1, Eigen::DontAlign>;
using Vec3d = Eigen::Matrix<double, 3, 1, Eigen::DontAlign>;
using Mat3d = Eigen::Matrix<double, 3, 3, Eigen::DontAlign>;
using Mat4d = Eigen::Matrix<double, 4, 4, Eigen::DontAlign>;

static_assert(alignof(Vec2f) == alignof(float) && sizeof(Vec2f) == 2 * sizeof(float));
static_assert(alignof(Vec3f) == alignof(float) && sizeof(Vec3f) == 3 * sizeof(float));
static_assert(alignof(Vec3d) == alignof(double) && sizeof(Vec3d) == 3 * sizeof(double));
static_assert(alignof(Mat3d) == alignof(double) && sizeof(Mat3d) == 9 * sizeof(double));
static_assert(alignof(Mat4d) == alignof(double) && sizeof(Mat4d) == 16 * sizeof(double));

/// Width and height in pixels.
/// @since 0.1
struct Size {
    int width = 0;
    int height = 0;
    friend constexpr bool operator==(const Size&, const Size&) = default;
};

/// Bounds of what is believed of a camera or a projector; of a camera's images also the pixels in
/// all, as buffers are made for them before the first is seen.
inline constexpr int kMaxImageSide_px = 16384;
inline constexpr int kMaxImagePixels = 1 << 26;
/// True where an image may have this size.
/// @thread any
/// @since 0.1
[[nodiscard]] constexpr bool is_image_size(Size size) noexcept {
    return size.width > 0 && size.height > 0 && size.width <= kMaxImageSide_px &&
           size.height <= kMaxImageSide_px && size.width <= kMaxImagePixels / size.height;
}

/// The coordinate frame a position is given in; docs/coordinate-frames.md draws both. mm.
/// @since 0.1
enum class CoordinateFrame {
    camera,       ///< x right, y down, z forward, as OpenCV
    interaction,  ///< x to the user's right, y up, z from the screen toward the user
};

}  // namespace xtrack
