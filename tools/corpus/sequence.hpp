// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include <xtrack/gesture_settings.hpp>
#include <xtrack/labels.hpp>

#include "tools/corpus/movement.hpp"
#include "tools/corpus/noise.hpp"

namespace xtrack::tools::corpus {

/// Gestures that are asked for together, as one program would.
struct GestureSet {
    const char* name = "";
    const char* gestures = "";  ///< as --gestures writes them
    /// Whether natural movement is measured with it: what is held up at rest is a gesture of some
    /// sets by definition.
    bool everyday = false;
    /// Without these there.
    const char* not_everyday = "";
};
/// The whole vocabulary, in sets.
[[nodiscard]] std::span<const GestureSet> gesture_sets() noexcept;

/// Strangers near whoever has the session.
enum class Company : std::uint8_t { queue, child, over_the_shoulder, crossing };
inline constexpr std::size_t kCompanyCount = 4;
[[nodiscard]] const char* to_string(Company company) noexcept;

/// Hands through time, as they were, and what was asked of them. The same seed, the same bits.
struct Sequence {
    std::string name;
    std::uint64_t seed = 0;
    View view = View::fine;
    double frame_hz = 60.0;
    double end_s = 0.0;
    std::deque<Movement> hands;
    std::vector<bool> strange;  ///< of each hand: nobody should listen to it
    std::vector<GestureLabel> labels;
    int short_of_definition = 0;  ///< performed, and not labelled
};

/// How a sequence is seen: depth cameras at 20 to 120 frames a second and joints, in turn.
struct Seen {
    View view = View::fine;
    double frame_hz = 60.0;
};
/// @param frame_hz 0: whatever `index` brings
[[nodiscard]] Seen seen_by(std::uint64_t index, double frame_hz);

/// Every gesture of a set `times` times, in an order of its own, by one person.
[[nodiscard]] Sequence perform_all(const std::vector<std::string>& names, const Person& person,
                                   int times, const Seen& seen);
/// Somebody who wants nothing of the screen, for so long.
[[nodiscard]] Sequence everyday(std::uint64_t seed, double seconds, const Seen& seen);
/// People who walk past or stand farther away than hands are listened to.
[[nodiscard]] Sequence passers_by(std::uint64_t seed, double seconds, const Seen& seen);
/// One who takes the session and gestures, and others about them.
[[nodiscard]] Sequence in_company(Company company, std::uint64_t seed,
                                  const std::vector<std::string>& names, const Seen& seen);

}  // namespace xtrack::tools::corpus
