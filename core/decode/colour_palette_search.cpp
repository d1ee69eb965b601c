// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/decode/colour_palette.hpp"

namespace xtrack {
namespace {

// Votes for gains, over E.
constexpr float kVoteRange = 0.4F;
constexpr float kMisfitScale = 0.02F;  // of logarithms of light, squared
constexpr float kVoteFade = 0.9F;
constexpr float kLeastVotes = 3.0F;
constexpr float kLeastShare = 0.025F;
constexpr float kSameGain = 0.07F;  // nearer in E: one surface
constexpr float kTwinGain = 0.02F;  // what two surfaces have become one at
constexpr int kSearchesAtFirst = 20000;
constexpr int kSearches = 128;

float distance(const ColourSurface& a, const ColourSurface& b) noexcept {
    return std::hypot(a.log_gain[0] - b.log_gain[0], a.log_gain[1] - b.log_gain[1]);
}

}  // namespace

void ColourPalette::vote(const ColourHypothesis& hypothesis, float weight) noexcept {
    const auto cell = [](float e) {
        return static_cast<int>(std::floor((e + kVoteRange) / (2.0F * kVoteRange) * kVoteCells));
    };
    const int x = cell(hypothesis.surface.log_gain[0]);
    const int y = cell(hypothesis.surface.log_gain[1]);
    if (x < 0 || y < 0 || x >= kVoteCells || y >= kVoteCells) {
        return;
    }
    votes_.at(x, y) += weight;
    vote_contrast_.at(x, y) += weight * hypothesis.surface.contrast;
}

void ColourPalette::search() noexcept {
    for (int y = 0; y < kVoteCells; ++y) {
        for (int x = 0; x < kVoteCells; ++x) {
            votes_.at(x, y) *= kVoteFade;
            vote_contrast_.at(x, y) *= kVoteFade;
        }
    }
    // At first one sample a cell; then a few cells a frame, in an order that is spread over the
    // image, and rather those that no surface explains.
    const std::size_t cells = evidence_.size();
    const int budget = frames_ == 0 ? kSearchesAtFirst : kSearches;
    int done = 0;
    for (std::size_t tried = 0; tried < cells && done < budget; ++tried) {
        constexpr std::size_t kStride = 1013;  // prime, so that every cell has its turn
        next_search_ = (next_search_ + kStride) % cells;
        const auto cx = static_cast<int>(next_search_ % static_cast<std::size_t>(cells_.width()));
        const auto cy = static_cast<int>(next_search_ / static_cast<std::size_t>(cells_.width()));
        const Evidence& evidence = smoothed_[next_search_];
        constexpr float kExplained = 0.08F;
        const std::uint8_t value = cells_.at(cx, cy);
        const float least =
            is_moved(value) ? evidence.moved[surface_of(value)] : evidence.cost[surface_of(value)];
        if (frames_ > 0 && least < kExplained * evidence.pixels) {
            continue;
        }
        const int sx = std::min(cx * kCellPx / kSampleStepPx + 1, samples_.width - 1);
        const int sy = std::min(cy * kCellPx / kSampleStepPx + 1, samples_.height - 1);
        if (is_unlit(sx, sy)) {
            continue;
        }
        ++done;
        ColourSearch::Hypotheses hypotheses;
        const std::size_t found =
            search_.find(coarse_at(sx, sy), fine_at(sx, sy), first_px_.at(sx, sy),
                         last_px_.at(sx, sy), hypotheses);
        std::array<float, ColourSearch::kMostHypotheses> likelihood{};
        float sum = 0.05F;  // that none of them is right
        for (std::size_t n = 0; n < found; ++n) {
            likelihood[n] = std::exp(-hypotheses[n].misfit / kMisfitScale);
            sum += likelihood[n];
        }
        for (std::size_t n = 0; n < found; ++n) {
            // Low contrast is explained by much: it says little.
            const float contrast = hypotheses[n].surface.contrast;
            vote(hypotheses[n], contrast * contrast * likelihood[n] / sum);
        }
    }
}

void ColourPalette::found_surfaces() noexcept {
    constexpr int kBlur = 2;
    constexpr std::array<float, 2 * kBlur + 1> kKernel{1.0F, 3.0F, 4.0F, 3.0F, 1.0F};
    float total = 0.0F;
    for (int y = 0; y < kVoteCells; ++y) {
        for (int x = 0; x < kVoteCells; ++x) {
            float sum = 0.0F;
            for (int j = -kBlur; j <= kBlur; ++j) {
                for (int i = -kBlur; i <= kBlur; ++i) {
                    const int u = std::clamp(x + i, 0, kVoteCells - 1);
                    const int v = std::clamp(y + j, 0, kVoteCells - 1);
                    sum += kKernel[static_cast<std::size_t>(i + kBlur)] *
                           kKernel[static_cast<std::size_t>(j + kBlur)] * votes_.at(u, v);
                }
            }
            blurred_.at(x, y) = sum / 16.0F;
            total += votes_.at(x, y);
        }
    }
    constexpr float kCell = 2.0F * kVoteRange / kVoteCells;
    for (std::size_t n = 0; n < kMostSurfaces; ++n) {
        float most = 0.0F;
        ColourSurface surface;
        for (int y = kBlur; y < kVoteCells - kBlur; ++y) {
            for (int x = kBlur; x < kVoteCells - kBlur; ++x) {
                if (blurred_.at(x, y) <= most) {
                    continue;
                }
                ColourSurface here;
                here.log_gain = {(static_cast<float>(x) + 0.5F) * kCell - kVoteRange,
                                 (static_cast<float>(y) + 0.5F) * kCell - kVoteRange};
                bool known = false;
                for (std::size_t k = 0; k < used_; ++k) {
                    known = known || distance(entries_[k].surface, here) < kSameGain;
                }
                if (known) {
                    continue;
                }
                most = blurred_.at(x, y);
                float weight = 1e-6F;
                float contrast = 0.0F;
                for (int j = -kBlur; j <= kBlur; ++j) {
                    for (int i = -kBlur; i <= kBlur; ++i) {
                        weight += votes_.at(x + i, y + j);
                        contrast += vote_contrast_.at(x + i, y + j);
                    }
                }
                here.contrast = contrast / weight;
                surface = here;
            }
        }
        if (most < std::max(kLeastVotes, kLeastShare * total)) {
            return;
        }
        std::size_t at = used_;
        if (used_ < kMostSurfaces) {
            ++used_;
        } else {
            // The least of those that were found before, if it is next to nothing.
            at = kGiven;
            for (std::size_t k = kGiven; k < used_; ++k) {
                at = entries_[k].cells < entries_[at].cells ? k : at;
            }
            constexpr int kFewCells = 8;
            if (entries_[at].cells >= kFewCells) {
                return;
            }
        }
        set(at, surface);
        entries_[at].fit.clear();
        entries_[at].cells = std::numeric_limits<int>::max();  // not at once given away again
    }
}

void ColourPalette::drop_twins() noexcept {
    for (std::size_t k = kGiven; k < used_;) {
        bool twin = false;
        for (std::size_t n = 0; n < k; ++n) {
            twin = twin || distance(entries_[k].surface, entries_[n].surface) < kTwinGain;
        }
        if (twin) {
            --used_;
            std::swap(entries_[k], entries_[used_]);
        } else {
            ++k;
        }
    }
}

}  // namespace xtrack
