// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <opencv2/core.hpp>

#include "tools/eval/evaluation.hpp"

namespace xtrack::tools {

/// A recording on a time axis: labels above, events below, coloured by what became of them. Long
/// recordings are folded into strips; what is close together is put into rows, so that no text
/// covers another.
[[nodiscard]] cv::Mat timeline_picture(const EvaluatedRecording& recording);

/// Where `--timeline` puts the picture of each recording.
class TimelineFolder {
 public:
    /// @param target a name that ends in .png, for one recording, or a folder, made if it is not
    ///        there
    /// @errors invalid_argument: a file for several recordings; io: the folder cannot be made
    [[nodiscard]] static Result<TimelineFolder> create(const std::filesystem::path& target,
                                                       std::size_t recordings);
    /// Writes the picture, under a temporary name first; an existing one is replaced. Recordings of
    /// the same name are numbered.
    /// @errors io: names the file
    [[nodiscard]] Result<void> write(const EvaluatedRecording& recording);

 private:
    std::filesystem::path target_;
    bool is_file_ = false;
    std::vector<std::string> names_;
};

}  // namespace xtrack::tools
