// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <queue>
#include <vector>

#include <xtrack/image.hpp>

namespace xtrack::test {

/// Quality-guided unwrapping as the books have it: a heap of the pixels on the rim, the best first.
/// Quality is modulation over the second differences around the pixel. Slow and plain.
/// @return the number of components, which are as the step limit parts them, none is dropped
inline int unwrap_by_heap(ImageView<const float> phase_rad, ImageView<const float> modulation,
                          float step_limit_rad, ImageView<float> unwrapped_rad,
                          ImageView<std::uint16_t> component) {
    constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
    const int width = phase_rad.width, height = phase_rad.height;
    const auto step = [&](int x, int y, int dx, int dy) {
        const bool inside = x + dx >= 0 && x + dx < width && y + dy >= 0 && y + dy < height;
        return inside ? std::remainder(phase_rad.at(x + dx, y + dy) - phase_rad.at(x, y), kTurn)
                      : std::nanf("");
    };
    struct Rim {
        float quality;
        int x, y;
        float unwrapped_rad;
        bool operator<(const Rim& other) const { return quality < other.quality; }
    };
    std::vector<Rim> seeds;
    std::vector<float> quality(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto quality_at = [&](int x, int y) -> float& {
        return quality[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                       static_cast<std::size_t>(x)];
    };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            unwrapped_rad.at(x, y) = std::nanf("");
            component.at(x, y) = 0;
            const float bend_x = step(x, y, 1, 0) + step(x, y, -1, 0);
            const float bend_y = step(x, y, 0, 1) + step(x, y, 0, -1);
            const float bend = std::sqrt(bend_x * bend_x + bend_y * bend_y);
            quality_at(x, y) = std::isnan(bend) ? 0.0F : modulation.at(x, y) / (0.05F + bend);
            if (std::isfinite(phase_rad.at(x, y))) {
                seeds.push_back({quality_at(x, y), x, y, phase_rad.at(x, y)});
            }
        }
    }
    std::priority_queue<Rim> starts(seeds.begin(), seeds.end());
    int components = 0;
    std::priority_queue<Rim> rim;
    for (; !starts.empty(); starts.pop()) {
        if (component.at(starts.top().x, starts.top().y) != 0) {
            continue;
        }
        components = std::min(components + 1, 65535);
        rim.push(starts.top());
        while (!rim.empty()) {
            const Rim here = rim.top();
            rim.pop();
            if (component.at(here.x, here.y) != 0) {
                continue;
            }
            component.at(here.x, here.y) = static_cast<std::uint16_t>(components);
            unwrapped_rad.at(here.x, here.y) = here.unwrapped_rad;
            for (const auto& [dx, dy] :
                 {std::array{1, 0}, std::array{-1, 0}, std::array{0, 1}, std::array{0, -1}}) {
                const float next = step(here.x, here.y, dx, dy);
                if (std::fabs(next) <= step_limit_rad &&
                    component.at(here.x + dx, here.y + dy) == 0) {
                    rim.push({quality_at(here.x + dx, here.y + dy), here.x + dx, here.y + dy,
                              here.unwrapped_rad + next});
                }
            }
        }
    }
    return components;
}

}  // namespace xtrack::test
