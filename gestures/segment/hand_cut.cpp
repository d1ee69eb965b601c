// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/hand_cut.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace xtrack::segment {

namespace {

/// Share of the palm's radius over which the skin's depth is averaged.
constexpr float kSkinDiscRadii = 0.35F;
/// The palm's centre is the mean of the pixels whose radius is within this share of the largest.
constexpr float kPlateau = 0.985F;
/// Chamfer distances within this share of the largest are looked at exactly.
constexpr float kRidge = 0.95F;
/// The cut at the wrist may take this much off the palm's circle.
constexpr float kCutShare = 0.95F;
/// And this near to the largest, in its radii.
constexpr float kRidgeRadii = 0.6F;
/// A finger that is hidden at its root is a surface of its own, behind the fingers that are folded
/// before it: so much nearer or farther than the palm, before any body, so long and wide, mm.
constexpr float kFingerBeforeMm = 60.0F;
constexpr float kFingerBehindMm = 40.0F;
constexpr float kFingerBeforeBodyMm = 30.0F;
constexpr float kFingerLengthMm = 30.0F;
constexpr float kFingerWidthMinMm = 7.0F;
constexpr float kFingerWidthMaxMm = 24.0F;
/// Radius where two of them part.
constexpr float kTwoFingersMm = 21.0F;
/// The hand is the component that most pixels this near to the palm's centre belong to, grid px.
constexpr int kSeedReach = 3;

}  // namespace

void HandCut::create(const Rig& rig, Size size, const Grid& coarse, float near_mm) {
    near_mm_ = near_mm;
    const int scale = Grid::fine_scale(size);
    ratio_shift_ = coarse.scale > scale ? 1 : 0;
    grid_.create(rig, size, scale, scale);
    components_.create(grid_);
    own_.assign(coarse.size(), kNowhere);
    finger_.reserve(coarse.size());
    rows_.assign(coarse.size(), kNowhere);
    depths_.assign(coarse.size(), kNowhere);
    inside_.assign(grid_.size(), 0);
    low_mm_.assign(static_cast<std::size_t>(grid_.width), 0.0F);
    high_mm_.assign(static_cast<std::size_t>(grid_.width), 0.0F);
    labels_.assign(grid_.size(), 0);
    nearness_.assign(grid_.size(), 0);
    rim_x_.reserve(grid_.size());
    rim_y_.reserve(grid_.size());
    ridge_.reserve(grid_.size());
}

void HandCut::begin() {
    for (std::size_t k = 0; k < painted_count_; ++k) {
        clear(painted_[k]);
    }
    painted_count_ = 0;
}

void HandCut::clear(const HandRegion& region) {
    for (int y = region.y_begin; y < region.y_end; ++y) {
        std::fill_n(labels_.begin() + grid_.index(region.x_begin, y), region.x_end - region.x_begin,
                    std::uint8_t{0});
    }
}

bool HandCut::cut(const DepthFrame& depth, const CoarseScene& coarse, const PalmCandidate& palm,
                  const TrackerSettings& settings, HandRegion& region) {
    region = {};
    if (painted_count_ == painted_.size()) {
        return false;
    }
    set_ends(palm, coarse.expected);
    const Box cells = mark_coarse(coarse, palm);
    const int ratio = 1 << ratio_shift_;
    const Box box = grid_.grown(
        {cells.x_begin * ratio, cells.y_begin * ratio, cells.x_end * ratio, cells.y_end * ratio},
        0);
    if (box.empty()) {
        return false;
    }
    grid_.load(depth, near_mm_, box);
    find_pixels(coarse, palm, cells, box);
    const int component = component_at(coarse, palm, box);
    if (component < 0) {
        return false;
    }
    region.label = static_cast<std::uint8_t>(painted_count_ + 1);
    paint(component, region);
    region.arm_direction = palm.arm_direction;
    region.arm_seen = palm.arm_seen;
    region.score = palm.score;
    region.wrist_mm = palm.centre_mm + palm.wrist_mm * palm.arm_direction;
    if (region.area_mm2 >= static_cast<float>(settings.hand_area_min_mm2)) {
        centre_palm(palm, region);
    }
    const float least = kCutShare * static_cast<float>(settings.palm_radius_min_mm);
    if (region.palm_radius_mm < (palm.prior >= 0 ? kEdgeOnShare * least : least)) {
        clear(region);
        return false;
    }
    painted_[painted_count_++] = region;
    return true;
}

void HandCut::set_ends(const PalmCandidate& palm, std::span<const PalmPrior> expected) {
    ends_[0] = {palm.arm_direction, palm.wrist_mm};
    end_count_ = 1;
    if (palm.prior < 0) {
        return;
    }
    for (std::size_t m = 0; m < expected.size() && end_count_ < ends_.size(); ++m) {
        const Vec3f d = expected[m].palm_mm - palm.centre_mm;
        const float distance = d.norm();
        // A palm whose middle lies in this one's circle is no other hand, or was none. Those of
        // hands that touch overlap.
        if (palm.prior != static_cast<int>(m) && distance > palm.radius_mm) {
            ends_[end_count_++] = {d / distance, 0.5F * distance};
        }
    }
}

bool HandCut::may_be_finger(const CoarseScene& coarse, const PalmCandidate& palm, int i) const {
    const auto k = static_cast<std::size_t>(i);
    const float z = coarse.grid.z[k];
    if (z <= 0.0F || own_[k].high_mm != 0.0F) {
        return false;
    }
    // Two fingers are enough surface to be a part; what is thicker has been looked at as a hand, a
    // body or an arm.
    if (coarse.parts.part_of(i) == palm.part || is_another(coarse, palm, i)) {
        return false;
    }
    const float known = coarse.background_mm.empty() ? 0.0F : coarse.background_mm[k];
    if (known > 0.0F && z > known - coarse.margin_mm) {
        return false;
    }
    for (const Body& body : coarse.parts.bodies()) {
        if (z > body.front_mm - kFingerBeforeBodyMm) {
            return false;  // a patch of it, between hand and arm
        }
    }
    const Vec3f d = coarse.grid.point(i) - palm.centre_mm;
    return d.z() > -kFingerBeforeMm && d.z() < kFingerBehindMm && beyond_ends(d) <= 0.0F &&
           d.norm() <= reach_limit_mm(palm.radius_mm);
}

/// A surface that is neither the hand's nor thin enough for a finger.
bool HandCut::is_another(const CoarseScene& coarse, const PalmCandidate& palm, int i) {
    const int part = coarse.parts.part_of(i);
    return part == Parts::kOther ||
           (part >= 0 && part != palm.part &&
            coarse.parts.parts()[static_cast<std::size_t>(part)].thickest_mm > kTwoFingersMm);
}

/// Adds the surface that a pixel belongs to, if it is a finger.
/// @return the box of what was added; empty: it is none
Box HandCut::grow_finger(const CoarseScene& coarse, const PalmCandidate& palm, int from) {
    const Grid& grid = coarse.grid;
    const std::size_t first = finger_.size();
    const auto take = [&](int i) {
        const float z = grid.z[static_cast<std::size_t>(i)];
        own_[static_cast<std::size_t>(i)] = {z, z, false};
        finger_.push_back(i);
    };
    take(from);
    Box box{grid.inner_width, grid.inner_height, 0, 0};
    float area_mm2 = 0.0F;
    float length_mm = 0.0F;
    bool at_another = false;  // it hangs on a body, or on what lies on it
    for (std::size_t n = first; n < finger_.size(); ++n) {
        const int i = finger_[n];
        const float z = grid.z[static_cast<std::size_t>(i)];
        const int x = grid.x_of(i);
        const int y = grid.y_of(i);
        box = {std::min(box.x_begin, x), std::min(box.y_begin, y), std::max(box.x_end, x + 1),
               std::max(box.y_end, y + 1)};
        area_mm2 += grid.area_mm2(i, i + 1);
        length_mm = std::max(length_mm, (grid.point(i) - grid.point(from)).head<2>().norm());
        for (const int o : {-grid.width, -1, 1, grid.width}) {
            const float step = std::abs(grid.z[static_cast<std::size_t>(i + o)] - z);
            if (may_be_finger(coarse, palm, i + o)) {
                if (step < grid.step_limit_mm(z)) {
                    take(i + o);
                }
            } else if (step < kFingerBehindMm && is_another(coarse, palm, i + o)) {
                at_another = true;
            }
        }
    }
    const float width_mm = area_mm2 / std::max(length_mm, 1.0F);
    const int part = coarse.parts.part_of(from);
    if (!at_another && length_mm >= kFingerLengthMm && width_mm >= kFingerWidthMinMm &&
        (part >= 0 || width_mm <= kFingerWidthMaxMm)) {
        if (part >= 0) {
            adopted_[static_cast<std::size_t>(part)] = true;
        }
        return box;
    }
    for (std::size_t n = first; n < finger_.size(); ++n) {
        own_[static_cast<std::size_t>(finger_[n])] = kNoFinger;
    }
    return {};
}

/// Fingers whose root is hidden by the fingers before them: they touch the hand in the image only.
/// @param pixels of the hand's part
/// @return the box with them
Box HandCut::adopt_fingers(const CoarseScene& coarse, const PalmCandidate& palm,
                           std::span<const int> pixels, Box box) {
    finger_.clear();
    adopted_.fill(false);
    const int w = coarse.grid.width;
    for (const int i : pixels) {
        if (own_[static_cast<std::size_t>(i)].high_mm <= 0.0F) {
            continue;
        }
        for (const int o : {-w, -1, 1, w}) {
            if (!may_be_finger(coarse, palm, i + o)) {
                continue;
            }
            const Box finger = grow_finger(coarse, palm, i + o);
            if (!finger.empty()) {
                box = {std::min(box.x_begin, finger.x_begin), std::min(box.y_begin, finger.y_begin),
                       std::max(box.x_end, finger.x_end), std::max(box.y_end, finger.y_end)};
            }
        }
    }
    return box;
}

/// Where the hand is on the coarse grid, and how deep round each of its pixels.
/// @return the box of coarse pixels that may hold some of it
Box HandCut::mark_coarse(const CoarseScene& coarse, const PalmCandidate& palm) {
    const Grid& grid = coarse.grid;
    const Part& part = coarse.parts.parts()[static_cast<std::size_t>(palm.part)];
    const float reach = reach_limit_mm(palm.radius_mm);
    const float pixel = 1.5F * grid.pitch_mm(palm.centre_mm.z());
    int first = std::numeric_limits<int>::max();
    int last = 0;
    int left = grid.width;
    int right = 0;
    int row_begin = 0;
    for (const int i : coarse.parts.pixels(part)) {
        const Vec3f d = grid.point(i) - palm.centre_mm;
        // How much farther than wrist and reach allow.
        const float beyond = std::max(beyond_ends(d), d.norm() - reach);
        if (beyond > pixel) {
            continue;
        }
        if (i >= row_begin + grid.width) {
            row_begin = i - i % grid.width;  // pixels come row by row
        }
        first = std::min(first, i);
        last = i;
        left = std::min(left, i - row_begin);
        right = std::max(right, i - row_begin);
        own_[static_cast<std::size_t>(i)] = {d.z() + palm.centre_mm.z(), d.z() + palm.centre_mm.z(),
                                             beyond < -2.0F * pixel};
    }
    if (first > last) {
        return {};
    }
    // One pixel more: a fingertip may have too little of a coarse pixel to show there.
    const Box cells = grid.grown(
        adopt_fingers(coarse, palm, coarse.parts.pixels(part),
                      {left - kPad, grid.y_of(first), right - kPad + 1, grid.y_of(last) + 1}),
        1);
    const auto both = [](const Depths& a, const Depths& b) -> Depths {
        return {std::min(a.low_mm, b.low_mm), std::max(a.high_mm, b.high_mm), a.whole};
    };
    for (int y = cells.y_begin; y < cells.y_end; ++y) {
        const int begin = grid.index(cells.x_begin, y);
        // The padding on either side is nowhere, too.
        for (int i = begin; i < begin + cells.width(); ++i) {
            const auto k = static_cast<std::size_t>(i);
            rows_[k] = both(both(own_[k], own_[k - 1]), own_[k + 1]);
        }
    }
    for (int y = cells.y_begin; y < cells.y_end; ++y) {
        std::fill_n(own_.begin() + grid.index(cells.x_begin, y), cells.width(), kNowhere);
    }
    for (const int i : finger_) {  // what was no finger may lie anywhere
        own_[static_cast<std::size_t>(i)] = kNowhere;
    }
    for (int y = cells.y_begin; y < cells.y_end; ++y) {
        const int begin = grid.index(cells.x_begin, y);
        for (int i = begin; i < begin + cells.width(); ++i) {
            const auto k = static_cast<std::size_t>(i);
            Depths d = rows_[k];
            if (y > cells.y_begin) {
                d = both(d, rows_[k - static_cast<std::size_t>(grid.width)]);
            }
            if (y + 1 < cells.y_end) {
                d = both(d, rows_[k + static_cast<std::size_t>(grid.width)]);
            }
            const int owner = coarse.parts.part_of(i);
            const bool others = owner != palm.part && owner != Parts::kNone &&
                                (owner < 0 || !adopted_[static_cast<std::size_t>(owner)]);
            const float limit = grid.step_limit_mm(d.low_mm);
            // What is as far as the background is background, though a hand's pixel has some of it.
            const float known = coarse.background_mm.empty() ? 0.0F : coarse.background_mm[k];
            const float most = known > 0.0F ? known - coarse.margin_mm : 1e9F;
            depths_[k] = others || d.high_mm <= 0.0F
                             ? kNowhere
                             : Depths{d.low_mm - limit, std::min(d.high_mm + limit, most), d.whole};
        }
    }
    return cells;
}

void HandCut::find_pixels(const CoarseScene& coarse, const PalmCandidate& palm, const Box& cells,
                          const Box& box) {
    const float reach = reach_limit_mm(palm.radius_mm);
    const int ratio = 1 << ratio_shift_;
    const int width = box.width();
    // One row of the coarse grid, each pixel as often as the fine one has it.
    float* const low = low_mm_.data();
    float* const high = high_mm_.data();
    int row_before = -1;
    for (int y = box.y_begin; y < box.y_end; ++y) {
        const int coarse_y = y >> ratio_shift_;
        const Depths* const row = depths_.data() + coarse.grid.index(cells.x_begin, coarse_y);
        if (coarse_y != row_before) {
            for (int x = 0; x < width; ++x) {
                low[x] = row[x >> ratio_shift_].low_mm;
                high[x] = row[x >> ratio_shift_].high_mm;
            }
            row_before = coarse_y;
        }
        const int begin = grid_.index(box.x_begin, y);
        const float* const z = grid_.z.data() + begin;
        std::uint8_t* const in = inside_.data() + begin;
        for (int x = 0; x < width; ++x) {
            in[x] = static_cast<std::uint8_t>((z[x] > 0.0F) & (z[x] > low[x]) & (z[x] <= high[x]));
        }
        for (int cell = 0; cell < cells.width(); ++cell) {
            if (row[cell].whole || row[cell].high_mm <= 0.0F) {
                continue;
            }
            for (int x = cell * ratio; x < std::min((cell + 1) * ratio, width); ++x) {
                if (in[x] != 0) {
                    const Vec3f d = grid_.point(begin + x) - palm.centre_mm;
                    const bool near = beyond_ends(d) <= 0.0F && d.squaredNorm() <= reach * reach;
                    in[x] = near ? std::uint8_t{1} : std::uint8_t{0};
                }
            }
        }
    }
    const std::uint8_t* const inside = inside_.data();
    components_.find_in(grid_, box, std::span<const std::uint8_t>(inside_),
                        [inside](int a, int b) { return (inside[a] & inside[b]) != 0; });
}

int HandCut::component_at(const CoarseScene& coarse, const PalmCandidate& palm,
                          const Box& box) const {
    // The middle of the coarse pixel.
    const int x = (coarse.grid.x_of(palm.pixel) << ratio_shift_) + ratio_shift_;
    const int y = (coarse.grid.y_of(palm.pixel) << ratio_shift_) + ratio_shift_;
    int best = 0;
    int component = -1;
    for (int dy = -kSeedReach; dy <= kSeedReach; ++dy) {
        if (y + dy < box.y_begin || y + dy >= box.y_end) {
            continue;
        }
        const int from = grid_.index(x - kSeedReach, y + dy);
        const int to = from + 2 * kSeedReach + 1;
        for (const Components::Run& run : components_.runs()) {
            const int shared = std::min(run.end, to) - std::max(run.begin, from);
            if (shared > best) {
                best = shared;
                component = run.component;
            }
        }
    }
    return component;
}

void HandCut::paint(int component, HandRegion& region) {
    region.x_begin = grid_.inner_width;
    region.y_begin = grid_.inner_height;
    for (const Components::Run& run : components_.runs()) {
        if (run.component != component) {
            continue;
        }
        const int y = grid_.y_of(run.begin);
        const int x_begin = run.begin - grid_.index(0, y);
        const int x_end = x_begin + run.end - run.begin;
        std::fill(labels_.begin() + run.begin, labels_.begin() + run.end, region.label);
        region.area_mm2 += grid_.area_mm2(run.begin, run.end);
        region.pixel_count += run.end - run.begin;
        region.x_begin = std::min(region.x_begin, x_begin);
        region.y_begin = std::min(region.y_begin, y);
        region.x_end = std::max(region.x_end, x_end);
        region.y_end = std::max(region.y_end, y + 1);
    }
    region.touches_border = region.x_begin == 0 || region.y_begin == 0 ||
                            region.x_end == grid_.inner_width || region.y_end == grid_.inner_height;
}

void HandCut::centre_palm(const PalmCandidate& palm, HandRegion& region) {
    // The circle is inscribed in the hand alone, so its distances are measured anew: the arm that
    // the hand was cut from would widen it.
    const Box box{region.x_begin, region.y_begin, region.x_end, region.y_end};
    rim_x_.clear();
    rim_y_.clear();
    // Beyond the image's border the hand may go on.
    const int left = std::max(box.x_begin - kPad, 0);
    const int right = std::min(box.x_end + kPad, grid_.inner_width);
    for (int y = box.y_begin - kPad; y < box.y_end + kPad; ++y) {
        const auto row = nearness_.begin() + grid_.index(0, y);
        std::fill(row + box.x_begin - kPad, row + box.x_end + kPad, std::uint16_t{0});
        if (y < 0 || y >= grid_.inner_height) {
            continue;
        }
        const std::uint8_t* const labels = labels_.data() + grid_.index(0, y);
        for (int x = left; x < right; ++x) {
            row[x] = labels[x] == region.label ? std::uint16_t{0} : kNearnessMax;
        }
    }
    spread(grid_, box, nearness_);
    const auto radius_px = [&](int i) {
        return distance_px(nearness_[static_cast<std::size_t>(i)]) - 0.5F;
    };
    int peak_pixel = grid_.index(box.x_begin, box.y_begin);
    std::uint16_t least = kNearnessMax;
    for (int y = box.y_begin; y < box.y_end; ++y) {
        const int begin = grid_.index(box.x_begin, y);
        for (int x = 0; x < box.width(); ++x) {
            const std::uint16_t nearness = nearness_[static_cast<std::size_t>(begin + x)];
            if (nearness < least) {
                least = nearness;
                peak_pixel = begin + x;
            }
            // Chamfer distances are good to 2 %, which on a palm's flat ridge is 10 mm: near the
            // peak they are replaced by exact ones, to the pixels just inside the rim.
            if (nearness == kNearnessMax - kChamferUnit) {
                rim_x_.push_back(box.x_begin + x);
                rim_y_.push_back(y);
            }
        }
    }
    const float peak = radius_px(peak_pixel);
    const int px = grid_.x_of(peak_pixel);
    const int py = grid_.y_of(peak_pixel);
    const int around = static_cast<int>(kRidgeRadii * peak);
    const Box near{std::max(box.x_begin, px - around), std::max(box.y_begin, py - around),
                   std::min(box.x_end, px + around + 1), std::min(box.y_end, py + around + 1)};
    float best = 0.0F;
    float widest = 0.0F;
    ridge_.clear();
    for (int y = near.y_begin; y < near.y_end; ++y) {
        for (int x = near.x_begin; x < near.x_end; ++x) {
            const int i = grid_.index(x, y);
            if (labels_[static_cast<std::size_t>(i)] == region.label &&
                radius_px(i) > kRidge * peak) {
                const float radius = exact_radius_px(x, y);
                float worth = radius;
                if (palm.prior >= 0) {
                    const Vec3f d = grid_.point(i) - palm.expected_mm;
                    worth *= 1.0F - kWander * std::min(1.0F, d.head<2>().norm() / palm.radius_mm);
                }
                ridge_.push_back({x, y, worth});
                best = std::max(best, worth);
                widest = std::max(widest, radius);
            }
        }
    }
    // Of the highest places the middle: steadier than the one that noise made the highest.
    Vec2f centre = Vec2f::Zero();
    float weight = 0.0F;
    for (const RidgePoint& p : ridge_) {
        const float excess = p.worth_px - kPlateau * best;
        if (excess > 0.0F) {
            centre += excess * Vec2f(static_cast<float>(p.x), static_cast<float>(p.y));
            weight += excess;
        }
    }
    region.palm_px = weight > 0.0F ? Vec2f(centre / weight)
                                   : Vec2f(static_cast<float>(px), static_cast<float>(py));
    region.palm_radius_px = widest > 0.0F ? widest : peak;
    const float peak_mm = grid_.z[static_cast<std::size_t>(peak_pixel)];
    region.palm_radius_mm = region.palm_radius_px * grid_.pitch_mm(peak_mm);

    const float skin = skin_mm(region, peak_mm);
    const int cx = static_cast<int>(std::lround(region.palm_px.x()));
    const int cy = static_cast<int>(std::lround(region.palm_px.y()));
    const auto k = static_cast<std::size_t>(grid_.index(cx, cy));
    const Vec2f fraction = region.palm_px - Vec2f(static_cast<float>(cx), static_cast<float>(cy));
    region.palm_mm = {(grid_.ray[k].x() + fraction.x() * grid_.inverse_focal) * skin,
                      (grid_.ray[k].y() + fraction.y() * grid_.inverse_focal) * skin, skin};
}

float HandCut::exact_radius_px(int x, int y) const {
    int least = std::numeric_limits<int>::max();
    for (std::size_t k = 0; k < rim_x_.size(); ++k) {
        const int dx = rim_x_[k] - x;
        const int dy = rim_y_[k] - y;
        least = std::min(least, dx * dx + dy * dy);
    }
    return std::sqrt(static_cast<float>(least)) + 0.5F;
}

/// The skin at the palm's centre: the mean depth of a disc round it.
float HandCut::skin_mm(const HandRegion& region, float otherwise) const {
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
    return n > 0.0F ? sum / n : otherwise;
}

}  // namespace xtrack::segment
