// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <xtrack/frame.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/rig.hpp>

namespace xtrack::test {

/// A recording read with OpenCV alone, so that the decoder is judged apart from our own reader.
struct RecordingOnDisk {
    Rig rig;
    PatternSequence patterns;
    std::vector<FramePtr> frames;
    std::filesystem::path folder;

    [[nodiscard]] Size size() const { return frames.front()->size(); }
    /// Truth of a frame; empty image if there is none.
    [[nodiscard]] Image<std::uint16_t> truth_depth(int index) const;
    [[nodiscard]] Image<std::uint8_t> truth_mask(int index) const;
};

/// @param name below the folder of outside recordings, as "rendered/static-dual"
/// @return false if it is not there
[[nodiscard]] bool load_recording(const std::string& name, RecordingOnDisk& recording);

}  // namespace xtrack::test
