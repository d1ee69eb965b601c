// SPDX-License-Identifier: Apache-2.0
#include "tools/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "core/base/file.hpp"
#include "core/capture/image_codec.hpp"

namespace xtrack::tools {

namespace {

constexpr int kTileWidth_px = 320;
constexpr int kCaptionHeight_px = 22;
constexpr int kTitleHeight_px = 30;
constexpr double kDefaultNear_mm = 300.0;
constexpr double kDefaultFar_mm = 1500.0;
constexpr float kNormalLength_mm = 50.0F;

const cv::Scalar kPalmColour(80, 220, 80);
const cv::Scalar kNormalColour(230, 200, 60);
const cv::Scalar kHandTint(60, 160, 255);
// thumb to little
const cv::Scalar kTipColours[kFingerCount] = {
    {60, 60, 240}, {60, 200, 250}, {240, 240, 80}, {250, 130, 60}, {230, 90, 230}};

std::optional<cv::Point2d> project(const Vec3f& p_camera, const Rig& rig, double scale) {
    const double z = p_camera.z();
    if (z <= 1.0) {
        return std::nullopt;
    }
    const Mat3d& k = rig.camera.matrix;
    return cv::Point2d((k(0, 0) * p_camera.x() / z + k(0, 2)) * scale,
                       (k(1, 1) * p_camera.y() / z + k(1, 2)) * scale);
}

void put_text(cv::Mat& image, const std::string& text, int x, int y, double size) {
    cv::putText(image, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, size, {235, 235, 235}, 1,
                cv::LINE_AA);
}

cv::Mat tile(const cv::Mat& picture) {
    const double scale = static_cast<double>(kTileWidth_px) / picture.cols;
    cv::Mat out;
    cv::resize(picture, out, {}, scale, scale, cv::INTER_AREA);
    return out;
}

}  // namespace

cv::Mat camera_picture(const Frame& frame) {
    const int type = frame.format == PixelFormat::grey8 ? CV_8UC1 : CV_8UC3;
    // OpenCV has no const image header; the pixels are copied or converted below, never written.
    const cv::Mat borrowed(frame.height(), frame.width(), type,
                           const_cast<std::uint8_t*>(frame.pixels.row(0)),
                           static_cast<std::size_t>(frame.pixels.stride()));
    cv::Mat out;
    if (type == CV_8UC1) {
        cv::cvtColor(borrowed, out, cv::COLOR_GRAY2BGR);
    } else {
        out = borrowed.clone();
    }
    return out;
}

cv::Mat depth_picture(const DepthFrame& depth, double near_mm, double far_mm) {
    cv::Mat out(depth.depth.height(), depth.depth.width(), CV_8UC3, cv::Scalar::all(0));
    const double per_step = 254.0 / (far_mm - near_mm) * depth.depth_unit_mm;
    const double offset = near_mm / depth.depth_unit_mm;
    for (int y = 0; y < out.rows; ++y) {
        const std::uint16_t* in = depth.depth.row(y);
        auto* row = out.ptr<cv::Vec3b>(y);
        for (int x = 0; x < out.cols; ++x) {
            if (in[x] != 0) {
                const double level = 255.0 - (in[x] - offset) * per_step;
                row[x] = cv::Vec3b::all(static_cast<std::uint8_t>(std::clamp(level, 1.0, 255.0)));
            }
        }
    }
    return out;
}

void draw_hands(cv::Mat& picture, const HandFrame& camera_hands, const Rig& rig) {
    const double scale =
        rig.camera.size.width > 0 ? static_cast<double>(picture.cols) / rig.camera.size.width : 1.0;
    for (const Hand& hand : camera_hands.all()) {
        const auto palm = project(hand.palm_mm, rig, scale);
        if (!palm) {
            continue;
        }
        const double radius_px =
            rig.camera.matrix(0, 0) * hand.palm_radius_mm / hand.palm_mm.z() * scale;
        cv::circle(picture, *palm, std::max(2, static_cast<int>(std::lround(radius_px))),
                   kPalmColour, 2, cv::LINE_AA);
        cv::circle(picture, *palm, 3, kPalmColour, cv::FILLED, cv::LINE_AA);
        const Vec3f ahead = hand.palm_mm + kNormalLength_mm * hand.palm_normal;
        if (const auto end = project(ahead, rig, scale)) {
            cv::arrowedLine(picture, *palm, *end, kNormalColour, 2, cv::LINE_AA, 0, 0.2);
        }
        for (std::size_t i = 0; i < kFingerCount; ++i) {
            if (!hand.fingertips[i].valid) {
                continue;
            }
            if (const auto tip = project(hand.fingertips[i].position_mm, rig, scale)) {
                cv::circle(picture, *tip, 6, kTipColours[i], 2, cv::LINE_AA);
            }
        }
    }
}

void draw_regions(cv::Mat& picture, const HandTracker& tracker) {
    const HandSegmentation segmentation = tracker.segmentation();
    const auto labels = segmentation.labels;
    if (labels.empty()) {
        return;
    }
    for (int y = 0; y < picture.rows; ++y) {
        const std::uint8_t* label = labels.row(y * labels.height / picture.rows);
        auto* row = picture.ptr<cv::Vec3b>(y);
        for (int x = 0; x < picture.cols; ++x) {
            if (label[x * labels.width / picture.cols] != 0) {
                for (int c = 0; c < 3; ++c) {
                    row[x][c] = static_cast<std::uint8_t>((row[x][c] * 2 + kHandTint[c]) / 3);
                }
            }
        }
    }
}

ContactSheet::ContactSheet(const Rig& rig, std::string title)
    : rig_(rig), title_(std::move(title)) {}

void ContactSheet::add(const PipelineView& view, const std::string& caption) {
    if (view.depth == nullptr || rows_.size() == kMaxRows) {
        return;
    }
    const double near_mm = rig_.working_volume ? rig_.working_volume->near_mm : kDefaultNear_mm;
    const double far_mm = rig_.working_volume ? rig_.working_volume->far_mm : kDefaultFar_mm;
    const cv::Mat depth = depth_picture(*view.depth, near_mm, far_mm);
    const cv::Mat camera = view.frame != nullptr ? camera_picture(**view.frame) : depth;
    cv::Mat tracked = camera.clone();
    if (view.tracker != nullptr) {
        draw_regions(tracked, *view.tracker);
    }
    if (view.camera_hands != nullptr) {
        draw_hands(tracked, *view.camera_hands, rig_);
    }
    cv::Mat strip;
    const std::vector<cv::Mat> tiles = {tile(camera), tile(depth), tile(tracked)};
    cv::hconcat(tiles, strip);
    cv::Mat row(strip.rows + kCaptionHeight_px, strip.cols, CV_8UC3, cv::Scalar(48, 40, 36));
    strip.copyTo(row(cv::Rect(0, kCaptionHeight_px, strip.cols, strip.rows)));
    put_text(row, caption, 6, kCaptionHeight_px - 7, 0.45);
    rows_.push_back(row);
}

Result<void> ContactSheet::write(const std::filesystem::path& path) const {
    cv::Mat title(kTitleHeight_px, 3 * kTileWidth_px, CV_8UC3, cv::Scalar(24, 20, 18));
    put_text(title, title_, 6, kTitleHeight_px - 10, 0.5);
    std::vector<cv::Mat> all = {title};
    all.insert(all.end(), rows_.begin(), rows_.end());
    cv::Mat sheet;
    cv::vconcat(all, sheet);
    return write_png(path, sheet);
}

Result<void> write_png(const std::filesystem::path& path, const cv::Mat& image) {
    const ImageView<const std::uint8_t> pixels{image.data, image.cols * 3, image.rows,
                                               static_cast<std::ptrdiff_t>(image.step[0])};
    const auto png = capture::encode_png(pixels, PixelFormat::bgr8);
    return png ? base::write_file(path, *png) : Result<void>(png.error());
}

}  // namespace xtrack::tools
