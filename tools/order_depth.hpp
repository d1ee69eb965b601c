// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <xtrack/image.hpp>
#include <xtrack/recording.hpp>
#include <xtrack/result.hpp>

namespace xtrack::tools {

/// Whether files of two frames have the same name, apart from their folders and what follows the
/// dot.
[[nodiscard]] bool stems_repeat(const RecordingReader& recording);

/// Depth images that tell a decoder its fringe order: one file for all frames, or a folder in which
/// each frame has one of its own name (or all share the only one).
class OrderDepth {
 public:
    /// @param path as the user gave it, also one inside the recording; empty: none is wanted
    [[nodiscard]] static Result<OrderDepth> open(const RecordingReader& recording,
                                                 const std::string& path);

    [[nodiscard]] bool wanted() const noexcept { return !path_.empty(); }

    /// The depth for a frame, kDepthUnitMm a step. Valid until the next call.
    [[nodiscard]] Result<const Image<std::uint16_t>*> of(const RecordingReader& recording,
                                                         std::size_t index);

 private:
    std::filesystem::path path_;
    std::filesystem::path only_;    // the one file, if there is but one
    std::filesystem::path loaded_;  // which file depth_ holds
    Image<std::uint16_t> depth_;
};

}  // namespace xtrack::tools
