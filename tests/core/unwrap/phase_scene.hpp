// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <xtrack/image.hpp>

namespace xtrack::test {

/// Scenes for spatial unwrapping: a phase that is known, wrapped and noisy. The same seed gives the
/// same bits.
enum class PhaseSceneKind {
    bumps,   ///< one smooth surface
    hand,    ///< discs and capsules before a wall: steps of more than half a period all around
    slits,   ///< bumps with gaps of one to three pixels, some of which part the image
    bands,   ///< bumps with bands where the fringes are as weak as the noise
    salt,    ///< bumps; 3 % of the pixels have any phase, 3 % have none
    crack,   ///< a step that grows along a line from nothing to more than a period
    tilted,  ///< a slab before a wall, by half a period at one end and one and a half at the other
};

struct PhaseScene {
    Image<float> truth_rad;  ///< NaN where nothing is seen
    Image<float> phase_rad;  ///< wrapped, noisy
    Image<float> modulation;
};

namespace scene_detail {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kTurn = 2.0 * std::numbers::pi;

/// std::normal_distribution differs from library to library; this does not.
inline double normal(std::mt19937& random) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) {
        sum += static_cast<double>(random()) / 4294967296.0;
    }
    return sum;
}
inline double uniform(std::mt19937& random, double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
}

inline double distance_to_segment(double x, double y, double ax, double ay, double bx, double by) {
    const double dx = bx - ax, dy = by - ay;
    const double t = std::clamp(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    return std::hypot(x - ax - t * dx, y - ay - t * dy);
}

/// Of a 640 x 480 image: inside a palm or one of five fingers.
inline bool in_hand(double x, double y) {
    constexpr double kTips[5][2] = {{190, 240}, {235, 120}, {300, 90}, {365, 105}, {425, 160}};
    bool inside = std::hypot(x - 320, y - 300) < 85;
    for (const auto& tip : kTips) {
        inside = inside || distance_to_segment(x, y, 320, 300, tip[0], tip[1]) < 15;
    }
    return inside || distance_to_segment(x, y, 320, 300, 330, 600) < 50;
}

}  // namespace scene_detail

/// @param fringes over the width of the image
/// @param sigma camera noise, grey levels; three phase steps make sqrt(2/3) sigma / modulation rad
inline PhaseScene make_phase_scene(PhaseSceneKind kind, unsigned seed, Size size = {640, 480},
                                   double fringes = 32.0, double sigma = 8.0) {
    using namespace scene_detail;
    std::mt19937 random(seed);
    PhaseScene scene{
        {size.width, size.height}, {size.width, size.height}, {size.width, size.height}};
    const double sx = 640.0 / size.width, sy = 480.0 / size.height;
    struct Bump {
        double x, y, radius, height_rad;
    };
    std::vector<Bump> bumps;
    for (int i = 0; i < 6; ++i) {
        bumps.push_back({uniform(random, 0, 640), uniform(random, 0, 480), uniform(random, 50, 110),
                         uniform(random, -12, 12)});
    }
    const double shift = uniform(random, 0, kTurn);
    const double step = uniform(random, 3.7, 4.6);
    for (int iy = 0; iy < size.height; ++iy) {
        for (int ix = 0; ix < size.width; ++ix) {
            const double x = ix * sx, y = iy * sy;
            double phase = kTurn * fringes * x / 640.0 + 0.01 * y + shift;
            for (const Bump& bump : bumps) {
                const double r = std::hypot(x - bump.x, y - bump.y) / bump.radius;
                phase += bump.height_rad * std::exp(-r * r);
            }
            double modulation = 50.0 + 10.0 * std::sin(0.011 * x + 0.017 * y + shift);
            bool seen = true;
            bool any_phase = false;
            switch (kind) {
                case PhaseSceneKind::bumps: break;
                case PhaseSceneKind::hand:
                    if (in_hand(x, y)) {
                        phase += step + 0.002 * (y - 300.0) + 0.001 * (x - 320.0);
                    } else if (in_hand(x - 9.0, y)) {
                        seen = false;  // the hand's shadow
                    }
                    break;
                case PhaseSceneKind::slits:
                    seen = std::fabs(x - 210.0) > 1.0 && std::fabs(y - 0.4 * x - 120.0) > 1.0 &&
                           !(std::fabs(y - 300.0) < 1.5 && x > 330.0 && x < 620.0) &&
                           std::fabs(std::hypot(x - 470.0, y - 140.0) - 60.0) > 1.5;
                    break;
                case PhaseSceneKind::bands:
                    modulation =
                        std::fabs(y - 160.0) < 8.0 || std::fabs(x - 420.0) < 8.0 ? 7.0 : modulation;
                    break;
                case PhaseSceneKind::salt: {
                    const double dice = uniform(random, 0, 1);
                    seen = dice > 0.03;
                    any_phase = dice > 0.97;
                    break;
                }
                case PhaseSceneKind::crack:
                    if (x > 200.0 && y > 240.0) {
                        phase += 0.02 * (x - 200.0);
                    }
                    break;
                case PhaseSceneKind::tilted:
                    if (x > 150.0 && x < 500.0 && y > 110.0 && y < 370.0) {
                        phase += 3.5 + 0.018 * (x - 150.0);
                    }
                    break;
            }
            const double noise = std::sqrt(2.0 / 3.0) * sigma / modulation * normal(random);
            const double measured = any_phase ? uniform(random, 0, kTurn) : phase + noise;
            scene.truth_rad.at(ix, iy) = seen ? static_cast<float>(phase) : kNone;
            scene.phase_rad.at(ix, iy) =
                seen ? static_cast<float>(std::remainder(measured, kTurn)) : kNone;
            scene.modulation.at(ix, iy) = seen ? static_cast<float>(modulation) : 0.0F;
        }
    }
    return scene;
}

struct UnwrapScore {
    double right = 0.0;    ///< share of the seen pixels with their component's most frequent order
    double missing = 0.0;  ///< share of the seen pixels that are in no component
    double largest = 0.0;  ///< share of the seen pixels in the largest component
};

inline UnwrapScore score(const PhaseScene& scene, ImageView<const float> unwrapped_rad,
                         ImageView<const std::uint16_t> component) {
    std::map<std::uint16_t, std::map<long, int>> orders;
    int seen = 0, missing = 0;
    for (int y = 0; y < scene.truth_rad.height(); ++y) {
        for (int x = 0; x < scene.truth_rad.width(); ++x) {
            const float truth = scene.truth_rad.at(x, y);
            if (std::isnan(truth)) {
                continue;
            }
            ++seen;
            if (component.at(x, y) == 0) {
                ++missing;
                continue;
            }
            const double turns = (unwrapped_rad.at(x, y) - truth) / scene_detail::kTurn;
            ++orders[component.at(x, y)][std::lround(turns)];
        }
    }
    int right = 0, largest = 0;
    for (const auto& [id, counts] : orders) {
        int best = 0, all = 0;
        for (const auto& [order, count] : counts) {
            best = std::max(best, count);
            all += count;
        }
        right += best;
        largest = std::max(largest, all);
    }
    const double total = seen;
    return {right / total, missing / total, largest / total};
}

}  // namespace xtrack::test
