// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/segmenter.hpp"

#include <algorithm>
#include <cmath>

namespace xtrack::segment {

namespace {

constexpr float kNearDefaultMm = 150.0F;
constexpr float kFarDefaultMm = 1500.0F;
/// Below this a candidate is not a hand.
constexpr float kScoreMin = 0.42F;
/// A second hand is about as far away as the first; what lies farther behind is something else.
constexpr float kSecondHandBehindMm = 350.0F;
/// Share of the palm's radius over which the skin's depth is averaged.
constexpr float kSkinDiscRadii = 0.35F;
/// The palm's centre is the mean of the pixels whose radius is within this share of the largest.
constexpr float kPlateau = 0.95F;

}  // namespace

void Segmenter::create(const Rig& rig, Size size, const TrackerSettings& settings) {
    settings_ = settings;
    grid_.create(rig, size);
    const auto pick = [](double wanted, double of_rig, float otherwise) {
        return wanted > 0.0 ? static_cast<float>(wanted)
                            : (of_rig > 0.0 ? static_cast<float>(of_rig) : otherwise);
    };
    near_mm_ = pick(settings.near_mm, rig.working_volume ? rig.working_volume->near_mm : 0.0,
                    kNearDefaultMm);
    far_mm_ =
        pick(settings.far_mm, rig.working_volume ? rig.working_volume->far_mm : 0.0, kFarDefaultMm);
    background_.create(grid_.size(), {static_cast<float>(settings.background_margin_mm),
                                      settings.background_hold / std::chrono::milliseconds{1},
                                      settings.hand_rest / std::chrono::milliseconds{1}});
    parts_.create(grid_);
    foreground_.assign(grid_.size(), 0.0F);
    labels_.assign(grid_.size(), 0);
    limbs_.assign(grid_.size(), 0);
    stack_.assign(grid_.size(), 0);
    candidates_.reserve(static_cast<std::size_t>(Parts::kPartsMax * kCandidatesMax));
}

void Segmenter::reset() {
    background_.reset();
    count_ = 0;
    std::fill(labels_.begin(), labels_.end(), std::uint8_t{0});
}

void Segmenter::segment(const DepthFrame& depth, std::int64_t elapsed_ms,
                        std::span<const PalmPrior> priors) {
    grid_.load(depth, near_mm_, far_mm_);
    if (settings_.learn_background) {
        background_.mask(grid_.z, foreground_);
    } else {
        std::copy(grid_.z.begin(), grid_.z.end(), foreground_.begin());
    }
    parts_.find(grid_, foreground_, static_cast<float>(settings_.palm_radius_max_mm),
                static_cast<float>(settings_.hand_area_min_mm2));
    choose(priors);
    if (settings_.learn_background) {
        background_.learn(grid_.z, limbs_, elapsed_ms);
    }
}

void Segmenter::choose(std::span<const PalmPrior> priors) {
    candidates_.clear();
    for (std::size_t p = 0; p < parts_.parts().size(); ++p) {
        const int n = search_palms(grid_, parts_, static_cast<int>(p), priors, settings_, scratch_);
        for (int k = 0; k < n; ++k) {
            const PalmCandidate& c = scratch_[static_cast<std::size_t>(k)];
            if (c.score >= kScoreMin) {
                candidates_.push_back(c);
            }
        }
    }
    std::sort(candidates_.begin(), candidates_.end(),
              [](const PalmCandidate& a, const PalmCandidate& b) { return a.score > b.score; });

    std::fill(labels_.begin(), labels_.end(), std::uint8_t{0});
    std::fill(limbs_.begin(), limbs_.end(), std::uint8_t{0});
    count_ = 0;
    for (const PalmCandidate& c : candidates_) {
        if (count_ >= std::min<int>(settings_.max_hands, static_cast<int>(kMaxHands))) {
            break;
        }
        bool free = true;
        for (int k = 0; k < count_; ++k) {
            const HandRegion& other = regions_[static_cast<std::size_t>(k)];
            const Vec3f d = c.centre_mm - other.palm_mm;
            // The other end of the same arm, or the same hand again.
            free &= d.norm() > other.palm_radius_mm + c.radius_mm;
            free &= parts_.part_of(c.pixel) !=
                        parts_.part_of(grid_.index(static_cast<int>(other.palm_px.x()),
                                                   static_cast<int>(other.palm_px.y()))) ||
                    c.prior >= 0;
            free &= d.z() < kSecondHandBehindMm || c.prior >= 0;
        }
        if (!free) {
            continue;
        }
        HandRegion& region = regions_[static_cast<std::size_t>(count_)];
        region = {};
        region.label = static_cast<std::uint8_t>(count_ + 1);
        paint(c, region);
        if (region.area_mm2 >= static_cast<float>(settings_.hand_area_min_mm2)) {
            ++count_;
        } else {
            for (std::uint8_t& l : labels_) {
                l = l == region.label ? std::uint8_t{0} : l;
            }
        }
    }
}

void Segmenter::paint(const PalmCandidate& c, HandRegion& region) {
    const Part& part = parts_.parts()[static_cast<std::size_t>(c.part)];
    for (const int i : parts_.pixels(part)) {
        limbs_[static_cast<std::size_t>(i)] = 1;
    }
    const float reach = reach_limit_mm(c.radius_mm);
    const int w = grid_.width;
    int used = 0;
    stack_[static_cast<std::size_t>(used++)] = c.pixel;
    labels_[static_cast<std::size_t>(c.pixel)] = region.label;
    region.x_begin = grid_.inner_width;
    region.y_begin = grid_.inner_height;
    // The circle's centre is a plateau of the distance map; its middle is steadier than its peak.
    const float peak = parts_.radius_mm(grid_, c.pixel);
    Vec2f centre = Vec2f::Zero();
    float centre_weight = 0.0F;
    for (int next = 0; next < used; ++next) {
        const int i = stack_[static_cast<std::size_t>(next)];
        const int x = grid_.x_of(i);
        const int y = grid_.y_of(i);
        const float pitch = grid_.pitch_mm(grid_.z[static_cast<std::size_t>(i)]);
        region.area_mm2 += pitch * pitch;
        region.x_begin = std::min(region.x_begin, x);
        region.y_begin = std::min(region.y_begin, y);
        region.x_end = std::max(region.x_end, x + 1);
        region.y_end = std::max(region.y_end, y + 1);
        region.touches_border |=
            x == 0 || y == 0 || x == grid_.inner_width - 1 || y == grid_.inner_height - 1;
        const float excess = parts_.radius_mm(grid_, i) - kPlateau * peak;
        if (excess > 0.0F && (grid_.point(i) - c.centre_mm).norm() < 0.5F * c.radius_mm) {
            centre += excess * Vec2f(static_cast<float>(x), static_cast<float>(y));
            centre_weight += excess;
        }
        for (const int o : {-w, -1, 1, w}) {
            const int m = i + o;
            const auto k = static_cast<std::size_t>(m);
            if (parts_.part_of(m) != c.part || labels_[k] != 0) {
                continue;
            }
            const Vec3f d = grid_.point(m) - c.centre_mm;
            if (d.dot(c.arm_direction) > c.wrist_mm || d.norm() > reach) {
                continue;
            }
            labels_[k] = region.label;
            stack_[static_cast<std::size_t>(used++)] = m;
        }
    }
    region.pixel_count = used;
    region.palm_px = centre_weight > 0.0F ? Vec2f(centre / centre_weight)
                                          : Vec2f(static_cast<float>(grid_.x_of(c.pixel)),
                                                  static_cast<float>(grid_.y_of(c.pixel)));
    region.palm_radius_px = parts_.radius_px(c.pixel);
    region.palm_radius_mm = c.radius_mm;

    // The skin at the centre: the mean depth of a disc round it, without what is far off.
    const float disc = std::max(1.5F, kSkinDiscRadii * region.palm_radius_px);
    const int reach_px = static_cast<int>(disc);
    const int cx = static_cast<int>(std::lround(region.palm_px.x()));
    const int cy = static_cast<int>(std::lround(region.palm_px.y()));
    float sum = 0.0F;
    float n = 0.0F;
    for (int dy = -reach_px; dy <= reach_px; ++dy) {
        for (int dx = -reach_px; dx <= reach_px; ++dx) {
            const int x = cx + dx;
            const int y = cy + dy;
            if (x < 0 || y < 0 || x >= grid_.inner_width || y >= grid_.inner_height ||
                static_cast<float>(dx * dx + dy * dy) > disc * disc) {
                continue;
            }
            const auto k = static_cast<std::size_t>(grid_.index(x, y));
            if (labels_[k] == region.label) {
                sum += grid_.z[k];
                n += 1.0F;
            }
        }
    }
    const float skin = n > 0.0F ? sum / n : c.centre_mm.z();
    const auto k = static_cast<std::size_t>(grid_.index(cx, cy));
    const Vec2f fraction = region.palm_px - Vec2f(static_cast<float>(cx), static_cast<float>(cy));
    region.palm_mm = {(grid_.ray[k].x() + fraction.x() * grid_.inverse_focal) * skin,
                      (grid_.ray[k].y() + fraction.y() * grid_.inverse_focal) * skin, skin};
    region.arm_direction = c.arm_direction;
    region.arm_seen = c.arm_seen;
    region.wrist_mm = region.palm_mm + c.wrist_mm * c.arm_direction;
    region.score = c.score;
}

HandSegmentation Segmenter::view() const noexcept {
    return {
        {labels_.data() + grid_.index(0, 0), grid_.inner_width, grid_.inner_height, grid_.width},
        grid_.scale,
        regions_.data(),
        count_};
}

}  // namespace xtrack::segment
