// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <xtrack/session.hpp>

namespace xtrack::tools {

/// The camera image as three-channel colour.
[[nodiscard]] cv::Mat camera_picture(const Frame& frame);

/// Depth in 256 levels of grey: white is `near_mm`, black is `far_mm` or no depth.
[[nodiscard]] cv::Mat depth_picture(const DepthFrame& depth, double near_mm, double far_mm);

/// Draws the palm circle, its normal, and the fingertips onto a picture of the camera's shape.
void draw_hands(cv::Mat& picture, const HandFrame& camera_hands, const Rig& rig);

/// Tints the pixels that belong to hands.
void draw_regions(cv::Mat& picture, const HandTracker& tracker);

/// Rows of pictures, one row an event: camera, depth, tracked hand.
class ContactSheet {
 public:
    ContactSheet(const Rig& rig, std::string title);

    /// Keeps the pictures of this moment under a caption. Bounded: after kMaxRows it keeps no more.
    void add(const PipelineView& view, const std::string& caption);
    /// Writes a PNG under a temporary name and renames it.
    [[nodiscard]] Result<void> write(const std::filesystem::path& path) const;

 private:
    static constexpr std::size_t kMaxRows = 24;

    Rig rig_;
    std::string title_;
    std::vector<cv::Mat> rows_;
};

/// Writes a PNG under a temporary name and renames it.
[[nodiscard]] Result<void> write_png(const std::filesystem::path& path, const cv::Mat& image);

}  // namespace xtrack::tools
