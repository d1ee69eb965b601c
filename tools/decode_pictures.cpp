// SPDX-License-Identifier: Apache-2.0
#include "tools/decode_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "core/capture/image_codec.hpp"

namespace xtrack::tools {

namespace {

constexpr int kLevels = 256;
constexpr int kTicks = 5;
// The picture is laid out for a camera image of 640 columns and grows with it.
constexpr double kDesignWidth_px = 640.0;

struct Levels {
    cv::Mat value;  // u8, which of 256 levels
    cv::Mat known;  // u8, 255 where there is a value
};

Levels empty_levels(int width, int height) {
    return {cv::Mat::zeros(height, width, CV_8UC1), cv::Mat::zeros(height, width, CV_8UC1)};
}

std::uint8_t level_of(double value, double low, double high) {
    const double share = high > low ? (value - low) / (high - low) : 0.5;
    return static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0, 1.0) * (kLevels - 1)));
}

cv::Mat in_colour(const cv::Mat& levels, int map) {
    cv::Mat colour;
    cv::applyColorMap(levels, colour, map);
    return colour;
}

void write_text(cv::Mat& picture, const std::string& text, cv::Point at, double scale) {
    cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.45 * scale,
                cv::Scalar(235, 235, 235), std::max(1, static_cast<int>(scale)), cv::LINE_AA);
}

// The picture with a title above and, to its right, the scale from `top` down to `bottom`.
Result<std::string> with_legend(const Levels& levels, int map, double top, double bottom,
                                const char* format, const std::string& title) {
    const double scale = std::max(0.5, levels.value.cols / kDesignWidth_px);
    const auto px = [scale](double v) { return static_cast<int>(std::lround(v * scale)); };
    const int height = levels.value.rows;
    const int width = levels.value.cols;
    const int shown = std::max(height, px(60));  // the scale needs room
    cv::Mat picture(shown + px(28), width + px(140), CV_8UC3, cv::Scalar(28, 28, 28));

    cv::Mat image = picture(cv::Rect(0, px(28), width, height));
    image.setTo(cv::Scalar(0, 0, 0));
    in_colour(levels.value, map).copyTo(image, levels.known);

    const cv::Rect bar(width + px(14), px(28) + shown / 12, px(20), shown * 10 / 12);
    cv::Mat ramp(bar.height, bar.width, CV_8UC1);
    for (int y = 0; y < bar.height; ++y) {
        // Level 255 is on top, whichever end of the scale that is.
        ramp.row(y).setTo(level_of(bar.height - 1 - y, 0, bar.height - 1));
    }
    in_colour(ramp, map).copyTo(picture(bar));
    for (int i = 0; i < kTicks; ++i) {
        const double share = static_cast<double>(i) / (kTicks - 1);
        const int y = bar.y + static_cast<int>(std::lround(share * (bar.height - 1)));
        write_text(picture, fmt::format(fmt::runtime(format), top + share * (bottom - top)),
                   {bar.x + bar.width + px(8), y + px(5)}, scale);
    }
    write_text(picture, title, {px(8), px(19)}, scale);

    return capture::encode_png(
        ImageView<const std::uint8_t>{picture.data, picture.cols * 3, picture.rows,
                                      static_cast<std::ptrdiff_t>(picture.step[0])},
        PixelFormat::bgr8);
}

}  // namespace

Result<std::string> depth_preview(ImageView<const std::uint16_t> depth, double unit_mm,
                                  double low_mm, double high_mm, const std::string& title) {
    Levels levels = empty_levels(depth.width, depth.height);
    for (int y = 0; y < depth.height; ++y) {
        for (int x = 0; x < depth.width; ++x) {
            if (depth.at(x, y) != 0) {
                // Near is the top of the colour map: what a hand does is seen in warm colours.
                levels.value.at<std::uint8_t>(y, x) =
                    level_of(-depth.at(x, y) * unit_mm, -high_mm, -low_mm);
                levels.known.at<std::uint8_t>(y, x) = 255;
            }
        }
    }
    return with_legend(levels, cv::COLORMAP_TURBO, low_mm, high_mm, "{:.0f} mm", title);
}

Result<std::string> phase_preview(ImageView<const float> phase_rad, const std::string& title) {
    constexpr double kPi = std::numbers::pi;
    Levels levels = empty_levels(phase_rad.width, phase_rad.height);
    for (int y = 0; y < phase_rad.height; ++y) {
        for (int x = 0; x < phase_rad.width; ++x) {
            if (std::isfinite(phase_rad.at(x, y))) {
                levels.value.at<std::uint8_t>(y, x) =
                    level_of(static_cast<double>(phase_rad.at(x, y)), -kPi, kPi);
                levels.known.at<std::uint8_t>(y, x) = 255;
            }
        }
    }
    return with_legend(levels, cv::COLORMAP_TWILIGHT, kPi, -kPi, "{:+.2f} rad", title);
}

Result<std::string> height_preview(ImageView<const float> height_rad, const std::string& title) {
    std::vector<float> known;
    for (int y = 0; y < height_rad.height; ++y) {
        std::copy_if(height_rad.row(y), height_rad.row(y) + height_rad.width,
                     std::back_inserter(known), [](float h) { return std::isfinite(h); });
    }
    std::sort(known.begin(), known.end());
    const double low = known.empty() ? 0.0 : static_cast<double>(known[known.size() / 100]);
    const double high =
        known.empty() ? 0.0 : static_cast<double>(known[known.size() - 1 - known.size() / 100]);
    Levels levels = empty_levels(height_rad.width, height_rad.height);
    for (int y = 0; y < height_rad.height; ++y) {
        for (int x = 0; x < height_rad.width; ++x) {
            if (std::isfinite(height_rad.at(x, y))) {
                levels.value.at<std::uint8_t>(y, x) =
                    level_of(static_cast<double>(height_rad.at(x, y)), low, high);
                levels.known.at<std::uint8_t>(y, x) = 255;
            }
        }
    }
    return with_legend(levels, cv::COLORMAP_TURBO, high, low, "{:+.1f} rad", title);
}

Result<std::string> grey_png(ImageView<const float> image) {
    Image<std::uint8_t> grey(image.width, image.height);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const float v = image.at(x, y);
            grey.at(x, y) =
                std::isfinite(v)
                    ? static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0F, 255.0F)))
                    : std::uint8_t{0};
        }
    }
    return capture::encode_png(grey.view(), PixelFormat::grey8);
}

}  // namespace xtrack::tools
