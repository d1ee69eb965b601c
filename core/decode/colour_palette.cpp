// SPDX-License-Identifier: Apache-2.0
#include "core/decode/colour_palette.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/decode/arctangent.hpp"

namespace xtrack {
namespace {

constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
// Skin of any tone reflects about twice as much red as blue (haemoglobin, melanin).
constexpr std::array<float, 3> kSkin{1.4F, 0.95F, 0.75F};
constexpr float kSkinContrast = 0.7F;

// What is at another place in the coarse image must agree there by so much better.
constexpr float kMovesShare = 0.8F;
// Of a cell whose samples agree with one surface, for each pixel.
constexpr float kMixed = 0.05F;
// A window as narrow as a finger is taken if its pixels agree so much better.
constexpr float kNarrowShare = 0.5F;
constexpr float kLeastLight = 30.0F;  // grey levels, sum of the colours

// What a surface is believed to be counts as so many pixels.
constexpr float kBelievedPixels = 20.0F;
constexpr float kDamping = 0.5F;
constexpr float kSureCost = 0.15F;   // pixels of more do not teach
constexpr float kPairWeight = 0.3F;  // of what two periods say, against what the contrast says
constexpr float kFade = 0.5F;        // of what a fit knows, from frame to frame

// Within one period.
float coordinate_px(const ColourModel::Light& seen, const ColourPeriod& period) noexcept {
    return (arctangent2(seen[2], seen[1]) - static_cast<float>(period.phase_rad)) / kTurn *
           static_cast<float>(period.period_px);
}

// How far a is ahead of b, in shares of a period, whole ones left out.
float shares_apart(float a_px, float b_px, const ColourPeriod& period) noexcept {
    const float apart = (a_px - b_px) / static_cast<float>(period.period_px);
    return apart - std::floor(apart + 0.5F);
}

}  // namespace

ColourPalette::ColourPalette(Size image, const ColourModel& model, const ColourPeriod& fine,
                             const std::optional<ColourPeriod>& coarse,
                             const Image<float>& first_px, const Image<float>& last_px)
    : size_(image),
      model_(model),
      fine_(fine),
      coarse_(coarse),
      samples_(samples(image)),
      first_px_(first_px),
      last_px_(last_px),
      cells_((image.width + kCellPx - 1) / kCellPx, (image.height + kCellPx - 1) / kCellPx, 0),
      surfaces_(cells_.width() * kCellPx / kFineStepPx, cells_.height() * kCellPx / kFineStepPx, 0),
      votes_(kVoteCells, kVoteCells, 0.0F),
      vote_contrast_(kVoteCells, kVoteCells, 0.0F),
      blurred_(kVoteCells, kVoteCells, 0.0F) {
    if (coarse) {
        search_ = ColourSearch(model, *coarse, fine);
    }
    for (Image<float>& plane : planes_) {
        plane.resize(samples_.width, samples_.height);
    }
    moved_costs_.resize(samples_.width, cells_.height());
    for (Image<float>& cost : costs_) {
        cost.resize(samples_.width, samples_.height);
    }
    evidence_.resize(static_cast<std::size_t>(cells_.width()) *
                     static_cast<std::size_t>(cells_.height()));
    smoothed_.resize(evidence_.size());
    clear();
}

void ColourPalette::set(std::size_t entry, const ColourSurface& surface) noexcept {
    Entry& e = entries_[entry];
    e.surface = surface;
    e.inverse = model_.inverse(surface);
    e.taps = model_.taps(e.inverse);
}

void ColourPalette::clear() noexcept {
    for (Entry& entry : entries_) {
        entry.fit.clear();
        entry.cells = 0;
    }
    set(0, ColourSurface{});
    set(1, model_.surface(kSkin, kSkinContrast));
    used_ = kGiven;
    cells_.fill(0);
    surfaces_.fill(0);
    votes_.fill(0.0F);
    vote_contrast_.fill(0.0F);
    next_search_ = 0;
    frames_ = 0;
}

void ColourPalette::begin(float moved_px) noexcept {
    moved_px_ = moved_px;
    for (Image<float>& plane : planes_) {
        plane.fill(0.0F);
    }
    std::fill(evidence_.begin(), evidence_.end(), Evidence{});
}

ColourSamplesOut ColourPalette::row(int y) noexcept {
    const int sy = y / kSampleStepPx;
    return {{planes_[0].row(sy), planes_[1].row(sy), planes_[2].row(sy)},
            {planes_[3].row(sy), planes_[4].row(sy), planes_[5].row(sy)},
            planes_[6].row(sy)};
}

std::array<float*, 3> ColourPalette::moved_row(int y) noexcept {
    const int sy = y / kSampleStepPx;
    return {planes_[7].row(sy), planes_[8].row(sy), planes_[9].row(sy)};
}

ColourSamples ColourPalette::row_samples(int row) const noexcept {
    return {{planes_[0].row(row), planes_[1].row(row), planes_[2].row(row)},
            {planes_[3].row(row), planes_[4].row(row), planes_[5].row(row)},
            planes_[6].row(row)};
}

ColourModel::Light ColourPalette::fine_at(int sx, int sy) const noexcept {
    return {planes_[0].at(sx, sy), planes_[1].at(sx, sy), planes_[2].at(sx, sy)};
}

ColourModel::Light ColourPalette::coarse_at(int sx, int sy) const noexcept {
    return {planes_[3].at(sx, sy), planes_[4].at(sx, sy), planes_[5].at(sx, sy)};
}

void ColourPalette::measure(const Entry& entry, const ColourSamples& samples, float moved_px,
                            int count, float* cost) const noexcept {
    ColourCost row;
    row.inverse = entry.inverse;
    row.contrast = entry.surface.contrast;
    row.fine = fine_;
    row.has_coarse = coarse_.has_value();
    row.coarse = coarse_.value_or(ColourPeriod{});
    row.coarse.phase_rad += static_cast<double>(kTurn) * static_cast<double>(moved_px) /
                            std::max(row.coarse.period_px, 1.0);
    row.samples = samples;
    row.count = count;
    row.cost = cost;
    colour_cost(row);
}

void ColourPalette::add_row(int y) noexcept {
    const int sy = y / kSampleStepPx;
    const ColourSamples samples = row_samples(sy);
    Evidence* cells = evidence_.data() + static_cast<std::size_t>(y / kCellPx) *
                                             static_cast<std::size_t>(cells_.width());
    float* moved_costs = moved_costs_.row(y / kCellPx);
    ColourSamples moved = samples;
    for (std::size_t c = 0; c < 3; ++c) {
        moved.coarse[c] = planes_[7 + c].row(sy);
    }
    const bool moves = coarse_ && std::any_of(moved.coarse[0], moved.coarse[0] + samples_.width,
                                              [](float light) { return light > 0.0F; });
    const auto lit = [&](int i) {
        return samples.fine[0][i] + samples.fine[1][i] + samples.fine[2][i] >= kLeastLight;
    };
    for (int i = 0; i < samples_.width; ++i) {
        cells[i * kSampleStepPx / kCellPx].pixels += lit(i) ? 1.0F : 0.0F;
    }
    for (std::size_t k = 0; k < used_; ++k) {
        float* costs = costs_[k].row(sy);
        measure(entries_[k], samples, 0.0F, samples_.width, costs);
        if (moves) {
            measure(entries_[k], moved, moved_px_, samples_.width, moved_costs);
        }
        for (int i = 0; i < samples_.width; ++i) {
            if (lit(i)) {
                Evidence& cell = cells[i * kSampleStepPx / kCellPx];
                cell.cost[k] += costs[i];
                cell.moved[k] += moves ? moved_costs[i] : kMostColourCost;
            }
        }
    }
}

ColourPalette::Evidence ColourPalette::sum_evidence(int cell_x, int cell_y, int reach_x,
                                                    int reach_y) const noexcept {
    Evidence sum;
    for (int y = std::max(0, cell_y - reach_y);
         y <= std::min(cells_.height() - 1, cell_y + reach_y); ++y) {
        for (int x = std::max(0, cell_x - reach_x);
             x <= std::min(cells_.width() - 1, cell_x + reach_x); ++x) {
            const Evidence& of = evidence_[index_of(x, y)];
            const float weight = (x == cell_x ? 2.0F : 1.0F) * (y == cell_y ? 2.0F : 1.0F);
            sum.pixels += weight * of.pixels;
            for (std::size_t k = 0; k < used_; ++k) {
                sum.cost[k] += weight * of.cost[k];
                sum.moved[k] += weight * of.moved[k];
            }
        }
    }
    return sum;
}

// Of the cell and those around it, or along a finger, which can be as narrow as a cell, and what is
// beside it would outvote it.
ColourPalette::Evidence ColourPalette::evidence_around(int cell_x, int cell_y) const noexcept {
    const auto least = [&](const Evidence& of) {
        const auto end = of.cost.begin() + static_cast<std::ptrdiff_t>(used_);
        return of.pixels > 0.0F ? *std::min_element(of.cost.begin(), end) / of.pixels
                                : kMostColourCost;
    };
    Evidence sum = sum_evidence(cell_x, cell_y, 1, 1);
    if (least(sum) < kMixed) {
        return sum;
    }
    for (const Evidence& narrow :
         {sum_evidence(cell_x, cell_y, 0, 1), sum_evidence(cell_x, cell_y, 1, 0)}) {
        sum = least(narrow) < kNarrowShare * least(sum) ? narrow : sum;
    }
    return sum;
}

void ColourPalette::choose() noexcept {
    const int width = cells_.width();
    const int height = cells_.height();
    for (Entry& entry : entries_) {
        entry.cells = 0;
    }
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Evidence& sum = smoothed_[index_of(x, y)] = evidence_around(x, y);
            std::size_t best = 0;
            std::size_t moved = 0;
            for (std::size_t k = 1; k < used_; ++k) {
                best = sum.cost[k] < sum.cost[best] ? k : best;
                moved = sum.moved[k] < sum.moved[moved] ? k : moved;
            }
            const bool moves = sum.moved[moved] < kMovesShare * sum.cost[best];
            best = moves ? moved : best;
            const auto value = static_cast<std::uint8_t>(best + (moves ? kMoved : 0U));
            cells_.at(x, y) = value;
            entries_[best].cells += sum.pixels > 0.0F ? 1 : 0;
            constexpr int kFine = kCellPx / kFineStepPx;
            for (int j = 0; j < kFine; ++j) {
                std::fill_n(surfaces_.row(y * kFine + j) + x * kFine, kFine, value);
            }
        }
    }
}

bool ColourPalette::at_border(int cell_x, int cell_y) const noexcept {
    const std::uint8_t here = cells_.at(cell_x, cell_y);
    for (int j = std::max(0, cell_y - 1); j <= std::min(cells_.height() - 1, cell_y + 1); ++j) {
        for (int i = std::max(0, cell_x - 1); i <= std::min(cells_.width() - 1, cell_x + 1); ++i) {
            if (cells_.at(i, j) != here) {
                return true;
            }
        }
    }
    return false;
}

void ColourPalette::draw_border(int cell_x, int cell_y, const ColourSamples& samples,
                                const std::array<const float*, 3>& moved) noexcept {
    std::array<bool, 2 * kMostSurfaces> near{};  // at rest, then moved
    for (int j = std::max(0, cell_y - 1); j <= std::min(cells_.height() - 1, cell_y + 1); ++j) {
        for (int i = std::max(0, cell_x - 1); i <= std::min(cells_.width() - 1, cell_x + 1); ++i) {
            const std::uint8_t value = cells_.at(i, j);
            near[surface_of(value) + (is_moved(value) ? kMostSurfaces : 0)] = true;
        }
    }
    constexpr int kFine = kCellPx / kFineStepPx;
    std::array<float, kFine * kFine> least{};
    least.fill(std::numeric_limits<float>::max());
    std::array<float, kFineSamples * kFineSamples> costs{};
    ColourSamples moved_samples = samples;
    moved_samples.coarse = moved;
    for (std::size_t n = 0; n < near.size(); ++n) {
        if (!near[n]) {
            continue;
        }
        const bool moves = n >= kMostSurfaces;
        const std::size_t k = n % kMostSurfaces;
        measure(entries_[k], moves ? moved_samples : samples, moves ? moved_px_ : 0.0F,
                static_cast<int>(costs.size()), costs.data());
        for (int y = 0; y < kFine; ++y) {
            for (int x = 0; x < kFine; ++x) {
                float sum = 0.0F;
                for (int j = y; j < y + 3; ++j) {
                    for (int i = x; i < x + 3; ++i) {
                        sum += costs[static_cast<std::size_t>(j * kFineSamples + i)];
                    }
                }
                float& best = least[static_cast<std::size_t>(y * kFine + x)];
                if (sum < best) {
                    best = sum;
                    surfaces_.at(cell_x * kFine + x, cell_y * kFine + y) =
                        static_cast<std::uint8_t>(k + (moves ? kMoved : 0U));
                }
            }
        }
    }
}

void ColourPalette::refine() noexcept {
    for (std::size_t k = 0; k < used_; ++k) {
        entries_[k].fit.fade(frames_ < kFirstFrames ? 0.0F : kFade);
    }
    for (int sy = 0; sy < samples_.height; ++sy) {
        for (int sx = 0; sx < samples_.width; ++sx) {
            const ColourModel::Light light = fine_at(sx, sy);
            const std::uint8_t value =
                cells_.at(sx * kSampleStepPx / kCellPx, sy * kSampleStepPx / kCellPx);
            const std::size_t surface = surface_of(value);
            // What moved agrees only about; it can wait until it rests.
            if (is_moved(value) || light.sum() < kLeastLight ||
                !(costs_[surface].at(sx, sy) < kSureCost)) {
                continue;
            }
            Entry& entry = entries_[surface];
            const ColourModel::Light fine = entry.inverse * light;
            entry.fit.add(entry.surface, fine, 1.0F);
            if (coarse_) {
                const ColourModel::Light coarse = entry.inverse * coarse_at(sx, sy);
                const float ratio =
                    static_cast<float>(fine_.period_px) / static_cast<float>(coarse_->period_px);
                const float ahead = shares_apart(coordinate_px(coarse, *coarse_),
                                                 coordinate_px(fine, fine_), fine_);
                entry.fit.add_pair(entry.surface, fine, coarse, ratio, kTurn * ratio * ahead,
                                   kPairWeight);
            }
        }
    }
    for (std::size_t k = 0; k < used_; ++k) {
        // Half a step: which cells are a surface's changes with what is believed of it.
        Entry& entry = entries_[k];
        set(k, entry.fit.solve(entry.surface, kBelievedPixels + kDamping * entry.fit.pixels()));
    }
}

void ColourPalette::learn() noexcept {
    refine();
    if (coarse_) {
        drop_twins();
        search();
        found_surfaces();
    }
    frames_ = std::min(frames_ + 1, kFirstFrames);
}

}  // namespace xtrack
