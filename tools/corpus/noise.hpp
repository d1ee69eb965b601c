// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace xtrack::tools::corpus {

/// Who sees the hands.
enum class View : std::uint8_t {
    fine,    ///< a depth camera like `ideal-60`
    coarse,  ///< one like `webcam-30` with two colour patterns
    joints,  ///< a hand tracker that gives joints
};
inline constexpr std::size_t kViewCount = 3;
[[nodiscard]] const char* to_string(View view) noexcept;

/// Of a hand at rest, and of one that moves faster than 100 mm/s.
using RestAndMotion = std::array<double, 2>;

/// Errors of a tracker: standard deviations of what is no outlier, and what is one.
struct Noise {
    RestAndMotion palm_aside_mm{};  ///< each of x and y
    RestAndMotion palm_deep_mm{};   ///< z
    RestAndMotion outlier_share{};  ///< of the time the palm is off toward the arm, by about:
    double outlier_mm = 0.0;
    RestAndMotion tip_mm{};       ///< each axis
    RestAndMotion finger_lost{};  ///< share of the time a straight finger counts as folded
    double bent_off = 0.0;        ///< extension of a finger that is neither straight nor folded
    double bent = 0.0;
    RestAndMotion lost_share{};              ///< of the time a hand in view is not seen
    double lost_ms = 0.0;                    ///< for so long, on average
    std::array<double, 5> tip_valid{};       ///< of a tip that stands out, by kTipGaps_mm
    double hidden_tip_valid = 0.0;           ///< of one before the palm
    std::array<double, 4> aperture_known{};  ///< by kApertures_mm
    std::array<double, 4> aperture_off_mm{};
    std::array<double, 4> aperture_mm{};
    double aperture_wild_share = 0.0;  ///< of the time another tip is taken for one of the two
    double aperture_wild_mm = 0.0;
    double grab = 0.0;
    double normal_rad = 0.0;
    double confidence = 1.0;
    double chirality_unknown = 0.0;
    double chirality_wrong = 0.0;
    /// Time constants: of what jitters, and of what holds while a hand is held so.
    double quick_s = 0.06;
    double slow_s = 0.15;
};

/// Bounds of the bins of Noise::tip_valid: to the nearest other tip, of an adult's hand.
inline constexpr std::array<double, 5> kTipGaps_mm{10.0, 14.0, 18.0, 25.0, 1e9};
/// ... and of those of the aperture.
inline constexpr std::array<double, 4> kApertures_mm{15.0, 30.0, 60.0, 1e9};
/// The bin that a value is in.
[[nodiscard]] std::size_t bin_of(double value, const auto& bins) noexcept {
    std::size_t bin = 0;
    while (bin + 1 < bins.size() && value >= bins[bin]) {
        ++bin;
    }
    return bin;
}

/// What `xtrack corpus --measure-noise` prints of the simulated rigs, in numbers.
[[nodiscard]] const Noise& noise_of(View view) noexcept;

}  // namespace xtrack::tools::corpus
