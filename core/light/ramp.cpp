// SPDX-License-Identifier: Apache-2.0
#include "core/light/ramp.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace xtrack {
namespace {

constexpr double kFullValue = 255.0;
// A fall of less is noise or flicker, share of full light: an 8-bit projector's steps are 0.004.
constexpr double kFallOfNoise = 0.01;
// How much further than the median a pixel may stray: three sigma of a normal distribution.
constexpr double kStray = 4.5;

std::string percent(double share) { return std::to_string(std::lround(100.0 * share)) + " %"; }

}  // namespace

Ramp Ramp::of(const PatternSequence& sequence) {
    Ramp ramp;
    for (std::size_t i = 0; i < sequence.patterns.size(); ++i) {
        const Pattern& pattern = sequence.patterns[i];
        if (pattern.kind == PatternKind::flat) {
            ramp.steps.push_back(
                {static_cast<int>(i), std::round(pattern.level * kFullValue) / kFullValue});
        }
    }
    std::stable_sort(ramp.steps.begin(), ramp.steps.end(),
                     [](const Step& a, const Step& b) { return a.value < b.value; });
    const auto same = [](const Step& a, const Step& b) { return a.value == b.value; };
    ramp.steps.erase(std::unique(ramp.steps.begin(), ramp.steps.end(), same), ramp.steps.end());
    return ramp;
}

std::vector<double> ramp_shares(const LightSamples& samples, const Ramp& ramp, std::size_t channel,
                                std::span<const std::size_t> pixels) {
    std::vector<double> shares(ramp.steps.size(), 0.0);
    for (std::size_t k = 0; k < shares.size(); ++k) {
        for (const std::size_t i : pixels) {
            shares[k] += samples.level(ramp.steps[k].pattern, channel, i) -
                         samples.level(ramp.black(), channel, i);
        }
    }
    const double full = shares.back();
    for (double& share : shares) {
        share /= full;
    }
    return shares;
}

std::vector<std::size_t> steady_pixels(const LightSamples& samples, const Ramp& ramp,
                                       std::span<const double> shares,
                                       std::span<const std::size_t> pixels, double& spread) {
    std::vector<double> strays;
    strays.reserve(pixels.size());
    for (const std::size_t i : pixels) {
        const double black = samples.level(ramp.black(), LightSamples::kLuma, i);
        const double range = samples.level(ramp.white(), LightSamples::kLuma, i) - black;
        double squares = 0.0;
        for (std::size_t k = 0; k < shares.size(); ++k) {
            const double level = samples.level(ramp.steps[k].pattern, LightSamples::kLuma, i);
            const double stray = (level - black) / range - shares[k];
            squares += stray * stray;
        }
        strays.push_back(std::sqrt(squares / static_cast<double>(shares.size())));
    }
    std::vector<double> sorted = strays;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    std::vector<std::size_t> steady;
    double squares = 0.0;
    for (std::size_t n = 0; n < pixels.size(); ++n) {
        if (strays[n] <= kStray * *middle) {
            steady.push_back(pixels[n]);
            squares += strays[n] * strays[n];
        }
    }
    spread = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(steady.size(), 1)));
    return steady;
}

Result<void> check_rising(const Ramp& ramp, std::span<const double> shares) {
    double highest = 0.0;
    std::size_t at = 0;
    for (std::size_t k = 0; k < shares.size(); ++k) {
        // NaN too.
        if (!(shares[k] >= highest - kFallOfNoise)) {
            return Error{ErrorCode::unsupported,
                         "light: the flat of " + percent(ramp.steps[k].value) +
                             " is darker in the images than that of " +
                             percent(ramp.steps[at].value) +
                             "; lock exposure and gain, switch picture modes of the projector off, "
                             "and let nothing move"};
        }
        if (shares[k] > highest) {
            highest = shares[k];
            at = k;
        }
    }
    return {};
}

void pool_falls(std::vector<double>& shares) {
    // Pool adjacent violators: the nearest curve that never falls, by least squares.
    struct Pool {
        double sum = 0.0;
        double steps = 0.0;
    };
    std::vector<Pool> pools;
    for (const double share : shares) {
        pools.push_back({share, 1.0});
        while (pools.size() > 1) {
            const Pool last = pools.back();
            Pool& before = pools[pools.size() - 2];
            if (before.sum / before.steps <= last.sum / last.steps) {
                break;
            }
            before = {before.sum + last.sum, before.steps + last.steps};
            pools.pop_back();
        }
    }
    std::size_t k = 0;
    for (const Pool& pool : pools) {
        for (double n = 0.0; n < pool.steps; n += 1.0) {
            shares[k++] = std::clamp(pool.sum / pool.steps, 0.0, 1.0);
        }
    }
    shares.front() = 0.0;
    shares.back() = 1.0;
}

std::vector<double> equal_steps(const Ramp& ramp, std::span<const double> shares) {
    const std::size_t count = std::min(shares.size(), kMaxResponseSteps);
    std::vector<double> light(count);
    std::size_t below = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double value = static_cast<double>(i) / static_cast<double>(count - 1);
        while (below + 2 < shares.size() && ramp.steps[below + 1].value < value) {
            ++below;
        }
        const double from = ramp.steps[below].value;
        const double share = (value - from) / (ramp.steps[below + 1].value - from);
        light[i] = shares[below] + share * (shares[below + 1] - shares[below]);
    }
    light.front() = 0.0;
    light.back() = 1.0;
    return light;
}

double nearest_gamma(std::span<const double> light) {
    constexpr double kSeen = 0.02;  // darker steps are more noise than light
    double product = 0.0;
    double squares = 0.0;
    for (std::size_t i = 1; i + 1 < light.size(); ++i) {
        if (light[i] > kSeen && light[i] < 1.0) {
            const double value =
                std::log(static_cast<double>(i) / static_cast<double>(light.size() - 1));
            product += value * std::log(light[i]);
            squares += value * value;
        }
    }
    return squares > 0.0 ? product / squares : 1.0;
}

}  // namespace xtrack
