// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/relative_scene.hpp"

#include <algorithm>
#include <limits>

#include <xtrack/paper_decoder.hpp>

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
/// The scale is made once so many images showed something, and anew if so many agree that the palm
/// is off by more. One that serves to follow a hand is kept for longer.
constexpr std::size_t kFirstImages = 5;
constexpr double kRescale = 1.15;
constexpr double kRescaleFollowed = 1.4;
constexpr double kAlike = 1.1;
constexpr double kAgree = 0.8;
constexpr double kUsualShare = 0.6;  ///< of the palms, is smaller
/// Of what stands still only that is looked at which is so near: hands rest, bodies are behind
/// them.
constexpr double kRestingShare = 0.75;
constexpr double kLeast_mm = 1.0;

}  // namespace

Rig RelativeScene::nominal_rig(Size image) {
    Rig rig;
    rig.camera = nominal_camera(image);
    // Nominal mm say nothing of what is out of reach.
    rig.working_volume = WorkingVolume{50.0, 6500.0};
    return rig;
}

RelativeScene::RelativeScene(Size image, double background_mm, double mm_per_px)
    : background_mm_(background_mm), mm_per_px_(mm_per_px), focal_px_(image.width) {
    const int scale = Grid::fine_scale(image);
    grid_.create(nominal_rig(image), image, scale, scale);
    heights_.reserve(grid_.size());
    nearness_.assign(grid_.size(), kNearnessMax);
    depth_.depth = Image<std::uint16_t>(image.width, image.height, 0);
    depth_.quality = Image<std::uint8_t>(image.width, image.height, 0);
}

bool RelativeScene::measure(const Image<std::uint16_t>& component, int moving_ids) {
    palm_radius_px_ = 0.0;
    const auto high = static_cast<float>(background_mm_ - mm_per_px_ * kForeground_px);
    heights_.clear();
    std::fill(nearness_.begin(), nearness_.end(), kNearnessMax);
    for (int y = 0; y < grid_.inner_height; ++y) {
        const std::uint16_t* ids = component.row(y * grid_.scale + grid_.scale / 2);
        for (int x = 0; x < grid_.inner_width; ++x) {
            const auto i = static_cast<std::size_t>(grid_.index(x, y));
            const int id = ids[x * grid_.scale + grid_.scale / 2];
            const bool counts = moving_ids < 0 || (id > 0 && id <= moving_ids);
            if (counts && grid_.z[i] > 0.0F && grid_.z[i] < high) {
                heights_.push_back(static_cast<float>(height_px(static_cast<double>(grid_.z[i]))));
                nearness_[i] = 0;
            }
        }
    }
    if (heights_.size() < kLeastCells) {
        return false;
    }
    const auto top = heights_.begin() + static_cast<std::ptrdiff_t>(
                                            kTopShare * static_cast<double>(heights_.size() - 1));
    std::nth_element(heights_.begin(), top, heights_.end());
    const auto near =
        static_cast<float>(background_mm_ - mm_per_px_ * kNearShare * static_cast<double>(*top));
    for (std::size_t i = 0; i < grid_.size(); ++i) {
        nearness_[i] = grid_.z[i] <= near ? nearness_[i] : kNearnessMax;
    }
    spread(grid_, grid_.whole(), nearness_);
    const auto centre = std::min_element(nearness_.begin(), nearness_.end());
    const double radius_px = grid_.scale * static_cast<double>(distance_px(*centre));
    if (radius_px < kLeastRadius_px) {
        return false;
    }
    palm_radius_px_ = radius_px;
    palm_height_px_ = height_px(
        static_cast<double>(grid_.z[static_cast<std::size_t>(centre - nearness_.begin())]));
    return true;
}

// A hand is seen in part, or from the side, more often than something is taken for a part of it.
RelativeScene::Palm RelativeScene::usual_palm(std::size_t count) {
    for (std::size_t n = 0; n < count; ++n) {
        sorted_[n] = palms_[(seen_ - 1 - n) % kRemembered];
    }
    const auto begin = sorted_.begin();
    const auto end = begin + static_cast<std::ptrdiff_t>(count);
    const auto usual =
        begin + static_cast<std::ptrdiff_t>(kUsualShare * static_cast<double>(count));
    std::nth_element(begin, usual, end,
                     [](const Palm& a, const Palm& b) { return a.radius_px < b.radius_px; });
    return *usual;
}

bool RelativeScene::agree(std::size_t count, const Palm& usual) const noexcept {
    std::size_t alike = 0;
    for (std::size_t n = 0; n < count; ++n) {
        const double share = sorted_[n].radius_px / usual.radius_px;
        alike += share < kAlike && share > 1.0 / kAlike ? 1 : 0;
    }
    return static_cast<double>(alike) >= kAgree * static_cast<double>(count);
}

bool RelativeScene::rescale(bool moves, bool followed) {
    if (moves && !moved_) {
        moved_ = true;
        seen_ = 0;
    }
    palms_[seen_++ % kRemembered] = {palm_radius_px_, palm_height_px_};
    const bool known = inverse_background_ > 0.0;
    const std::size_t needed = known && followed ? kRemembered : kFirstImages;
    if (seen_ < needed) {
        return false;
    }
    const Palm palm = usual_palm(needed);
    const double inverse_z = palm.radius_px / (kPalmRadius_mm * focal_px_);
    if (known) {
        const double off = inverse_z / (inverse_background_ + palm.height_px * inverse_per_px_);
        const double least = followed ? kRescaleFollowed : kRescale;
        if (!agree(needed, palm) || (off < least && off > 1.0 / least)) {
            return false;
        }
    }
    usual_height_px_ = palm.height_px;
    inverse_background_ = inverse_z / kBackgroundShare;
    inverse_per_px_ = (inverse_z - inverse_background_) / palm.height_px;
    return true;
}

void RelativeScene::convert(const DepthFrame& relative, const Image<std::uint16_t>& component) {
    constexpr float kMost = std::numeric_limits<std::uint16_t>::max();
    const auto unit = static_cast<float>(relative.depth_unit_mm);
    const auto step = static_cast<float>(1.0 / depth_.depth_unit_mm);
    const auto high = static_cast<std::uint16_t>((background_mm_ - mm_per_px_ * kForeground_px) /
                                                 relative.depth_unit_mm);
    const auto near = static_cast<std::uint16_t>(
        std::max(1.0, background_mm_ - mm_per_px_ * kRestingShare * usual_height_px_) /
        relative.depth_unit_mm);
    const auto a =
        static_cast<float>(inverse_background_ + background_mm_ / mm_per_px_ * inverse_per_px_);
    const auto b = static_cast<float>(inverse_per_px_ / mm_per_px_) * unit;
    for (int y = 0; y < depth_.depth.height(); ++y) {
        const std::uint16_t* from = relative.depth.row(y);
        std::uint16_t* to = depth_.depth.row(y);
        const std::uint16_t* ids = component.row(y);
        for (int x = 0; x < depth_.depth.width(); ++x) {
            const bool stands_out =
                from[x] != 0 && from[x] < (moved_ && ids[x] == PaperDecoder::kStill ? near : high);
            const float z = stands_out ? step / (a - b * static_cast<float>(from[x])) : 0.0F;
            to[x] = z > 0.0F && z < kMost ? static_cast<std::uint16_t>(z) : std::uint16_t{0};
        }
    }
}

bool RelativeScene::update(const DepthFrame& relative, const Image<std::uint16_t>& component,
                           int moving_ids, bool followed) {
    grid_.load(relative, static_cast<float>(kLeast_mm));
    const bool moves = moving_ids >= 0 && measure(component, moving_ids);
    const bool rescaled =
        (moves || (!moved_ && measure(component, -1))) && rescale(moves, followed);
    depth_.stamp = relative.stamp;
    depth_.sequence = relative.sequence;
    depth_.span = relative.span;
    depth_.quality = relative.quality;
    if (inverse_background_ > 0.0) {
        convert(relative, component);
    }
    return rescaled;
}

}  // namespace xtrack::segment
