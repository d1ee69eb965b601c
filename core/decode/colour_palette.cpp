// SPDX-License-Identifier: Apache-2.0
#include "core/decode/colour_palette.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/decode/arctangent.hpp"
#include "core/decode/colour_cost_weights.hpp"

namespace xtrack {
namespace {

constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
// Skin of any tone reflects about twice as much red as blue (haemoglobin, melanin).
constexpr std::array<float, 3> kSkin{1.4F, 0.95F, 0.75F};
constexpr float kSkinContrast = 0.7F;
// Nearer to it in E: light may go through; once it does, farther as well.
constexpr float kLikeSkin = 0.1F;
constexpr float kStillLikeSkin = 0.13F;
// Grey, and as many tints around it, of which skin is one, that all neighbours are as far apart.
constexpr std::size_t kTints = 7;

// What is at another place in the coarse image must agree there by so much better.
constexpr float kMovesShare = 0.8F;
// Of a cell whose samples agree with one surface, for each pixel.
constexpr float kMixed = 0.05F;
// A window as narrow as a finger is taken if its pixels agree so much better.
constexpr float kNarrowShare = 0.5F;
constexpr float kLeastLight = 30.0F;  // grey levels, sum of the colours
constexpr float kSameLight = 0.1F;

// What a surface is believed to be counts as so many pixels.
constexpr float kBelievedPixels = 20.0F;
constexpr float kDamping = 0.5F;
constexpr float kSureCost = 0.15F;   // pixels of more do not teach
constexpr float kPairWeight = 0.3F;  // of what two periods say, against what the contrast says
constexpr float kKept = 0.5F;        // of what a fit knows, from frame to frame

// What a contrast that is not the usual one counts beside one that changes with the phase.
constexpr float kUnusualContrast = 0.05F;
constexpr float kMostLoneContrast = 2.0F;  // of a sample; more says no more
// How far a given surface may become another, over E: a third of the way to its neighbours.
constexpr float kLeash = 0.06F;
// What a surface that is seen e times less than another must explain better: a cell is smaller than
// a fringe, and a little of a fringe is explained by much.
constexpr float kRare = 0.4F;

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

float possible(float contrast) noexcept {
    return contrast >= 0.0F && contrast < kMostLoneContrast ? contrast : kMostLoneContrast;
}

void keep_near(const std::array<float, 2>& given, std::array<float, 2>& log_gain) noexcept {
    const float re = log_gain[0] - given[0];
    const float im = log_gain[1] - given[1];
    const float share = kLeash / std::max(std::hypot(re, im), kLeash);
    log_gain = {given[0] + share * re, given[1] + share * im};
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
    contrasts_.resize(samples_.width, cells_.height());
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
    e.coarse_inverse = model_.coarse_inverse(surface);
    e.taps = model_.taps(e.inverse);
}

void ColourPalette::clear() noexcept {
    for (Entry& entry : entries_) {
        entry.fit.clear();
        entry.cells = 0;
    }
    const ColourSurface skin = model_.surface(kSkin, kSkinContrast);
    set(0, ColourSurface{});
    set(1, skin);
    used_ = kGiven;
    for (; !coarse_ && used_ < kTints; ++used_) {
        ColourSurface tint = skin;
        const float turn = kTurn * static_cast<float>(used_ - 1) / (kTints - 1);
        const float c = std::cos(turn);
        const float s = std::sin(turn);
        tint.log_gain = {c * skin.log_gain[0] - s * skin.log_gain[1],
                         s * skin.log_gain[0] + c * skin.log_gain[1]};
        set(used_, tint);
    }
    for (Entry& entry : entries_) {
        entry.given = entry.surface.log_gain;
    }
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

// True where a contrast is all that a sample shows.
bool ColourPalette::is_alone(int sx, int sy) const noexcept {
    return !coarse_ && std::isnan(planes_[6].at(sx, sy));
}

// True where both periods show the same light, as where no fringes fall: any surface explains it.
bool ColourPalette::is_unlit(int sx, int sy) const noexcept {
    const ColourModel::Light fine = fine_at(sx, sy);
    return coarse_ && (fine - coarse_at(sx, sy)).cwiseAbs().sum() < kSameLight * fine.sum();
}

// The cost of contrasts that differ from their mean, and of a mean that is not the surface's.
void ColourPalette::judge_contrasts(Evidence& sum) const noexcept {
    if (sum.alone <= 0.0F) {
        return;
    }
    for (std::size_t k = 0; k < used_; ++k) {
        const float mean = sum.contrast[k] / sum.alone;
        const float unusual = mean - entries_[k].surface.contrast;
        const float differ = std::max(sum.square[k] - sum.alone * mean * mean, 0.0F);
        sum.cost[k] += colour_cost_weights::kContrast *
                           (differ + kUnusualContrast * sum.alone * unusual * unusual) -
                       kRare * entries_[k].commonness;
    }
}

bool ColourPalette::teaches(std::size_t surface, int sx, int sy) const noexcept {
    if (!is_alone(sx, sy)) {
        return costs_[surface].at(sx, sy) < kSureCost;
    }
    const Evidence& sum = smoothed_[static_cast<std::size_t>(sy * kSampleStepPx / kCellPx) *
                                        static_cast<std::size_t>(cells_.width()) +
                                    static_cast<std::size_t>(sx * kSampleStepPx / kCellPx)];
    const ColourModel::Light seen = entries_[surface].inverse * fine_at(sx, sy);
    const float off =
        possible(std::hypot(seen[1], seen[2]) / seen[0]) - sum.contrast[surface] / sum.alone;
    return colour_cost_weights::kContrast * off * off < kSureCost;
}

void ColourPalette::measure(const Entry& entry, const ColourSamples& samples, float moved_px,
                            int count, float* cost, float* fine_contrast) const noexcept {
    ColourCost row;
    row.inverse = entry.inverse;
    row.coarse_inverse = entry.coarse_inverse;
    row.contrast = entry.surface.contrast;
    row.transfer = entry.surface.transfer;
    row.fine = fine_;
    row.has_coarse = coarse_.has_value();
    row.coarse = coarse_.value_or(ColourPeriod{});
    row.coarse.phase_rad += static_cast<double>(kTurn) * static_cast<double>(moved_px) /
                            std::max(row.coarse.period_px, 1.0);
    row.samples = samples;
    row.count = count;
    row.cost = cost;
    row.fine_contrast = fine_contrast;
    colour_cost(row);
}

void ColourPalette::add_row(int y) noexcept {
    const int sy = y / kSampleStepPx;
    const ColourSamples samples = row_samples(sy);
    Evidence* cells = evidence_.data() + static_cast<std::size_t>(y / kCellPx) *
                                             static_cast<std::size_t>(cells_.width());
    float* moved_costs = moved_costs_.row(y / kCellPx);
    float* contrasts = contrasts_.row(y / kCellPx);
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
        Evidence& cell = cells[i * kSampleStepPx / kCellPx];
        cell.pixels += lit(i) ? 1.0F : 0.0F;
        cell.alone += lit(i) && is_alone(i, sy) ? 1.0F : 0.0F;
        cell.light += lit(i) ? samples.fine[0][i] + samples.fine[1][i] + samples.fine[2][i] : 0.0F;
    }
    for (std::size_t k = 0; k < used_; ++k) {
        float* costs = costs_[k].row(sy);
        measure(entries_[k], samples, 0.0F, samples_.width, costs, contrasts);
        if (moves) {
            measure(entries_[k], moved, moved_px_, samples_.width, moved_costs);
        }
        for (int i = 0; i < samples_.width; ++i) {
            if (!lit(i)) {
                continue;
            }
            Evidence& cell = cells[i * kSampleStepPx / kCellPx];
            if (is_alone(i, sy)) {
                const float contrast = possible(contrasts[i]);
                cell.contrast[k] += contrast;
                cell.square[k] += contrast * contrast;
                continue;
            }
            cell.cost[k] += costs[i];
            cell.moved[k] += moves ? moved_costs[i] : kMostColourCost;
        }
    }
}

// What the cells at and around (x, y) say together, those a step away for half.
ColourPalette::Evidence ColourPalette::around(const std::vector<Evidence>& cells, int x, int y,
                                              int step_x, int step_y) const noexcept {
    const Evidence& here = cells[index_of(x, y)];
    Evidence sum;
    for (int j = y - step_y; j <= y + step_y; j += std::max(step_y, 1)) {
        for (int i = x - step_x; i <= x + step_x; i += std::max(step_x, 1)) {
            if (j < 0 || j >= cells_.height() || i < 0 || i >= cells_.width()) {
                continue;
            }
            const Evidence& there = cells[index_of(i, j)];
            if (!coarse_ && !alike(here, there)) {
                continue;
            }
            const float weight = (i == x ? 2.0F : 1.0F) * (j == y ? 2.0F : 1.0F);
            sum.pixels += weight * there.pixels;
            sum.light += weight * there.light;
            sum.alone += weight * there.alone;
            for (std::size_t k = 0; k < used_; ++k) {
                sum.cost[k] += weight * there.cost[k];
                sum.moved[k] += weight * there.moved[k];
                sum.contrast[k] += weight * there.contrast[k];
                sum.square[k] += weight * there.square[k];
            }
        }
    }
    return sum;
}

// Of the cell and those around it, or along a finger, which can be as narrow as a cell, and what is
// beside it would outvote it.
ColourPalette::Evidence ColourPalette::around_or_along(int x, int y) const noexcept {
    const auto least = [&](const Evidence& of) {
        const auto end = of.cost.begin() + static_cast<std::ptrdiff_t>(used_);
        return of.pixels > 0.0F ? *std::min_element(of.cost.begin(), end) / of.pixels
                                : kMostColourCost;
    };
    Evidence sum = around(evidence_, x, y, 1, 1);
    if (least(sum) < kMixed) {
        return sum;
    }
    for (const Evidence& narrow : {around(evidence_, x, y, 0, 1), around(evidence_, x, y, 1, 0)}) {
        sum = least(narrow) < kNarrowShare * least(sum) ? narrow : sum;
    }
    return sum;
}

// A contrast says something over a whole fringe, which is wider than a few cells: without another
// period cells that are as bright are taken together from farther away.
void ColourPalette::gather() noexcept {
    const auto pass = [&](std::vector<Evidence>& to, const auto& of) {
        for (int y = 0; y < cells_.height(); ++y) {
            for (int x = 0; x < cells_.width(); ++x) {
                to[index_of(x, y)] = of(x, y);
            }
        }
    };
    if (coarse_) {
        pass(smoothed_, [&](int x, int y) { return around_or_along(x, y); });
        return;
    }
    pass(smoothed_, [&](int x, int y) { return around(evidence_, x, y, 1, 1); });
    constexpr int kFar = 3;  // cells; three that were taken together lie side by side
    pass(evidence_, [&](int x, int y) { return around(smoothed_, x, y, kFar, kFar); });
    smoothed_.swap(evidence_);
}

void ColourPalette::choose() noexcept {
    for (Entry& entry : entries_) {
        entry.commonness = std::log1p(static_cast<float>(entry.cells));
        entry.cells = 0;
    }
    gather();
    for (int y = 0; y < cells_.height(); ++y) {
        for (int x = 0; x < cells_.width(); ++x) {
            Evidence& sum = smoothed_[index_of(x, y)];
            judge_contrasts(sum);
            std::size_t best = 0;
            std::size_t moved = 0;
            for (std::size_t k = 1; k < used_; ++k) {
                best = sum.cost[k] < sum.cost[best] ? k : best;
                moved = sum.moved[k] < sum.moved[moved] ? k : moved;
            }
            const bool moves = coarse_ && sum.moved[moved] < kMovesShare * sum.cost[best];
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
        entries_[k].fit.forget(frames_ < kFirstFrames ? 0.0F : kKept);
    }
    for (int sy = 0; sy < samples_.height; ++sy) {
        for (int sx = 0; sx < samples_.width; ++sx) {
            const ColourModel::Light light = fine_at(sx, sy);
            const std::uint8_t value =
                cells_.at(sx * kSampleStepPx / kCellPx, sy * kSampleStepPx / kCellPx);
            const std::size_t surface = surface_of(value);
            // What moved agrees only about; it can wait until it rests.
            if (is_moved(value) || light.sum() < kLeastLight || is_unlit(sx, sy) ||
                !teaches(surface, sx, sy)) {
                continue;
            }
            Entry& entry = entries_[surface];
            const ColourModel::Light fine = entry.inverse * light;
            entry.fit.add(entry.surface, fine, 1.0F);
            if (coarse_) {
                const ColourModel::Light coarse = entry.coarse_inverse * coarse_at(sx, sy);
                const float ratio =
                    static_cast<float>(fine_.period_px) / static_cast<float>(coarse_->period_px);
                const float ahead = shares_apart(coordinate_px(coarse, *coarse_),
                                                 coordinate_px(fine, fine_), fine_);
                entry.fit.add_pair(entry.surface, fine, coarse, ratio, kTurn * ratio * ahead,
                                   kPairWeight);
            }
        }
    }
    const ColourSurface skin = model_.surface(kSkin, kSkinContrast);
    for (std::size_t k = 0; k < used_; ++k) {
        // Half a step: which cells are a surface's changes with what is believed of it.
        Entry& entry = entries_[k];
        const ColourSurface& now = entry.surface;
        const float from_skin =
            std::hypot(now.log_gain[0] - skin.log_gain[0], now.log_gain[1] - skin.log_gain[1]);
        const bool is_skin = from_skin < (now.transfer < 1.0F ? kStillLikeSkin : kLikeSkin);
        ColourSurface found =
            entry.fit.solve(now, kBelievedPixels + kDamping * entry.fit.pixels(), is_skin);
        if (!coarse_) {
            keep_near(entry.given, found.log_gain);
        }
        set(k, found);
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
