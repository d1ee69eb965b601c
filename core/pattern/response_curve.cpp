// SPDX-License-Identifier: Apache-2.0
#include "core/pattern/response_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace xtrack {

double ResponseCurve::light(double value) const noexcept {
    if (light_.empty()) {
        return gamma_ == 1.0 ? value : std::pow(value, gamma_);
    }
    const auto last = static_cast<double>(light_.size() - 1);
    const double place = std::clamp(value, 0.0, 1.0) * last;
    const auto step = std::min(static_cast<std::size_t>(place), light_.size() - 2);
    const double share = place - static_cast<double>(step);
    return light_[step] + share * (light_[step + 1] - light_[step]);
}

double ResponseCurve::value(double light) const noexcept {
    if (light_.empty()) {
        return gamma_ == 1.0 ? light : std::pow(light, 1.0 / gamma_);
    }
    const auto above = std::lower_bound(light_.begin(), light_.end(), light);
    if (above == light_.begin()) {
        return 0.0;
    }
    if (above == light_.end()) {
        return 1.0;
    }
    const double share = (light - above[-1]) / (above[0] - above[-1]);
    return (static_cast<double>(above - light_.begin() - 1) + share) /
           static_cast<double>(light_.size() - 1);
}

ResponseCurve colour_response(const PatternSequence& sequence, int channel) {
    if (sequence.response) {
        return ResponseCurve(sequence.response->light[static_cast<std::size_t>(channel)]);
    }
    return ResponseCurve(sequence.gamma.value_or(1.0));
}

ResponseCurve grey_response(const PatternSequence& sequence) {
    if (!sequence.response) {
        return colour_response(sequence, 0);
    }
    constexpr std::array<double, 3> kLuma{0.299, 0.587, 0.114};  // Rec. 601
    std::vector<double> light(sequence.response->light[0].size(), 0.0);
    for (std::size_t i = 0; i < light.size(); ++i) {
        for (std::size_t c = 0; c < kLuma.size(); ++c) {
            light[i] += kLuma[c] * sequence.response->light[c][i];
        }
    }
    return ResponseCurve(std::move(light));
}

}  // namespace xtrack
