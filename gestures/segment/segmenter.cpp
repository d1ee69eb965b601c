// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/segmenter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace xtrack::segment {

namespace {

constexpr float kNearDefaultMm = 150.0F;
constexpr float kFarDefaultMm = 1500.0F;
/// Below this a candidate is not a hand.
constexpr float kScoreMin = 0.42F;
/// A hand that nobody expected must look more like one, and a second one still more.
constexpr float kScoreNew = 0.5F;
constexpr float kScoreSecond = 0.6F;
/// A second hand is about as far away as the first; what lies farther behind is something else.
constexpr float kSecondHandBehindMm = 200.0F;
/// What looks out from behind a hand, this much deeper and this near beside it, is its own arm.
constexpr float kArmBehindMm = 40.0F;
constexpr float kArmBesideRadii = 2.6F;
/// Share of the palm's radius over which the skin's depth is averaged.
constexpr float kSkinDiscRadii = 0.35F;
/// The palm's centre is the mean of the pixels whose radius is within this share of the largest.
constexpr float kPlateau = 0.985F;
/// Chamfer distances within this share of the largest are looked at exactly.
constexpr float kRidge = 0.95F;

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
    distance_.assign(grid_.size(), 0);
    rim_x_.assign(grid_.size(), 0);
    rim_y_.assign(grid_.size(), 0);
    ridge_.reserve(grid_.size());
    candidates_.reserve(static_cast<std::size_t>(Parts::kPartsMax * kCandidatesMax));
}

void Segmenter::reset() {
    background_.reset();
    count_ = 0;
    std::fill(labels_.begin(), labels_.end(), std::uint8_t{0});
}

void Segmenter::segment(const DepthFrame& depth, std::int64_t elapsed_ms,
                        std::span<const PalmPrior> priors) {
    grid_.load(depth, near_mm_);
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
              [](const PalmCandidate& a, const PalmCandidate& b) { return a.rank > b.rank; });

    std::fill(labels_.begin(), labels_.end(), std::uint8_t{0});
    std::fill(limbs_.begin(), limbs_.end(), std::uint8_t{0});
    count_ = 0;
    std::array<int, kMaxHands> part_of_region{};
    for (const PalmCandidate& c : candidates_) {
        if (count_ >= std::min<int>(settings_.max_hands, static_cast<int>(kMaxHands))) {
            break;
        }
        bool free = c.centre_mm.z() <= far_mm_ && c.score >= kScoreMin &&
                    (c.prior >= 0 || c.score >= kScoreNew);
        for (int k = 0; k < count_; ++k) {
            const HandRegion& other = regions_[static_cast<std::size_t>(k)];
            const Vec3f d = c.centre_mm - other.palm_mm;
            free &= d.norm() > other.palm_radius_mm + c.radius_mm;
            // The other end of the same arm is no second hand.
            free &= c.part != part_of_region[static_cast<std::size_t>(k)];
            free &= c.prior >= 0 || (d.z() < kSecondHandBehindMm && c.score >= kScoreSecond);
        }
        free &= c.prior >= 0 || !hidden_behind(c);
        if (!free) {
            continue;
        }
        HandRegion& region = regions_[static_cast<std::size_t>(count_)];
        region = {};
        region.label = static_cast<std::uint8_t>(count_ + 1);
        paint(c, region);
        if (region.area_mm2 >= static_cast<float>(settings_.hand_area_min_mm2)) {
            part_of_region[static_cast<std::size_t>(count_)] = c.part;
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
    region.arm_direction = c.arm_direction;
    region.arm_seen = c.arm_seen;
    region.score = c.score;
    region.palm_mm = c.centre_mm;
    centre_palm(region);
    region.wrist_mm = c.centre_mm + c.wrist_mm * c.arm_direction;
}

bool Segmenter::hidden_behind(const PalmCandidate& c) const {
    return std::any_of(candidates_.begin(), candidates_.end(), [&](const PalmCandidate& front) {
        const Vec3f d = c.centre_mm - front.centre_mm;
        return front.part != c.part && d.z() > kArmBehindMm &&
               std::hypot(d.x(), d.y()) < kArmBesideRadii * front.radius_mm;
    });
}

void Segmenter::centre_palm(HandRegion& region) {
    // The circle is inscribed in the hand alone, so its distances are measured anew: the arm that
    // the hand was cut from would widen it.
    const Box box{region.x_begin, region.y_begin, region.x_end, region.y_end};
    for (int y = box.y_begin - kPad; y < box.y_end + kPad; ++y) {
        for (int x = box.x_begin - kPad; x < box.x_end + kPad; ++x) {
            const auto k = static_cast<std::size_t>(grid_.index(x, y));
            const bool outside_image =
                x < 0 || y < 0 || x >= grid_.inner_width || y >= grid_.inner_height;
            distance_[k] = outside_image || labels_[k] == region.label ? kChamferFar : 0;
        }
    }
    spread_distance(grid_, box, distance_);
    const auto radius_px = [&](int i) {
        return static_cast<float>(distance_[static_cast<std::size_t>(i)]) /
                   static_cast<float>(kChamferUnit) -
               0.5F;
    };
    float peak = 0.0F;
    int peak_pixel = grid_.index(box.x_begin, box.y_begin);
    for (int y = box.y_begin; y < box.y_end; ++y) {
        for (int x = box.x_begin; x < box.x_end; ++x) {
            const int i = grid_.index(x, y);
            if (labels_[static_cast<std::size_t>(i)] == region.label && radius_px(i) > peak) {
                peak = radius_px(i);
                peak_pixel = i;
            }
        }
    }
    // Chamfer distances are good to 2 %, which on a palm's flat ridge is 10 mm: near the peak they
    // are replaced by exact ones, to the pixels just outside the rim.
    int rim = 0;
    for (int y = box.y_begin; y < box.y_end; ++y) {
        for (int x = box.x_begin; x < box.x_end; ++x) {
            const int i = grid_.index(x, y);
            if (distance_[static_cast<std::size_t>(i)] == kChamferUnit) {
                rim_x_[static_cast<std::size_t>(rim)] = x;
                rim_y_[static_cast<std::size_t>(rim)] = y;
                ++rim;
            }
        }
    }
    const auto exact_px = [&](int x, int y) {
        int least = std::numeric_limits<int>::max();
        for (int k = 0; k < rim; ++k) {
            const int dx = rim_x_[static_cast<std::size_t>(k)] - x;
            const int dy = rim_y_[static_cast<std::size_t>(k)] - y;
            least = std::min(least, dx * dx + dy * dy);
        }
        return std::sqrt(static_cast<float>(least)) + 0.5F;
    };
    const int px = grid_.x_of(peak_pixel);
    const int py = grid_.y_of(peak_pixel);
    const int around = static_cast<int>(0.6F * peak);
    const Box near{std::max(box.x_begin, px - around), std::max(box.y_begin, py - around),
                   std::min(box.x_end, px + around + 1), std::min(box.y_end, py + around + 1)};
    float best = 0.0F;
    ridge_.clear();
    for (int y = near.y_begin; y < near.y_end; ++y) {
        for (int x = near.x_begin; x < near.x_end; ++x) {
            const int i = grid_.index(x, y);
            if (labels_[static_cast<std::size_t>(i)] == region.label &&
                radius_px(i) > kRidge * peak) {
                ridge_.push_back({x, y, exact_px(x, y)});
                best = std::max(best, ridge_.back().radius_px);
            }
        }
    }
    // Of the highest places the middle: steadier than the one that noise made the highest.
    Vec2f centre = Vec2f::Zero();
    float weight = 0.0F;
    for (const RidgePoint& p : ridge_) {
        const float excess = p.radius_px - kPlateau * best;
        if (excess > 0.0F) {
            centre += excess * Vec2f(static_cast<float>(p.x), static_cast<float>(p.y));
            weight += excess;
        }
    }
    region.palm_px = weight > 0.0F ? Vec2f(centre / weight)
                                   : Vec2f(static_cast<float>(px), static_cast<float>(py));
    region.palm_radius_px = best > 0.0F ? best : peak;
    region.palm_radius_mm =
        region.palm_radius_px * grid_.pitch_mm(grid_.z[static_cast<std::size_t>(peak_pixel)]);

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
    const float skin = n > 0.0F ? sum / n : grid_.z[static_cast<std::size_t>(peak_pixel)];
    const auto k = static_cast<std::size_t>(grid_.index(cx, cy));
    const Vec2f fraction = region.palm_px - Vec2f(static_cast<float>(cx), static_cast<float>(cy));
    region.palm_mm = {(grid_.ray[k].x() + fraction.x() * grid_.inverse_focal) * skin,
                      (grid_.ray[k].y() + fraction.y() * grid_.inverse_focal) * skin, skin};
}

HandSegmentation Segmenter::view() const noexcept {
    return {
        {labels_.data() + grid_.index(0, 0), grid_.inner_width, grid_.inner_height, grid_.width},
        grid_.scale,
        regions_.data(),
        count_};
}

}  // namespace xtrack::segment
