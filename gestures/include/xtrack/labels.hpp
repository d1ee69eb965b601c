// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <xtrack/hand.hpp>
#include <xtrack/result.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// One line of labels.csv: what a person did, and when.
/// @since 0.1
struct GestureLabel {
    /// The name of an event (`push`), with its direction where it has one (`swipe_left`); without,
    /// it stands for every direction (`swipe`, `circle`). `x_...` are gestures that we do not name.
    std::string gesture;
    Chirality hand = Chirality::unknown;  ///< unknown matches either
    Stamp start;
    Stamp end;
    /// The moment it could first be told, where somebody said so; by that person's definition,
    /// which need not be the recogniser's. The simulator's, for one, ask a push for 330 mm/s and a
    /// pinch for 50 ms, GestureSettings for 370 and 80: the first is what the gesture is, the
    /// second what tells it from all else. What lies between them counts as delay.
    std::optional<Stamp> commit;
    friend bool operator==(const GestureLabel&, const GestureLabel&) = default;
};

/// One line of poses.csv: what a still shows.
/// @since 0.1
struct PoseLabel {
    std::size_t frame = 0;  ///< index into the recording's entries
    std::string pose;       ///< empty where nobody said
    std::optional<int> extended_fingers;
    bool hand_present = false;
    friend bool operator==(const PoseLabel&, const PoseLabel&) = default;
};

/// One line of truth/hands.csv: where a hand really was. Camera frame, mm.
/// @since 0.1
struct HandTruth {
    Stamp stamp;
    Chirality hand = Chirality::unknown;
    TrackedPoint palm;  ///< centre of the largest inscribed circle, at the skin
    std::array<TrackedPoint, kFingerCount> tips{};  ///< distal extremes, on the silhouette
    std::array<TrackedPoint, kFingerCount> pads{};
    float pinch_mm = -1.0F;  ///< thumb to index; -1 = unknown
};

// Readers. Errors name file, line, field and mend: a column is missing, a number is none or absurd,
// a name is not known (a pose's: not a word), time goes backwards (in a label: it ends before it
// starts), a file is over 64 MiB. An empty list is legal. The parse functions take a text; `name`
// is the file's, for messages. @thread any

/// @since 0.1
[[nodiscard]] Result<std::vector<GestureLabel>> read_labels(const std::filesystem::path& file);
[[nodiscard]] Result<std::vector<GestureLabel>> parse_labels(std::string_view text,
                                                             const std::string& name);
/// @since 0.1
[[nodiscard]] Result<std::vector<PoseLabel>> read_poses(const std::filesystem::path& file);
[[nodiscard]] Result<std::vector<PoseLabel>> parse_poses(std::string_view text,
                                                         const std::string& name);
/// Points of which any coordinate is empty or whose columns are missing are not valid.
/// @since 0.1
[[nodiscard]] Result<std::vector<HandTruth>> read_hand_truth(const std::filesystem::path& file);
[[nodiscard]] Result<std::vector<HandTruth>> parse_hand_truth(std::string_view text,
                                                              const std::string& name);

/// What a label is of, its times left open. @param hand left, right or unknown
/// @errors invalid_argument: one of them is not known, and what there is
/// @since 0.1
[[nodiscard]] Result<GestureLabel> label_of(std::string_view gesture, std::string_view hand);

// The texts that the parse functions read back (positions to 0.01 mm).

/// @since 0.1
[[nodiscard]] std::string labels_text(std::span<const GestureLabel> labels);
/// @since 0.1
[[nodiscard]] std::string hand_truth_text(std::span<const HandTruth> truth);

/// Writes labels.csv, whole or not at all; an existing file is replaced.
/// @return an Error: a gesture that parse_labels() would refuse, or the file cannot be written
/// @since 0.1
[[nodiscard]] Result<void> write_labels(const std::filesystem::path& file,
                                        std::span<const GestureLabel> labels);

}  // namespace xtrack
