// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <xtrack/depth.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/phase_ripple.hpp>
#include <xtrack/recording.hpp>

namespace xtrack::tools {

/// Depth beside ground truth, on the hand (mask 1) without its outermost pixels.
struct TruthReport {
    std::size_t pixels = 0;        ///< of the hand, with true depth
    std::optional<double> rms_mm;  ///< of those within kOffBy_mm, if any are
    double off_percent = 0.0;      ///< share that is off by more
    double missing_percent = 0.0;
};

/// What a decoded depth image is like.
struct DecodeReport {
    std::string frame;   ///< file of the frame that the depth belongs to
    std::string folder;  ///< of its results, inside the output; empty: the output itself
    Stamp stamp;
    bool has_depth = false;
    bool relative = false;       ///< heights above the background, without scale
    double valid_percent = 0.0;  ///< with depth, or where there is none with a phase
    double median_mm = 0.0;
    double low_mm = 0.0;   ///< 1st percentile
    double high_mm = 0.0;  ///< 99th percentile
    std::optional<TruthReport> truth;
    std::optional<PhaseRipple> ripple;  ///< of the shortest grey period, where it shows
};

/// Such as "sine 320 px x3 + sine 32 px x3", in the order of the sequence.
[[nodiscard]] std::string describe(const PatternSequence& patterns);

/// Fills the depth figures of `report` from a depth image of kDepthUnitMm.
void measure_depth(const DepthFrame& depth, DecodeReport& report);

/// Compares with the truth of frame `index`; nothing where the recording has none.
[[nodiscard]] Result<std::optional<TruthReport>> measure_truth(const RecordingReader& recording,
                                                               std::size_t index,
                                                               const DepthFrame& depth);

/// A table for people, or one JSON object for programs.
[[nodiscard]] std::string table_of(const std::string& method, const std::string& note,
                                   const std::vector<DecodeReport>& reports);
[[nodiscard]] std::string json_of(const std::string& method, const std::string& note,
                                  const std::vector<DecodeReport>& reports);

}  // namespace xtrack::tools
