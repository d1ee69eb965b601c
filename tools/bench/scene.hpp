// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <xtrack/depth.hpp>
#include <xtrack/frame.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>

namespace xtrack::tools::bench {

/// Sets of frames that are handed out in turn. Together they are longer than caches are, so that
/// what comes next has long been pushed out of them by what came between.
class FrameRing {
 public:
    static constexpr std::size_t kLeastBytes = 64U << 20U;

    /// Copies `set` until the ring is longer than kLeastBytes.
    explicit FrameRing(const std::vector<Frame>& set);

    [[nodiscard]] std::span<const FramePtr> next() noexcept;
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }

 private:
    std::vector<FramePtr> frames_;
    std::size_t set_size_;
    std::size_t next_ = 0;
    std::size_t bytes_ = 0;
};

/// A slanted wall that fills the image, seen by a camera without lens distortion 200 mm beside the
/// projector. Every pixel is lit, so that none is cheaper than another.
class Scene {
 public:
    /// @param image at most kMaxImageSide_px a side
    [[nodiscard]] static Result<Scene> create(Size image);

    [[nodiscard]] const Rig& rig() const noexcept { return rig_; }
    [[nodiscard]] Size size() const noexcept { return rig_.camera.size; }

    // What the projector shows: one period that is unique in the working volume; that and an eighth
    // of it; Gray code with an eighth of it.
    [[nodiscard]] const PatternSequence& three_step() const noexcept { return three_step_; }
    [[nodiscard]] const PatternSequence& dual() const noexcept { return dual_; }
    [[nodiscard]] const PatternSequence& gray_code() const noexcept { return gray_code_; }
    /// Three steps of a short period, which repeats in the volume many times.
    [[nodiscard]] const PatternSequence& fringes() const noexcept { return fringes_; }

    /// One image of every pattern, with noise of a grey level.
    [[nodiscard]] std::vector<Frame> frames(const PatternSequence& patterns) const;

    /// The same of a wall with bumps of up to 40 mm, so that no row of fringes is like the next.
    [[nodiscard]] std::vector<Frame> bumpy_frames(const PatternSequence& patterns) const;

    [[nodiscard]] double wall_mm(int u) const noexcept;
    [[nodiscard]] double bumpy_wall_mm(int u, int v) const noexcept;
    /// Projector px that column u of the camera sees.
    [[nodiscard]] double coordinate_px(int u) const noexcept;
    /// Middle of what the working volume can reach in column u, projector px.
    [[nodiscard]] double volume_middle_px(int u) const noexcept;

    /// Median of |depth - wall|, mm; infinite where most pixels have no depth.
    [[nodiscard]] double median_error_mm(const DepthFrame& depth) const;
    [[nodiscard]] double median_bumpy_error_mm(const DepthFrame& depth) const;
    /// The same of x, y, z of every pixel, row by row, NaN where there is no depth.
    [[nodiscard]] double median_error_mm(std::span<const float> xyz_mm) const;

 private:
    Scene() = default;
    [[nodiscard]] double coordinate_of_depth_px(int u, double z_mm) const noexcept;
    /// @param z_mm depth of the pixel (u, v)
    template <typename Depth>
    [[nodiscard]] std::vector<Frame> render(const PatternSequence& patterns, Depth z_mm) const;
    template <typename Depth>
    [[nodiscard]] double median_error_of(const DepthFrame& depth, Depth z_mm) const;

    Rig rig_;
    PatternSequence three_step_;
    PatternSequence dual_;
    PatternSequence gray_code_;
    PatternSequence fringes_;
};

}  // namespace xtrack::tools::bench
