// SPDX-License-Identifier: Apache-2.0
#include <xtrack/phase_ripple.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "core/decode/gamma_correction.hpp"
#include "core/decode/taps.hpp"

namespace xtrack {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kLeastPixels = 2000;
constexpr int kMostLines = 96;  // of pixels that are looked at, evenly over the image
// From one pixel to the next a fringe runs on by less than this, rad; more is a border.
constexpr double kBorderRad = 1.0;
constexpr int kUnknowns = 6;  // cosine and sine of three harmonics
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Right = Eigen::Matrix<double, kUnknowns, 1>;

struct Sums {
    Normal normal = Normal::Zero();
    Right right = Right::Zero();
    std::size_t pixels = 0;
};

// Lines of pixels across the fringes: rows, or columns where the phase runs down the image.
using Lines = std::vector<std::vector<float>>;

double step_along(const PhaseMap& map, int dx, int dy) {
    double sum = 0.0;
    for (int y = 0; y + dy < map.phase_rad.height(); y += 4) {
        for (int x = 0; x + dx < map.phase_rad.width(); ++x) {
            const double step =
                static_cast<double>(map.phase_rad.at(x + dx, y + dy) - map.phase_rad.at(x, y));
            sum += std::isfinite(step) ? std::remainder(step, 2.0 * kPi) : 0.0;
        }
    }
    return std::fabs(sum);
}

Lines lines_across(const PhaseMap& map) {
    const Image<float>& phase = map.phase_rad;
    const bool along_rows = step_along(map, 1, 0) >= step_along(map, 0, 1);
    const int count = along_rows ? phase.height() : phase.width();
    const int length = along_rows ? phase.width() : phase.height();
    const int stride = std::max(1, count / kMostLines);
    Lines lines;
    for (int n = stride / 2; n < count; n += stride) {
        std::vector<float>& line = lines.emplace_back(static_cast<std::size_t>(length));
        for (int i = 0; i < length; ++i) {
            line[static_cast<std::size_t>(i)] = along_rows ? phase.at(i, n) : phase.at(n, i);
        }
    }
    return lines;
}

// A phase that runs on without borders, between its pixels too.
class Stretch {
 public:
    explicit Stretch(const std::vector<double>& phase) : phase_(phase), integral_(phase.size()) {
        for (std::size_t i = 1; i < phase.size(); ++i) {
            integral_[i] = integral_[i - 1] + 0.5 * (phase[i - 1] + phase[i]);
        }
    }
    // Integral from the first pixel to place x.
    [[nodiscard]] double until(double x) const {
        const auto i = std::min(static_cast<std::size_t>(x), phase_.size() - 2);
        const double t = x - static_cast<double>(i);
        return integral_[i] + t * phase_[i] + 0.5 * t * t * (phase_[i + 1] - phase_[i]);
    }

 private:
    const std::vector<double>& phase_;
    std::vector<double> integral_;
};

// Each pixel with half a fringe to both sides is compared with the mean of a fringe's length around
// it. The length is where the phase has gone on by half a turn on either side; only the length, as
// ripples shift both ends alike.
void add_stretch(const std::vector<double>& phase, int steps, Sums& sums) {
    const Stretch stretch(phase);
    const double sign = phase.back() >= phase.front() ? 1.0 : -1.0;
    const auto reached = [&](std::size_t inside, std::size_t outside, double wanted) {
        const double share = (wanted - phase[inside]) / (phase[outside] - phase[inside]);
        return static_cast<double>(inside) +
               share * (static_cast<double>(outside) - static_cast<double>(inside));
    };
    std::size_t left = 0;
    std::size_t right = 0;
    for (std::size_t i = 0; i < phase.size(); ++i) {
        while (left < i && sign * (phase[i] - phase[left + 1]) >= kPi) {
            ++left;
        }
        right = std::max(right, i);
        while (right < phase.size() && sign * (phase[right] - phase[i]) < kPi) {
            ++right;
        }
        if (right == phase.size()) {
            break;
        }
        if (sign * (phase[i] - phase[left]) < kPi) {
            continue;
        }
        const double half_fringe = 0.5 * (reached(right - 1, right, phase[i] + sign * kPi) -
                                          reached(left + 1, left, phase[i] - sign * kPi));
        const auto here = static_cast<double>(i);
        if (here < half_fringe || here + half_fringe > static_cast<double>(phase.size() - 1)) {
            continue;
        }
        const double smooth =
            (stretch.until(here + half_fringe) - stretch.until(here - half_fringe)) /
            (2.0 * half_fringe);
        Right harmonics;
        const int orders[3] = {1, 2, steps};
        for (int n = 0; n < 3; ++n) {
            harmonics[2 * n] = std::cos(orders[n] * smooth);
            harmonics[2 * n + 1] = std::sin(orders[n] * smooth);
        }
        sums.normal += harmonics * harmonics.transpose();
        sums.right += harmonics * (phase[i] - smooth);
        ++sums.pixels;
    }
}

Result<PhaseRipple> measure(const Lines& lines, int steps) {
    Sums sums;
    std::vector<double> stretch;
    const auto finish = [&] {
        if (stretch.size() > 2) {
            add_stretch(stretch, steps, sums);
        }
        stretch.clear();
    };
    for (const std::vector<float>& line : lines) {
        for (const float value : line) {
            const auto phase = static_cast<double>(value);
            if (!std::isfinite(phase)) {
                finish();
                continue;
            }
            if (!stretch.empty()) {
                const double step = std::remainder(phase - stretch.back(), 2.0 * kPi);
                if (std::fabs(step) <= kBorderRad) {
                    stretch.push_back(stretch.back() + step);
                    continue;
                }
                finish();
            }
            stretch.push_back(phase);
        }
        finish();
    }
    if (sums.pixels < kLeastPixels) {
        return Error{ErrorCode::unsupported,
                     "phase ripple: too little shows whole fringes side by side; use shorter "
                     "periods, or a wall"};
    }
    // A little on the diagonal: with two steps' harmonics equal none is left undetermined.
    constexpr double kRidge = 1e-6;
    sums.normal.diagonal().array() += kRidge * static_cast<double>(sums.pixels);
    const Right found = sums.normal.ldlt().solve(sums.right);
    PhaseRipple ripple;
    ripple.brightness_rad = std::hypot(found[0], found[1]);
    ripple.steps_rad = std::hypot(found[2], found[3]);
    ripple.gamma_rad = std::hypot(found[4], found[5]);
    ripple.pixels = sums.pixels;
    return ripple;
}

}  // namespace

RippleCause cause_of(const PhaseRipple& ripple) noexcept {
    const double largest = std::max({ripple.brightness_rad, ripple.steps_rad, ripple.gamma_rad});
    if (largest < kWorthMention_rad) {
        return RippleCause::none;
    }
    if (largest == ripple.gamma_rad) {
        return RippleCause::gamma;
    }
    return largest == ripple.steps_rad ? RippleCause::steps : RippleCause::brightness;
}

Result<PhaseRipple> measure_ripple(const PhaseMap& map, int steps) {
    if (steps < 3 || steps > kMaxTaps) {
        return Error{ErrorCode::invalid_argument, "phase ripple: " + std::to_string(steps) +
                                                      " steps; give 3 to " +
                                                      std::to_string(kMaxTaps)};
    }
    return measure(lines_across(map), steps);
}

Result<double> estimate_gamma(const PhaseMap& map, std::span<const double> phases_rad) {
    const auto taps = least_squares_taps(phases_rad);
    if (!taps) {
        return taps.error();
    }
    const auto steps = static_cast<int>(phases_rad.size());
    if (steps != 3) {
        return Error{ErrorCode::unsupported,
                     "gamma: " + std::to_string(steps) +
                         " steps hardly show it, and hardly suffer from it (0.009 rad at 2.2 with "
                         "four); use three"};
    }
    const Lines lines = lines_across(map);
    if (auto enough = measure(lines, steps); !enough) {
        return enough.error();
    }
    const auto ripple_with = [&](double log_gamma) {
        const GammaCorrection correction(*taps, phases_rad, ResponseCurve(std::exp(log_gamma)));
        Lines corrected = lines;
        for (std::vector<float>& line : corrected) {
            correction.apply(static_cast<int>(line.size()), line.data());
        }
        const auto ripple = measure(corrected, steps);
        return ripple ? ripple->gamma_rad : kPi;
    };
    // Golden section; the ripple has one minimum between gammas that projectors have.
    constexpr double kGolden = 0.6180339887498949;
    double low = std::log(0.3);
    double high = std::log(4.0);
    double a = high - kGolden * (high - low);
    double b = low + kGolden * (high - low);
    double at_a = ripple_with(a);
    double at_b = ripple_with(b);
    constexpr double kCloseEnough = 1e-3;  // of gamma
    while (high - low > kCloseEnough) {
        if (at_a < at_b) {
            high = b;
            b = a;
            at_b = at_a;
            a = high - kGolden * (high - low);
            at_a = ripple_with(a);
        } else {
            low = a;
            a = b;
            at_a = at_b;
            b = low + kGolden * (high - low);
            at_b = ripple_with(b);
        }
    }
    return std::exp(0.5 * (low + high));
}

}  // namespace xtrack
