// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include <xtrack/labels.hpp>
#include <xtrack/recording.hpp>
#include <xtrack/session.hpp>

#include "core/base/file.hpp"
#include "tools/live_source.hpp"

namespace xtrack::tools {

/// What is kept of a stream.
enum class RecordWhat { images, depth, joints };

[[nodiscard]] const char* to_string(RecordWhat what) noexcept;

struct RecorderSetup {
    std::filesystem::path out;
    RecordWhat what = RecordWhat::images;
    bool hand_only = false;  ///< depth: everything but hands is left out
};

/// Stores what a session works on while it does. Until close() all of it lies in a folder beside
/// the target, where it can be read whenever the program ends.
/// @thread one at a time
class Recorder {
 public:
    /// @errors invalid_argument: the source does not give this; unsupported: it needs a
    ///         calibration; what RecordingWriter::create() says of the target
    [[nodiscard]] static Result<Recorder> create(const RecorderSetup& setup,
                                                 const OpenedSource& source);

    /// Adds one item, if it has what is kept. @errors io: the disk refuses; what was added before
    /// stays
    [[nodiscard]] Result<void> add(const PipelineView& view);
    /// Writes labels.csv, replacing the one of before.
    [[nodiscard]] Result<void> set_labels(std::span<const GestureLabel> labels);
    /// Gives the recording its name. @errors as RecordingWriter::close()
    [[nodiscard]] Result<void> close();

    /// Where it lies until close().
    [[nodiscard]] const std::filesystem::path& folder() const noexcept;
    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    /// From the first to the last that was added.
    [[nodiscard]] Duration length() const noexcept { return last_ - first_; }

 private:
    explicit Recorder(const RecorderSetup& setup) : setup_(setup) {}
    [[nodiscard]] Result<void> add_joints(const HandFrame& hands);
    /// Depth of hands alone.
    const DepthFrame& masked(const PipelineView& view);

    RecorderSetup setup_;
    std::optional<RecordingWriter> writer_;  // images, depth
    std::optional<base::NewFolder> joints_;
    DepthFrame masked_;
    std::size_t count_ = 0;
    Stamp first_;
    Stamp last_;
};

}  // namespace xtrack::tools
