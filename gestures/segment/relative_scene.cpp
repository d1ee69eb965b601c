// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/relative_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "gestures/segment/chamfer.hpp"

namespace xtrack::segment {

namespace {

/// Less is the background's noise, projector px.
constexpr double kForeground_px = 4.0;
/// Fewer cells of the grid are noise.
constexpr std::size_t kLeastCells = 60;
/// What stands out most: the height that this share of the foreground stays under, and all that is
/// at least this share of it high. A forearm behind the hand is not; a body neither.
constexpr double kTopShare = 0.97;
constexpr double kNearShare = 0.6;
/// A palm less wide is too far away to be seen as a hand, or noise.
constexpr double kLeastRadius_px = 6.0;
/// The scale is made once so many images showed something, and anew if the palm is off by more.
constexpr std::size_t kFirstImages = 5;
constexpr double kRescale = 1.4;
constexpr double kLeast_mm = 1.0;

}  // namespace

Rig RelativeScene::nominal_rig(Size image) {
    Rig rig;
    rig.camera.size = image;
    rig.camera.matrix(0, 0) = rig.camera.matrix(1, 1) = image.width;
    rig.camera.matrix(0, 2) = 0.5 * (image.width - 1);
    rig.camera.matrix(1, 2) = 0.5 * (image.height - 1);
    // Nominal mm say nothing of what is out of reach.
    rig.working_volume = WorkingVolume{50.0, 6500.0};
    return rig;
}

RelativeScene::RelativeScene(Size image, double background_mm, double mm_per_px)
    : background_mm_(background_mm), mm_per_px_(mm_per_px), focal_px_(image.width) {
    grid_.create(nominal_rig(image), image);
    heights_.reserve(grid_.size());
    distance_.assign(grid_.size(), 0);
    depth_.depth = Image<std::uint16_t>(image.width, image.height, 0);
    depth_.quality = Image<std::uint8_t>(image.width, image.height, 0);
}

void RelativeScene::measure(const DepthFrame& relative) {
    palm_radius_px_ = 0.0;
    grid_.load(relative, static_cast<float>(kLeast_mm));
    const auto high = static_cast<float>(background_mm_ - mm_per_px_ * kForeground_px);
    heights_.clear();
    for (const float z : grid_.z) {
        if (z > 0.0F && z < high) {
            heights_.push_back(static_cast<float>(height_px(static_cast<double>(z))));
        }
    }
    if (heights_.size() < kLeastCells) {
        return;
    }
    const auto top = heights_.begin() + static_cast<std::ptrdiff_t>(
                                            kTopShare * static_cast<double>(heights_.size() - 1));
    std::nth_element(heights_.begin(), top, heights_.end());
    const auto near =
        static_cast<float>(background_mm_ - mm_per_px_ * kNearShare * static_cast<double>(*top));
    for (std::size_t i = 0; i < grid_.size(); ++i) {
        const bool inside = grid_.z[i] > 0.0F && grid_.z[i] <= near;
        distance_[i] = inside ? kChamferFar : 0;
    }
    spread_distance(grid_, {0, 0, grid_.inner_width, grid_.inner_height}, distance_);
    const auto centre = std::max_element(distance_.begin(), distance_.end());
    const double radius_px = grid_.scale * static_cast<double>(*centre) / kChamferUnit;
    if (radius_px < kLeastRadius_px) {
        return;
    }
    palm_radius_px_ = radius_px;
    palm_height_px_ = height_px(
        static_cast<double>(grid_.z[static_cast<std::size_t>(centre - distance_.begin())]));
}

RelativeScene::Palm RelativeScene::usual_palm() {
    const std::size_t count = std::min(seen_, kRemembered);
    const auto median = [&](double Palm::*value) {
        for (std::size_t i = 0; i < count; ++i) {
            sorted_[i] = palms_[i].*value;
        }
        const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(count / 2);
        std::nth_element(sorted_.begin(), middle,
                         sorted_.begin() + static_cast<std::ptrdiff_t>(count));
        return *middle;
    };
    return {median(&Palm::radius_px), median(&Palm::height_px)};
}

bool RelativeScene::rescale() {
    if (palm_radius_px_ <= 0.0) {
        return false;
    }
    palms_[next_] = {palm_radius_px_, palm_height_px_};
    next_ = (next_ + 1) % kRemembered;
    ++seen_;
    if (seen_ < kFirstImages) {
        return false;
    }
    const Palm palm = usual_palm();
    const double inverse_z = palm.radius_px / (kPalmRadius_mm * focal_px_);
    if (inverse_background_ > 0.0) {
        const double expected = inverse_background_ + palm.height_px * inverse_per_px_;
        const double off = inverse_z / expected;
        if (seen_ < kRemembered || (off < kRescale && off > 1.0 / kRescale)) {
            return false;
        }
    }
    inverse_background_ = inverse_z / kBackgroundShare;
    inverse_per_px_ = (inverse_z - inverse_background_) / palm.height_px;
    return true;
}

void RelativeScene::convert(const DepthFrame& relative) {
    constexpr float kMost = std::numeric_limits<std::uint16_t>::max();
    const auto unit = static_cast<float>(relative.depth_unit_mm);
    const auto step = static_cast<float>(1.0 / depth_.depth_unit_mm);
    const auto high = static_cast<std::uint16_t>((background_mm_ - mm_per_px_ * kForeground_px) /
                                                 relative.depth_unit_mm);
    const auto a =
        static_cast<float>(inverse_background_ + background_mm_ / mm_per_px_ * inverse_per_px_);
    const auto b = static_cast<float>(inverse_per_px_ / mm_per_px_) * unit;
    for (int y = 0; y < depth_.depth.height(); ++y) {
        const std::uint16_t* from = relative.depth.row(y);
        std::uint16_t* to = depth_.depth.row(y);
        for (int x = 0; x < depth_.depth.width(); ++x) {
            const bool stands_out = from[x] != 0 && from[x] < high;
            const float z = stands_out ? step / (a - b * static_cast<float>(from[x])) : 0.0F;
            to[x] = z > 0.0F && z < kMost ? static_cast<std::uint16_t>(z) : std::uint16_t{0};
        }
    }
}

bool RelativeScene::update(const DepthFrame& relative) {
    measure(relative);
    const bool rescaled = rescale();
    depth_.stamp = relative.stamp;
    depth_.sequence = relative.sequence;
    depth_.span = relative.span;
    depth_.quality = relative.quality;
    if (inverse_background_ > 0.0) {
        convert(relative);
    }
    return rescaled;
}

}  // namespace xtrack::segment
