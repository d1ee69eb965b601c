// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace xtrack::segment {

namespace {

/// The balls of the thick core are grown by this, so that no rim of the body is left over, mm.
constexpr float kBallMarginMm = 12.0F;
/// A core smaller than this is not a body, mm2: a thick spot of a hand with its sleeve.
constexpr float kBodyCoreMinMm2 = 400.0F;

/// A body's front is the nearest tenth of a normal distribution of its depths; a slanted wall has
/// no front, so the difference is limited, mm.
constexpr double kFrontSigma = 1.3;
constexpr double kFrontMaxMm = 60.0;
/// A hand before its own body is one surface with it, by way of the arm; a step of this much ends
/// it all the same, mm. Fingers before their palm make smaller ones.
constexpr float kOcclusionMm = 60.0F;
/// A middle line falls toward a finger's tip by this a pixel at most; an outline's slope is
/// kChamferUnit.
constexpr int kRidgeSlope = 3;
/// Surfaces are counted in 16 bits.
constexpr int kLabelsMax = 65535;

std::array<int, 8> neighbours(int w) { return {-w - 1, -w, -w + 1, -1, 1, w - 1, w, w + 1}; }

}  // namespace

void Parts::create(const Grid& grid) {
    const std::size_t n = grid.size();
    components_.create(grid);
    pieces_.reserve(n);
    has_core_.reserve(n + 1);
    label_.assign(n, 0);
    nearness_.assign(n, 0);
    ridge_.assign(n, 0);
    ball_.assign(n, 0);
    part_of_.assign(n, kNone);
    pixels_.reserve(n);
    parts_.reserve(kPartsMax);
    bodies_.reserve(kPartsMax);
}

void Parts::find(const Grid& grid, std::span<const float> foreground, float thick_mm,
                 float area_min_mm2) {
    label_surfaces(grid, foreground, area_min_mm2);
    measure_distance(grid);
    mark_ridges(grid);
    mark_body(grid, thick_mm);
    collect(grid, area_min_mm2);
}

void Parts::label_surfaces(const Grid& grid, std::span<const float> foreground,
                           float area_min_mm2) {
    const float* const z = foreground.data();
    // What is no depth is 0, which is a step away from everything.
    components_.find_in(grid, grid.whole(), foreground, [&](int a, int b) {
        return std::abs(z[a] - z[b]) < grid.step_limit_mm(std::min(z[a], z[b])) && z[b] > 0.0F;
    });
    pieces_.assign(static_cast<std::size_t>(components_.count()), {});
    for (const Components::Run& run : components_.runs()) {
        Piece& piece = pieces_[static_cast<std::size_t>(run.component)];
        piece.area_mm2 += grid.area_mm2(run.begin, run.end);
        piece.pixels += run.end - run.begin;
    }
    // Crumbs are no surface at all: they neither bound nor carry a limb.
    int labels = 0;
    for (Piece& piece : pieces_) {
        const bool counts = piece.area_mm2 >= area_min_mm2 && labels < kLabelsMax;
        piece.number = counts ? ++labels : 0;
    }
    has_core_.assign(static_cast<std::size_t>(labels) + 1, 0);
    std::fill(label_.begin(), label_.end(), std::uint16_t{0});
    box_ = {grid.inner_width, grid.inner_height, 0, 0};
    for (const Components::Run& run : components_.runs()) {
        const int number = pieces_[static_cast<std::size_t>(run.component)].number;
        if (number == 0) {
            continue;
        }
        std::fill(label_.begin() + run.begin, label_.begin() + run.end,
                  static_cast<std::uint16_t>(number));
        const int y = grid.y_of(run.begin);
        const int x = run.begin - grid.index(0, y);
        box_ = {std::min(box_.x_begin, x), std::min(box_.y_begin, y),
                std::max(box_.x_end, x + run.end - run.begin), std::max(box_.y_end, y + 1)};
    }
    repeat_border(grid);
}

/// Beyond the border of the image a surface goes on.
void Parts::repeat_border(const Grid& grid) {
    const auto w = static_cast<std::ptrdiff_t>(grid.width);
    for (int y = 0; y < grid.inner_height; ++y) {
        const auto row = label_.begin() + static_cast<std::ptrdiff_t>(y + kPad) * w;
        std::fill(row, row + kPad, row[kPad]);
        std::fill(row + w - kPad, row + w, row[w - kPad - 1]);
    }
    for (std::ptrdiff_t k = 0; k < kPad; ++k) {
        const auto first = label_.begin() + kPad * w;
        std::copy(first, first + w, label_.begin() + k * w);
        const auto last = label_.end() - (kPad + 1) * w;
        std::copy(last, last + w, label_.end() - (k + 1) * w);
    }
}

void Parts::measure_distance(const Grid& grid) {
    constexpr auto kRim = static_cast<std::uint16_t>(kNearnessMax - kChamferUnit);
    const std::ptrdiff_t w = grid.width;
    for (int y = 0; y < grid.inner_height; ++y) {
        const int begin = grid.index(0, y);
        const std::uint16_t* const label = label_.data() + begin;
        const float* const z = grid.z.data() + begin;
        std::uint16_t* const out = nearness_.data() + begin;
        for (int x = 0; x < grid.inner_width; ++x) {
            const std::uint16_t own = label[x];
            const auto ends = [&](std::ptrdiff_t o) {
                const float step = std::abs(z[x + o] - z[x]);
                return (label[x + o] != own) | ((step > kOcclusionMm) & (z[x + o] > 0.0F));
            };
            const bool rim = ends(-1) | ends(1) | ends(-w) | ends(w);
            const std::uint16_t inside = rim ? kRim : std::uint16_t{0};
            out[x] = own == 0 ? kNearnessMax : inside;
        }
    }
    spread(grid, box_, nearness_);
}

void Parts::mark_ridges(const Grid& grid) {
    const std::ptrdiff_t w = grid.width;
    for (int y = box_.y_begin; y < box_.y_end; ++y) {
        const int begin = grid.index(box_.x_begin, y);
        const std::uint16_t* const n = nearness_.data() + begin;
        std::uint16_t* const out = ridge_.data() + begin;
        for (int x = 0; x < box_.width(); ++x) {
            const auto least = [&](std::ptrdiff_t row) {
                const std::uint16_t* const r = n + x + row;
                return std::min(std::min(r[-1], r[0]), r[1]);
            };
            const std::uint16_t deepest = std::min(std::min(least(-w), least(0)), least(w));
            out[x] = n[x] - deepest <= kRidgeSlope ? std::uint16_t{1} : std::uint16_t{0};
        }
    }
}

void Parts::mark_body(const Grid& grid, float thick_mm) {
    if (any_core_) {  // in the image before
        std::fill(ball_.begin(), ball_.end(), std::uint16_t{0});
    }
    any_core_ = false;
    // A core's ball reaches its rim, and a little beyond.
    const float margin = kBallMarginMm * kChamferUnit / grid.inverse_focal;
    for (const Components::Run& run : components_.runs()) {
        if (label_[static_cast<std::size_t>(run.begin)] == 0) {
            continue;
        }
        for (int i = run.begin; i < run.end; ++i) {
            const auto k = static_cast<std::size_t>(i);
            if (radius_mm(grid, i) > thick_mm) {
                const int reach =
                    kNearnessMax - nearness_[k] + static_cast<int>(margin / grid.z[k]);
                ball_[k] = static_cast<std::uint16_t>(std::min<int>(reach, kNearnessMax));
                has_core_[label_[k]] = 1;
                any_core_ = true;
            }
        }
    }
    if (any_core_) {
        spread(grid, box_, ball_, label_);
    }
}

void Parts::collect(const Grid& grid, float area_min_mm2) {
    // Where nothing is thick, surfaces are the pieces, and known.
    if (any_core_) {
        const auto same_kind = [&](int a, int b) {
            const auto k = static_cast<std::size_t>(a);
            const auto m = static_cast<std::size_t>(b);
            return label_[k] == label_[m] && (ball_[k] > 0) == (ball_[m] > 0);
        };
        components_.find_in(grid, box_, std::span<const std::uint16_t>(label_), same_kind);
        pieces_.assign(static_cast<std::size_t>(components_.count()), {});
        for (const Components::Run& run : components_.runs()) {
            Piece& piece = pieces_[static_cast<std::size_t>(run.component)];
            piece.area_mm2 += grid.area_mm2(run.begin, run.end);
            piece.pixels += run.end - run.begin;
        }
    }

    parts_.clear();
    bodies_.clear();
    int room = 0;
    int known = 0;
    for (const Components::Run& run : components_.runs()) {
        if (run.component < known) {
            continue;
        }
        ++known;  // the first run of its component
        Piece& piece = pieces_[static_cast<std::size_t>(run.component)];
        const auto first = static_cast<std::size_t>(run.begin);
        piece.number = label_[first] == 0 ? kNone : kOther;
        if (label_[first] == 0) {
            continue;
        }
        if (ball_[first] > 0) {
            if (piece.area_mm2 >= kBodyCoreMinMm2 && bodies_.size() < std::size_t{kPartsMax}) {
                bodies_.push_back({label_[first], piece.area_mm2, 0.0F, 0.0F});
                measure_body(grid, run.component);
            }
        } else if (piece.area_mm2 >= area_min_mm2 && parts_.size() < std::size_t{kPartsMax}) {
            piece.number = static_cast<int>(parts_.size());
            Part part;
            part.begin = part.end = room;
            part.area_mm2 = piece.area_mm2;
            part.body = label_[first];
            parts_.push_back(part);
            room += piece.pixels;
        }
    }
    std::fill(part_of_.begin(), part_of_.end(), std::int8_t{kNone});
    pixels_.resize(static_cast<std::size_t>(room));
    for (const Components::Run& run : components_.runs()) {
        const int number = pieces_[static_cast<std::size_t>(run.component)].number;
        std::fill(part_of_.begin() + run.begin, part_of_.begin() + run.end,
                  static_cast<std::int8_t>(number));
        if (number >= 0) {
            Part& part = parts_[static_cast<std::size_t>(number)];
            const int y = grid.y_of(run.begin);
            part.touches_border |= y == 0 || y == grid.inner_height - 1 ||
                                   run.begin == grid.index(0, y) ||
                                   run.end == grid.index(grid.inner_width, y);
            for (int i = run.begin; i < run.end; ++i) {
                pixels_[static_cast<std::size_t>(part.end++)] = i;
            }
        }
    }
    for (Part& part : parts_) {
        measure(grid, part);
    }
}

void Parts::measure_body(const Grid& grid, int component) {
    double sum = 0.0;
    double squares = 0.0;
    double n = 0.0;
    for (const Components::Run& run : components_.runs()) {
        if (run.component != component) {
            continue;
        }
        // A few pixels tell as much of a body as all do.
        constexpr int kStep = 4;
        for (int i = run.begin; i < run.end; i += kStep) {
            const double z = grid.z[static_cast<std::size_t>(i)];
            sum += z;
            squares += z * z;
            n += 1.0;
        }
    }
    const double mean = sum / n;
    const double sigma = std::sqrt(std::max(0.0, squares / n - mean * mean));
    Body& body = bodies_.back();
    body.depth_mm = static_cast<float>(mean);
    body.front_mm = static_cast<float>(mean - std::min(kFrontSigma * sigma, kFrontMaxMm));
}

void Parts::measure(const Grid& grid, Part& part) {
    const auto around = neighbours(grid.width);
    const bool grows = has_core_[static_cast<std::size_t>(part.body)] != 0;
    Vec3f root = Vec3f::Zero();
    for (const int i : pixels(part)) {
        part.thickest_mm = std::max(part.thickest_mm, radius_mm(grid, i));
        if (!grows) {
            continue;
        }
        for (const int o : around) {
            const auto m = static_cast<std::size_t>(i + o);
            if (label_[m] == part.body && ball_[m] > 0) {
                root += grid.point(i);
                ++part.root_pixels;
                break;
            }
        }
    }
    if (part.root_pixels > 0) {
        part.root_mm = root / static_cast<float>(part.root_pixels);
    }
}

}  // namespace xtrack::segment
