// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include <xtrack/depth_decoder.hpp>
#include <xtrack/recording.hpp>

#include "tools/decode_exports.hpp"

namespace xtrack::tools {

/// What `decode` was asked for.
struct DecodeOptions {
    std::string recording;
    std::string out;
    bool all = false;
    std::string order_from;
    std::optional<std::string> gamma;
    std::set<Export> exports{Export::ply};
    bool json = false;
    double min_modulation = DecodeSettings{}.min_modulation;
    std::vector<std::string> changes;  ///< of settings
};

/// A decoder, how its order is found, and what the user should know about that.
struct ChosenDecoder {
    DepthDecoder decoder;
    bool makes_depth = true;
    std::string order;
    std::string note;
};

/// With a rig the order is that of the patterns or of --order-from; where nothing gives it, phase
/// alone.
/// @errors as DepthDecoder::create(), naming the file
[[nodiscard]] Result<ChosenDecoder> choose_decoder(const RecordingReader& recording,
                                                   const PatternSequence& patterns,
                                                   const DecodeOptions& options);

}  // namespace xtrack::tools
