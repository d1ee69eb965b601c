// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/limb.hpp"

#include <algorithm>

namespace xtrack::segment {

namespace {

/// Samples of a part that are looked at; more change nothing and cost time.
constexpr std::size_t kSamplesMax = 450;
/// So many places say where the fingers are.
constexpr std::size_t kFingerPlacesMax = 32;
/// The fingers of one hand are this near to each other's middle, and those of two no nearer, mm.
constexpr float kFingersMm = 60.0F;
constexpr float kOtherFingersMm = 150.0F;

}  // namespace

void Limb::create(const Grid& grid, float thick_mm) {
    thick_mm_ = thick_mm;
    samples_.reserve(kSamplesMax + 1);
    thick_.reserve(grid.size());
    ridges_.reserve(grid.size());
}

void Limb::take(const Grid& grid, const Parts& parts, const Part& part) {
    samples_.clear();
    thick_.clear();
    ridges_.clear();
    const auto pixels = parts.pixels(part);
    const std::size_t step = 1 + pixels.size() / kSamplesMax;
    const auto weight = static_cast<float>(step);
    int row_begin = 0;
    int row_end = 0;
    bool border_row = false;
    std::size_t next = 0;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
        const int i = pixels[k];
        const bool sampled = k == next;
        const bool ridge = parts.ridge(i);
        if (!sampled && !ridge) {
            continue;
        }
        if (i >= row_end) {
            const int y = grid.y_of(i);  // a division, so once a row
            row_begin = grid.index(0, y);
            row_end = row_begin + grid.width;
            border_row = y <= 1 || y >= grid.inner_height - 2;
        }
        const int x = i - row_begin;
        const float pitch = grid.pitch_mm(grid.z[static_cast<std::size_t>(i)]);
        const float radius = parts.radius_px(i) * pitch;
        const Sample s{grid.point(i), radius, weight * pitch * pitch,
                       border_row || x <= 1 || x >= grid.inner_width - 2, i};
        if (ridge && radius >= thick_mm_) {
            thick_.push_back(s);
        } else if (ridge && radius < kFingerRadiusMm) {
            ridges_.push_back({s.p_mm, 2.0F * radius * pitch});
        }
        if (sampled) {
            samples_.push_back(s);
            next += step;
        }
    }
}

const Limb::Sample& Limb::farthest(const Vec3f& from) const {
    float best = -1.0F;
    const Sample* found = &samples_.front();
    for (const Sample& s : samples_) {
        const float d = (s.p_mm - from).squaredNorm();
        if (d > best) {
            best = d;
            found = &s;
        }
    }
    return *found;
}

const Limb::Sample* Limb::thickest(const Around& around) const {
    float best = 0.0F;
    const Sample* found = nullptr;
    for (const Sample& s : thick_) {
        if (s.radius_mm <= best) {
            continue;
        }
        const float d = (s.p_mm - around.p_mm).norm();
        if (d > around.limit_mm) {
            continue;
        }
        const float worth =
            s.radius_mm * (1.0F - around.loss_per_mm * std::max(0.0F, d - around.full_mm));
        if (worth > best) {
            best = worth;
            found = &s;
        }
    }
    return found;
}

const Limb::Ridge* Limb::most_fingers(const Ridge* but) const {
    const std::size_t step = 1 + ridges_.size() / kFingerPlacesMax;
    const auto near = [](const Ridge& a, const Ridge& b, float limit_mm) {
        return (a.p_mm - b.p_mm).squaredNorm() < limit_mm * limit_mm;
    };
    float best = 0.0F;
    const Ridge* where = nullptr;
    for (std::size_t k = 0; k < ridges_.size(); k += step) {
        const Ridge& here = ridges_[k];
        if (but != nullptr && near(here, *but, kOtherFingersMm)) {
            continue;
        }
        float sum = 0.0F;
        for (std::size_t m = 0; m < ridges_.size(); m += step) {
            sum += near(ridges_[m], here, kFingersMm) ? ridges_[m].area_mm2 : 0.0F;
        }
        if (sum > best) {
            best = sum;
            where = &here;
        }
    }
    return where;
}

}  // namespace xtrack::segment
