// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "gestures/segment/chamfer.hpp"

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

}  // namespace

void Parts::create(const Grid& grid) {
    const std::size_t n = grid.size();
    label_.assign(n, 0);
    parent_.assign(n + 1, 0);
    area_.assign(n + 1, 0.0F);
    distance_.assign(n, 0);
    ball_.assign(n, 0);
    part_of_.assign(n, -1);
    pixels_.assign(n, 0);
    parts_.reserve(kPartsMax);
    bodies_.reserve(kPartsMax);
}

void Parts::find(const Grid& grid, std::span<const float> foreground, float thick_mm,
                 float area_min_mm2) {
    label_surfaces(grid, foreground);
    // Crumbs are no surface at all: they neither bound nor carry a limb.
    for (std::size_t i = 0; i < label_.size(); ++i) {
        if (label_[i] != 0) {
            const int root = root_of(label_[i]);
            label_[i] = area_[static_cast<std::size_t>(root)] >= area_min_mm2 ? root : 0;
        }
    }
    measure_distance(grid);
    mark_body(grid, thick_mm);
    collect(grid, area_min_mm2);
}

int Parts::root_of(int label) noexcept {
    while (parent_[static_cast<std::size_t>(label)] != label) {
        const int up = parent_[static_cast<std::size_t>(label)];
        parent_[static_cast<std::size_t>(label)] = parent_[static_cast<std::size_t>(up)];
        label = up;
    }
    return label;
}

void Parts::label_surfaces(const Grid& grid, std::span<const float> foreground) {
    int labels = 0;
    const int w = grid.width;
    const auto join = [&](int a, int b) {
        a = root_of(a);
        b = root_of(b);
        if (a != b) {
            const int low = std::min(a, b);
            const int high = std::max(a, b);
            parent_[static_cast<std::size_t>(high)] = low;
            area_[static_cast<std::size_t>(low)] += area_[static_cast<std::size_t>(high)];
        }
        return std::min(a, b);
    };
    const float area_scale = grid.inverse_focal * grid.inverse_focal;
    for (int y = 0; y < grid.inner_height; ++y) {
        const int begin = grid.index(0, y);
        for (int i = begin; i < begin + grid.inner_width; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const float v = foreground[k];
            if (v <= 0.0F) {
                label_[k] = 0;
                continue;
            }
            const float limit = grid.step_limit_mm(v);
            int label = 0;
            for (const int n : {i - 1, i - w, i - w - 1, i - w + 1}) {
                const auto m = static_cast<std::size_t>(n);
                if (label_[m] != 0 && std::abs(foreground[m] - v) < limit) {
                    label = label == 0 ? root_of(label_[m]) : join(label, label_[m]);
                }
            }
            if (label == 0) {
                label = ++labels;
                parent_[static_cast<std::size_t>(label)] = label;
                area_[static_cast<std::size_t>(label)] = 0.0F;
            }
            label_[k] = label;
            area_[static_cast<std::size_t>(label)] += v * v * area_scale;
        }
    }
}

void Parts::measure_distance(const Grid& grid) {
    const int w = grid.width;
    std::fill(distance_.begin(), distance_.end(),
              kChamferFar);  // padding: a border ends no surface
    for (int y = 0; y < grid.inner_height; ++y) {
        const int begin = grid.index(0, y);
        const bool top = y == 0;
        const bool bottom = y == grid.inner_height - 1;
        for (int x = 0; x < grid.inner_width; ++x) {
            const auto k = static_cast<std::size_t>(begin + x);
            const int label = label_[k];
            if (label == 0) {
                distance_[k] = 0;
                continue;
            }
            const auto other = [&](std::size_t m) { return label_[m] != label && label_[m] != 0; };
            const bool rim = (x > 0 && other(k - 1)) ||
                             (x + 1 < grid.inner_width && other(k + 1)) ||
                             (!top && other(k - static_cast<std::size_t>(w))) ||
                             (!bottom && other(k + static_cast<std::size_t>(w)));
            distance_[k] = rim ? kChamferUnit : kChamferFar;
        }
    }
    spread_distance(grid, {0, 0, grid.inner_width, grid.inner_height}, distance_);
}

void Parts::mark_body(const Grid& grid, float thick_mm) {
    std::fill(ball_.begin(), ball_.end(), -1);
    bool any = false;
    for (int y = 0; y < grid.inner_height; ++y) {
        const int begin = grid.index(0, y);
        for (int i = begin; i < begin + grid.inner_width; ++i) {
            const auto k = static_cast<std::size_t>(i);
            if (label_[k] != 0 && radius_mm(grid, i) > thick_mm) {
                const float margin = kBallMarginMm / grid.pitch_mm(grid.z[k]);
                ball_[k] = std::min(distance_[k], kChamferFar / 2) +
                           static_cast<std::int32_t>(margin * static_cast<float>(kChamferUnit));
                any = true;
            }
        }
    }
    if (!any) {
        return;
    }
    spread_balls(grid, {0, 0, grid.inner_width, grid.inner_height}, label_, ball_);
}

void Parts::collect(const Grid& grid, float area_min_mm2) {
    parts_.clear();
    bodies_.clear();
    std::fill(part_of_.begin(), part_of_.end(), std::int16_t{-1});
    constexpr std::int16_t kBodyMark = -2;
    const int w = grid.width;
    const std::array<int, 8> around = {-w - 1, -w, -w + 1, -1, 1, w - 1, w, w + 1};
    int used = 0;

    // Flood from a seed over pixels of the same surface and kind; their range in pixels_.
    const auto flood = [&](int seed, bool body, std::int16_t mark) {
        const int begin = used;
        pixels_[static_cast<std::size_t>(used++)] = seed;
        part_of_[static_cast<std::size_t>(seed)] = mark;
        for (int next = begin; next < used; ++next) {
            const int i = pixels_[static_cast<std::size_t>(next)];
            for (const int o : around) {
                const auto m = static_cast<std::size_t>(i + o);
                if (label_[m] == label_[static_cast<std::size_t>(i)] && part_of_[m] == -1 &&
                    (ball_[m] > 0) == body) {
                    part_of_[m] = mark;
                    pixels_[static_cast<std::size_t>(used++)] = i + o;
                }
            }
        }
        return begin;
    };

    for (int y = 0; y < grid.inner_height; ++y) {
        const int row = grid.index(0, y);
        for (int i = row; i < row + grid.inner_width; ++i) {
            const auto k = static_cast<std::size_t>(i);
            if (label_[k] == 0 || part_of_[k] != -1) {
                continue;
            }
            const bool body = ball_[k] > 0;
            const auto mark = body ? kBodyMark : static_cast<std::int16_t>(parts_.size());
            const bool full = !body && parts_.size() >= static_cast<std::size_t>(kPartsMax);
            const int begin = flood(i, body, full ? std::int16_t{-3} : mark);
            Part part;
            part.begin = begin;
            part.end = used;
            part.body = label_[k];
            double depth = 0.0;
            double depth_squares = 0.0;
            Vec3f root = Vec3f::Zero();
            for (int p = begin; p < used; ++p) {
                const int q = pixels_[static_cast<std::size_t>(p)];
                const float v = grid.z[static_cast<std::size_t>(q)];
                const float pitch = grid.pitch_mm(v);
                part.area_mm2 += pitch * pitch;
                depth += v;
                depth_squares += static_cast<double>(v) * v;
                if (body) {
                    continue;
                }
                part.thickest_mm = std::max(part.thickest_mm, radius_mm(grid, q));
                const int x = grid.x_of(q);
                const int yy = grid.y_of(q);
                part.touches_border |=
                    x == 0 || yy == 0 || x == grid.inner_width - 1 || yy == grid.inner_height - 1;
                for (const int o : around) {
                    const auto m = static_cast<std::size_t>(q + o);
                    if (label_[m] == part.body && ball_[m] > 0) {
                        root += grid.point(q);
                        ++part.root_pixels;
                        break;
                    }
                }
            }
            if (body) {
                if (part.area_mm2 >= kBodyCoreMinMm2 &&
                    bodies_.size() < static_cast<std::size_t>(kPartsMax)) {
                    const double n = part.end - part.begin;
                    const double mean = depth / n;
                    const double sigma = std::sqrt(std::max(0.0, depth_squares / n - mean * mean));
                    bodies_.push_back(
                        {part.body, part.area_mm2, static_cast<float>(mean),
                         static_cast<float>(mean - std::min(kFrontSigma * sigma, kFrontMaxMm))});
                }
                used = begin;
            } else if (full || part.area_mm2 < area_min_mm2) {
                for (int p = begin; p < used; ++p) {
                    part_of_[static_cast<std::size_t>(pixels_[static_cast<std::size_t>(p)])] = -3;
                }
                used = begin;
            } else {
                if (part.root_pixels > 0) {
                    part.root_mm = root / static_cast<float>(part.root_pixels);
                }
                parts_.push_back(part);
            }
        }
    }
}

}  // namespace xtrack::segment
