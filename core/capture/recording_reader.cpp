// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <vector>

#include <xtrack/recording.hpp>

#include "core/base/file.hpp"
#include "core/base/setting_up.hpp"
#include "core/capture/frame_list.hpp"
#include "core/capture/image_codec.hpp"
#include "core/capture/image_header.hpp"
#include "core/capture/yaml_file.hpp"

namespace xtrack {

namespace fs = std::filesystem;

struct RecordingReader::Content {
    RecordingKind kind = RecordingKind::joints;
    fs::path folder;
    bool has_rig = false;
    Rig rig;
    PatternSequence patterns;
    double depth_unit_mm = kDepthUnitMm;
    std::vector<RecordingEntry> entries;
    Size image_size;
    bool any_colour = false;
};

namespace {

constexpr std::size_t kMaxListBytes = std::size_t{256} << 20U;
constexpr std::size_t kMaxImageBytes = std::size_t{256} << 20U;

/// A link to nothing is there: it fails when it is opened, and is not passed over.
bool is_there(const fs::path& path) {
    std::error_code ignored;
    return fs::symlink_status(path, ignored).type() != fs::file_type::not_found;
}

std::optional<fs::path> if_there(const fs::path& path) {
    return is_there(path) ? std::optional(path) : std::nullopt;
}

std::string text_of(Size s) { return std::to_string(s.width) + "x" + std::to_string(s.height); }

Error unsupported(const fs::path& folder, const std::string& what) {
    return {ErrorCode::unsupported, folder.string() + ": " + what};
}

// A torn copy lacks images: better said before work begins than in the midst of it.
Result<void> check_images_are_there(const fs::path& folder,
                                    const std::vector<RecordingEntry>& entries) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
        std::error_code ignored;
        const fs::file_type type = fs::status(folder / entries[i].file, ignored).type();
        if (type == fs::file_type::regular) {
            continue;
        }
        const char* what = type == fs::file_type::not_found
                               ? " is not there; copy it or remove the row"
                           : type == fs::file_type::none ? " cannot be read; check the permissions"
                                                         : " is no file; put the image there";
        return Error{ErrorCode::not_found, (folder / "frames.csv").string() + " frame " +
                                               std::to_string(i) + ": file " + entries[i].file +
                                               what};
    }
    return {};
}

Result<Size> peek_size(const fs::path& file) {
    // Headers of camera images can carry a thumbnail before the size, and seldom more than fits.
    constexpr std::size_t kPeekBytes = std::size_t{256} << 10U;
    auto bytes = base::read_start(file, kPeekBytes);
    if (!bytes) {
        return bytes.error();
    }
    auto info = capture::peek_image(*bytes, file.string());
    if (!info && bytes->size() == kPeekBytes) {
        bytes = base::read_file(file, kMaxImageBytes);
        if (!bytes) {
            return bytes.error();
        }
        info = capture::peek_image(*bytes, file.string());
    }
    if (!info) {
        return info.error();
    }
    if (!is_image_size(info->size)) {
        return Error{ErrorCode::malformed, file.string() + ": is over " +
                                               std::to_string(kMaxImageSide_px) +
                                               " pixels wide or high, or over 64 million in all; "
                                               "scale it down"};
    }
    return info->size;
}

}  // namespace

Result<RecordingReader> RecordingReader::open(const fs::path& folder) {
    return base::setting_up("RecordingReader::open", [&] { return read(folder); });
}

Result<RecordingReader> RecordingReader::read(const fs::path& folder) {
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) {
        return Error{ErrorCode::not_found,
                     folder.string() + ": is no folder; give the folder of a recording"};
    }
    auto content = std::make_shared<Content>();
    Content& c = *content;
    c.folder = folder;

    if (const fs::path file = folder / "rig.yaml"; is_there(file)) {
        const auto text = base::read_file(file, capture::kMaxYamlBytes);
        if (!text) {
            return text.error();
        }
        auto rig = capture::parse_rig(*text, file.string());
        if (!rig) {
            return rig.error();
        }
        c.has_rig = true;
        c.rig = rig->rig;
        c.depth_unit_mm = rig->depth_unit_mm.value_or(kDepthUnitMm);
    }

    const fs::path list = folder / "frames.csv";
    const fs::path patterns = folder / "pattern.yaml";
    if (is_there(patterns)) {
        c.kind = RecordingKind::fringe;
        const auto text = base::read_file(patterns, capture::kMaxYamlBytes);
        if (!text) {
            return text.error();
        }
        auto sequence = capture::parse_patterns(*text, patterns.string());
        if (!sequence) {
            return sequence.error();
        }
        c.patterns = std::move(*sequence);
        c.any_colour =
            std::any_of(c.patterns.patterns.begin(), c.patterns.patterns.end(),
                        [](const Pattern& p) { return p.kind == PatternKind::rgb_sine; });
        if (c.has_rig && !c.rig.projector) {
            return Error{ErrorCode::malformed,
                         (folder / "rig.yaml").string() +
                             ": projector_matrix is missing; add the projector, or remove rig.yaml "
                             "to decode the phase alone"};
        }
        if (c.has_rig && c.rig.projector->size != c.patterns.projector_size) {
            return Error{ErrorCode::malformed, patterns.string() +
                                                   ": projector_size is not rig.yaml's; make them "
                                                   "agree"};
        }
    } else if (is_there(list)) {
        c.kind = RecordingKind::depth;
    } else if (!is_there(folder / "joints.csv")) {
        return Error{ErrorCode::not_found, folder.string() +
                                               ": holds neither frames.csv nor joints.csv; give "
                                               "the folder of a recording"};
    }

    RecordingReader reader;
    if (c.kind == RecordingKind::joints) {
        reader.content_ = std::move(content);
        return reader;
    }
    const auto text = base::read_file(list, kMaxListBytes);
    if (!text) {
        return text.error();
    }
    auto entries = capture::parse_frame_list(*text, list.string(), c.patterns.patterns.size());
    if (!entries) {
        return entries.error();
    }
    if (auto ok = check_images_are_there(folder, *entries); !ok) {
        return ok.error();
    }
    c.entries = std::move(*entries);
    // Buffers are made for the images that are there, whatever rig.yaml claims.
    const fs::path first = folder / c.entries.front().file;
    const auto size = peek_size(first);
    if (!size) {
        return size.error();
    }
    c.image_size = *size;
    for (const RecordingEntry& entry : c.entries) {
        if (entry.clean_row_end > size->height) {
            return Error{ErrorCode::malformed, list.string() + ": clean_end of " + entry.file +
                                                   " is " + std::to_string(entry.clean_row_end) +
                                                   ", the images have " +
                                                   std::to_string(size->height) +
                                                   " rows; give one of them or leave it "
                                                   "empty"};
        }
    }
    if (c.has_rig && c.rig.camera.size != *size) {
        return Error{ErrorCode::malformed, (folder / "rig.yaml").string() + ": camera_size is " +
                                               text_of(c.rig.camera.size) + ", " +
                                               c.entries.front().file + " is " + text_of(*size) +
                                               " pixels; make them agree"};
    }
    reader.content_ = std::move(content);
    return reader;
}

RecordingKind RecordingReader::kind() const noexcept { return content_->kind; }
const fs::path& RecordingReader::folder() const noexcept { return content_->folder; }
bool RecordingReader::has_rig() const noexcept { return content_->has_rig; }
const Rig& RecordingReader::rig() const noexcept { return content_->rig; }
const PatternSequence& RecordingReader::patterns() const noexcept { return content_->patterns; }
double RecordingReader::depth_unit_mm() const noexcept { return content_->depth_unit_mm; }
std::span<const RecordingEntry> RecordingReader::entries() const noexcept {
    return content_->entries;
}
Size RecordingReader::image_size() const noexcept { return content_->image_size; }

Result<void> RecordingReader::read_frame(std::size_t index, Frame& out,
                                         ColourReading colours) const {
    const Content& c = *content_;
    if (c.kind != RecordingKind::fringe) {
        return unsupported(c.folder, "holds no fringes (no pattern.yaml); decode needs them");
    }
    const RecordingEntry& entry = c.entries[index];
    const fs::path file = c.folder / entry.file;
    const auto bytes = base::read_file(file, kMaxImageBytes);
    if (!bytes) {
        return bytes.error();
    }
    bool colour = entry.pattern == kUnknownPattern
                      ? c.any_colour
                      : c.patterns.patterns[static_cast<std::size_t>(entry.pattern)].kind ==
                            PatternKind::rgb_sine;
    if (colours == ColourReading::as_stored) {
        const auto info = capture::peek_image(*bytes, file.string());
        if (!info) {
            return info.error();
        }
        colour = info->channels > 2;  // two are grey and its opacity
    } else if (colour && entry.pattern != kUnknownPattern) {
        const auto info = capture::peek_image(*bytes, file.string());
        if (!info) {
            return info.error();
        }
        if (info->channels < 3) {
            return Error{ErrorCode::invalid_argument,
                         file.string() + ": is grey, but its pattern is told by its colours; " +
                             "record it in colour"};
        }
    }
    out.status = FrameStatus::ok;
    out.format = colour ? PixelFormat::bgr8 : PixelFormat::grey8;
    out.stamp = entry.stamp;
    out.sequence = entry.sequence;
    out.pattern = entry.pattern;
    out.clean_row_begin = entry.clean_row_begin;
    out.clean_row_end = entry.clean_row_end > 0 ? entry.clean_row_end : c.image_size.height;
    return capture::decode_image(*bytes, file.string(), c.image_size, out.format, out.pixels);
}

Result<void> RecordingReader::read_depth(std::size_t index, DepthFrame& out) const {
    const Content& c = *content_;
    if (c.kind != RecordingKind::depth) {
        return unsupported(c.folder, "holds no depth images; give a depth recording");
    }
    const RecordingEntry& entry = c.entries[index];
    const fs::path file = c.folder / entry.file;
    const auto bytes = base::read_file(file, kMaxImageBytes);
    if (!bytes) {
        return bytes.error();
    }
    out.stamp = entry.stamp;
    out.sequence = entry.sequence;
    out.depth_unit_mm = c.depth_unit_mm;
    out.metric = c.has_rig;
    out.quality.resize(0, 0);
    return capture::decode_depth(*bytes, file.string(), c.image_size, out.depth);
}

namespace {

// truth/<kind>/<name of the frame>.png, or the only file there: a scene that does not move.
std::optional<fs::path> truth_file(const fs::path& folder, const char* kind,
                                   const std::string& frame_file) {
    const fs::path below = folder / "truth" / kind;
    const fs::path same = below / fs::path(frame_file).filename().replace_extension(".png");
    if (is_there(same)) {
        return same;
    }
    std::error_code error;
    std::optional<fs::path> only;
    for (fs::directory_iterator it(below, error), end; !error && it != end; it.increment(error)) {
        if (it->path().extension() != ".png") {
            continue;
        }
        if (only) {
            return std::nullopt;
        }
        only = it->path();
    }
    return only;
}

}  // namespace

bool RecordingReader::has_truth_depth(std::size_t index) const {
    return truth_file(content_->folder, "depth", content_->entries[index].file).has_value();
}

bool RecordingReader::has_truth_mask(std::size_t index) const {
    return truth_file(content_->folder, "mask", content_->entries[index].file).has_value();
}

Result<void> RecordingReader::read_truth(const char* kind, std::size_t index,
                                         fs::path& file) const {
    const auto found = truth_file(content_->folder, kind, content_->entries[index].file);
    if (!found) {
        return Error{ErrorCode::not_found,
                     (content_->folder / "truth" / kind).string() + ": holds no image for " +
                         content_->entries[index].file + "; add one of the same name"};
    }
    file = *found;
    return {};
}

Result<void> RecordingReader::read_truth_depth(std::size_t index, DepthFrame& out) const {
    fs::path file;
    if (auto ok = read_truth("depth", index, file); !ok) {
        return ok;
    }
    const auto bytes = base::read_file(file, kMaxImageBytes);
    if (!bytes) {
        return bytes.error();
    }
    const RecordingEntry& entry = content_->entries[index];
    out.stamp = entry.stamp;
    out.sequence = entry.sequence;
    out.depth_unit_mm = kDepthUnitMm;
    out.metric = true;
    out.quality.resize(0, 0);
    return capture::decode_depth(*bytes, file.string(), content_->image_size, out.depth);
}

Result<void> RecordingReader::read_truth_mask(std::size_t index, Image<std::uint8_t>& out) const {
    fs::path file;
    if (auto ok = read_truth("mask", index, file); !ok) {
        return ok;
    }
    const auto bytes = base::read_file(file, kMaxImageBytes);
    if (!bytes) {
        return bytes.error();
    }
    return capture::decode_image(*bytes, file.string(), content_->image_size, PixelFormat::grey8,
                                 out);
}

std::optional<fs::path> RecordingReader::joints_file() const {
    return if_there(content_->folder / "joints.csv");
}
std::optional<fs::path> RecordingReader::labels_file() const {
    return if_there(content_->folder / "labels.csv");
}
std::optional<fs::path> RecordingReader::poses_file() const {
    return if_there(content_->folder / "poses.csv");
}
std::optional<fs::path> RecordingReader::truth_hands_file() const {
    return if_there(content_->folder / "truth" / "hands.csv");
}

}  // namespace xtrack
