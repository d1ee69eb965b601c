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
/// A hand that nobody expected must look more like one, and a second one still more.
constexpr float kScoreNew = 0.5F;
constexpr float kScoreSecond = 0.6F;
/// A second hand is about as far away as the first; what lies farther behind is something else.
constexpr float kSecondHandBehindMm = 200.0F;
/// What points this much along a hand's arm is its arm: cosine of the angle between them.
constexpr float kAlongArm = 0.5F;
/// What looks out from behind a hand, this much deeper and this near beside it, is its own arm.
constexpr float kArmBehindMm = 40.0F;
constexpr float kArmBesideRadii = 2.6F;

/// Whether something at `d` from a palm may be the hand's own arm.
bool along(const Vec3f& arm_direction, const Vec3f& d) {
    return d.dot(arm_direction) > kAlongArm * d.norm();
}

bool may_be_second(const PalmCandidate& c, const Vec3f& first_palm_mm) {
    return c.score >= kScoreSecond && c.centre_mm.z() - first_palm_mm.z() < kSecondHandBehindMm;
}

}  // namespace

void Segmenter::create(const Rig& rig, Size size, const TrackerSettings& settings) {
    settings_ = settings;
    grid_.create(rig, size, Grid::coarse_scale(size), Grid::fine_scale(size));
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
    search_.create(grid_, settings);
    cut_.create(rig, size, grid_, near_mm_);
    foreground_.assign(grid_.size(), 0.0F);
    limbs_.assign(grid_.size(), 0);
    candidates_.reserve(static_cast<std::size_t>(Parts::kPartsMax * kCandidatesMax));
}

void Segmenter::reset() {
    background_.reset();
    count_ = 0;
    cut_.begin();
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
    choose(depth, priors);
    if (settings_.learn_background) {
        background_.learn(grid_.z, limbs_, elapsed_ms);
    }
}

void Segmenter::choose(const DepthFrame& depth, std::span<const PalmPrior> priors) {
    candidates_.clear();
    for (std::size_t p = 0; p < parts_.parts().size(); ++p) {
        const int n = search_.search(grid_, parts_, static_cast<int>(p), priors, scratch_);
        for (int k = 0; k < n; ++k) {
            const PalmCandidate& c = scratch_[static_cast<std::size_t>(k)];
            if (c.score >= kScoreMin) {
                candidates_.push_back(c);
            }
        }
    }
    std::sort(candidates_.begin(), candidates_.end(),
              [](const PalmCandidate& a, const PalmCandidate& b) { return a.rank > b.rank; });

    cut_.begin();
    std::fill(limbs_.begin(), limbs_.end(), std::uint8_t{0});
    count_ = 0;
    const CoarseScene scene{
        grid_, parts_,
        settings_.learn_background ? background_.depth_mm() : std::span<const float>{},
        static_cast<float>(settings_.background_margin_mm), priors};
    std::array<int, kMaxHands> part_of_region{};
    std::array<int, kMaxHands> prior_of_region{};
    for (const PalmCandidate& c : candidates_) {
        if (count_ >= std::min<int>(settings_.max_hands, static_cast<int>(kMaxHands))) {
            break;
        }
        bool free = c.centre_mm.z() <= far_mm_ && c.score >= kScoreMin;
        if (c.prior < 0) {
            free &= c.score >= kScoreNew && !hidden_behind(c);
            for (const PalmPrior& hand : priors) {
                free &= may_be_second(c, hand.palm_mm);
            }
        }
        for (int k = 0; k < count_; ++k) {
            const HandRegion& other = regions_[static_cast<std::size_t>(k)];
            const Vec3f d = c.centre_mm - other.palm_mm;
            free &= d.norm() > other.palm_radius_mm + c.radius_mm;
            // The other end of the same arm is no second hand, unless it was one before they met.
            const int prior = prior_of_region[static_cast<std::size_t>(k)];
            const bool both_known = c.prior >= 0 && prior >= 0 && c.prior != prior &&
                                    !along(other.arm_direction, d) && !along(c.arm_direction, -d);
            free &= both_known || c.part != part_of_region[static_cast<std::size_t>(k)];
            free &= c.prior >= 0 || may_be_second(c, other.palm_mm);
        }
        if (!free) {
            continue;
        }
        for (const int i : parts_.pixels(parts_.parts()[static_cast<std::size_t>(c.part)])) {
            limbs_[static_cast<std::size_t>(i)] = 1;
        }
        if (cut_.cut(depth, scene, c, settings_, regions_[static_cast<std::size_t>(count_)])) {
            part_of_region[static_cast<std::size_t>(count_)] = c.part;
            prior_of_region[static_cast<std::size_t>(count_)] = c.prior;
            ++count_;
        }
    }
}

bool Segmenter::hidden_behind(const PalmCandidate& c) const {
    return std::any_of(candidates_.begin(), candidates_.end(), [&](const PalmCandidate& front) {
        const Vec3f d = c.centre_mm - front.centre_mm;
        return front.part != c.part && d.z() > kArmBehindMm &&
               std::hypot(d.x(), d.y()) < kArmBesideRadii * front.radius_mm;
    });
}

HandSegmentation Segmenter::view() const noexcept {
    const Grid& fine = cut_.grid();
    return {
        {cut_.labels().data() + fine.index(0, 0), fine.inner_width, fine.inner_height, fine.width},
        fine.scale,
        regions_.data(),
        count_};
}

}  // namespace xtrack::segment
