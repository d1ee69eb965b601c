// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <xtrack/depth.hpp>
#include <xtrack/frame.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>
#include <xtrack/source.hpp>

namespace xtrack {

/// What a recording holds. Joints are read by joint_recording.hpp.
/// @since 0.1
enum class RecordingKind {
    fringe,  ///< 8-bit images of projected patterns (a pattern.yaml is there)
    depth,   ///< 16-bit depth images
    joints,  ///< no images: joints.csv
};

/// What becomes of the colours of fringe images.
/// @since 0.1
enum class ColourReading {
    by_pattern,  ///< bgr8 where the pattern is coloured, else luma: what decoding wants
    as_stored,   ///< bgr8 where the file has colours: what a calibration of light wants
};

/// One line of frames.csv.
/// @since 0.1
struct RecordingEntry {
    std::string file;  ///< inside the folder, `/` between names
    Stamp stamp;
    std::uint64_t sequence = 0;
    int pattern = kUnknownPattern;
    /// Frame's, where some rows saw another pattern; the end is 0 where nobody says: all are clean.
    int clean_row_begin = 0;
    int clean_row_end = 0;
};

/// A folder of images with their stamps: the format that docs/recordings.md describes. open()
/// checks everything but the pixels, so that a torn recording is refused before work begins; images
/// are checked when they are read. What is missing limits what can be done: without rig.yaml there
/// is phase but no metric depth.
///
/// Messages are one line that names file, field (line number) and mend.
/// @thread const members from any thread; copies share what was read
/// @since 0.1
class RecordingReader {
 public:
    /// Reads rig.yaml, pattern.yaml and frames.csv and finds the rest.
    /// @return an Error: the folder is not there or is no recording; a file is torn, too large or
    ///         breaks the format; an image that frames.csv names is missing; stamps decrease; no
    ///         frame of fringes names its pattern; the rig of fringes has no projector, or is
    ///         singular; the first image is not of the rig's camera_size
    [[nodiscard]] static Result<RecordingReader> open(const std::filesystem::path& folder);

    [[nodiscard]] RecordingKind kind() const noexcept;
    [[nodiscard]] const std::filesystem::path& folder() const noexcept;
    [[nodiscard]] bool has_rig() const noexcept;
    /// Validated; of no meaning unless has_rig().
    [[nodiscard]] const Rig& rig() const noexcept;
    /// Validated; empty unless kind() is fringe. Frames may show fewer patterns than are listed.
    [[nodiscard]] const PatternSequence& patterns() const noexcept;
    /// Millimetres a step of the depth images.
    [[nodiscard]] double depth_unit_mm() const noexcept;
    /// In the order of time; empty for joints.
    [[nodiscard]] std::span<const RecordingEntry> entries() const noexcept;
    /// Of every image: the rig's camera, or where there is no rig the first image's.
    [[nodiscard]] Size image_size() const noexcept;

    /// Reads one image of fringes: bgr8 if its pattern (or, where that is unknown, any of the
    /// sequence) is coloured, else grey8, colour images by their luma; or as `colours` says.
    /// @return an Error: the kind is not fringe; the image is torn, of another size or not 8-bit
    /// @pre index < entries().size(), here and below
    [[nodiscard]] Result<void> read_frame(std::size_t index, Frame& out,
                                          ColourReading colours = ColourReading::by_pattern) const;

    /// Reads one depth image. `quality` is left empty; `metric` says if there is a rig.
    [[nodiscard]] Result<void> read_depth(std::size_t index, DepthFrame& out) const;

    // Ground truth of the frame `index`: the file of the same name below truth/, or the only file
    // there is (a scene that does not move).
    [[nodiscard]] bool has_truth_depth(std::size_t index) const;
    [[nodiscard]] bool has_truth_mask(std::size_t index) const;
    /// Depth of the first surface, kDepthUnitMm a step.
    [[nodiscard]] Result<void> read_truth_depth(std::size_t index, DepthFrame& out) const;
    /// What each pixel shows: 1 hand, 2 forearm, other values the rest.
    [[nodiscard]] Result<void> read_truth_mask(std::size_t index, Image<std::uint8_t>& out) const;

    // Files that other readers take; nothing if they are not there.
    [[nodiscard]] std::optional<std::filesystem::path> joints_file() const;
    [[nodiscard]] std::optional<std::filesystem::path> labels_file() const;
    [[nodiscard]] std::optional<std::filesystem::path> poses_file() const;
    [[nodiscard]] std::optional<std::filesystem::path> truth_hands_file() const;

 private:
    struct Content;
    RecordingReader() = default;
    [[nodiscard]] static Result<RecordingReader> read(const std::filesystem::path& folder);
    [[nodiscard]] Result<void> read_truth(const char* kind, std::size_t index,
                                          std::filesystem::path& file) const;
    std::shared_ptr<const Content> content_;
};

/// The frames of a recording, one after the other, each once and at once: it waits for nothing, so
/// that a replay is deterministic. A player that wants the recording's own pace waits by the
/// stamps. A broken image ends the stream with `failed`.
/// @return an Error if the recording holds no fringes
/// @thread any
/// @since 0.1
[[nodiscard]] Result<std::unique_ptr<FrameSource>> frame_source(const RecordingReader& recording);

/// The same for depth images.
/// @return an Error if the recording holds no depth
/// @thread any
/// @since 0.1
[[nodiscard]] Result<std::unique_ptr<DepthSource>> depth_source(const RecordingReader& recording);

/// Writes a recording. Everything goes into a temporary folder beside the target, which gets its
/// name at close(): a recording is there whole or not at all. Without a close() nothing remains,
/// unless the program is killed: then what was added so far can be read in folder().
/// Images are PNG, so that what is read back is bit for bit what was written.
/// @thread one at a time
/// @since 0.1
class RecordingWriter {
 public:
    /// What stays the same for all frames.
    struct Setup {
        std::optional<Rig> rig;
        std::optional<PatternSequence> patterns;  ///< fringes; absent: depth
        double depth_unit_mm = kDepthUnitMm;      ///< depth alone; another unit needs the rig
    };

    /// @return an Error: the target exists (it is never overwritten), its parent is missing, or the
    ///         rig or the sequence is not valid
    [[nodiscard]] static Result<RecordingWriter> create(const std::filesystem::path& target,
                                                        const Setup& setup);
    RecordingWriter(RecordingWriter&&) noexcept;
    RecordingWriter& operator=(RecordingWriter&&) noexcept;
    ~RecordingWriter();

    /// Adds an image of fringes. Stamps must not decrease, sizes must not change. The format has no
    /// place for `status`: read back, a frame is `ok`. One without any clean row, as a frame is
    /// made, is read back as one that is clean all over.
    [[nodiscard]] Result<void> add(const Frame& frame);
    /// Adds a depth image, in the unit of the setup.
    [[nodiscard]] Result<void> add(const DepthFrame& depth);
    /// Adds ground truth for the frame that was added last: depth of kDepthUnitMm a step, and what
    /// each pixel shows. Either may be empty.
    [[nodiscard]] Result<void> add_truth(ImageView<const std::uint16_t> depth,
                                         ImageView<const std::uint8_t> mask);
    /// Adds a text file such as `labels.csv` or `truth/hands.csv`; the name stays inside.
    [[nodiscard]] Result<void> add_text(const std::string& name, const std::string& text);

    /// Where it is until close().
    [[nodiscard]] const std::filesystem::path& folder() const noexcept;

    /// Gives the folder its name. After this only destruction is legal.
    /// @return an Error: no frame was added, no frame of fringes names its pattern, a stamp or a
    ///         sequence is beyond what the format holds, or the disk refuses; nothing remains then
    [[nodiscard]] Result<void> close();

 private:
    struct State;
    explicit RecordingWriter(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace xtrack
