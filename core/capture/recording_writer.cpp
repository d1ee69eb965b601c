// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include <xtrack/recording.hpp>

#include "core/base/file.hpp"
#include "core/capture/frame_list.hpp"
#include "core/capture/image_codec.hpp"
#include "core/capture/yaml_file.hpp"

namespace xtrack {

struct RecordingWriter::State {
    explicit State(base::NewFolder new_folder) : folder(std::move(new_folder)) {}

    base::NewFolder folder;
    bool fringe = false;
    int patterns = 0;
    double depth_unit_mm = kDepthUnitMm;
    Size size;  // of the rig's camera, else of the first image
    std::vector<RecordingEntry> entries;
    bool has_truth_depth = false;
    bool has_truth_mask = false;
};

namespace {

std::string image_name(std::size_t index) {
    char name[32];
    std::snprintf(name, sizeof name, "%06zu.png", index);
    return name;
}

constexpr const char* kFrameList = "frames.csv";

// An image that is listed is there whole, whenever the program ends.
Result<void> add_image(const base::NewFolder& folder, std::vector<RecordingEntry>& entries,
                       RecordingEntry entry, std::string_view png) {
    if (auto ok = folder.write(entry.file, png); !ok) {
        return ok;
    }
    const std::string head = entries.empty() ? capture::frame_list_head() : std::string();
    if (auto ok = folder.append(kFrameList, head + capture::frame_list_line(entry)); !ok) {
        return ok;
    }
    entries.push_back(std::move(entry));
    return {};
}

Error bad(const std::string& what) { return {ErrorCode::invalid_argument, what}; }

}  // namespace

RecordingWriter::RecordingWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
RecordingWriter::RecordingWriter(RecordingWriter&&) noexcept = default;
RecordingWriter& RecordingWriter::operator=(RecordingWriter&&) noexcept = default;
RecordingWriter::~RecordingWriter() = default;

Result<RecordingWriter> RecordingWriter::create(const std::filesystem::path& target,
                                                const Setup& setup) {
    if (setup.rig) {
        if (auto ok = validate(*setup.rig); !ok) {
            return ok.error();
        }
    }
    if (setup.patterns) {
        if (auto ok = validate(*setup.patterns); !ok) {
            return ok.error();
        }
        if (setup.rig && (!setup.rig->projector ||
                          setup.rig->projector->size != setup.patterns->projector_size)) {
            return bad("projector_size of the patterns is not the rig's; make them agree");
        }
    } else if (!capture::is_depth_unit(setup.depth_unit_mm)) {
        return bad("depth_unit_mm is not from 0.001 to 1000; give mm a step");
    } else if (!setup.rig && setup.depth_unit_mm != kDepthUnitMm) {
        // Without rig.yaml the unit would be lost, and every depth be read at another scale.
        return bad("depth_unit_mm is kept in rig.yaml; give the rig, or depth of 0.1 mm a step");
    }
    auto folder = base::NewFolder::create(target);
    if (!folder) {
        return folder.error();
    }
    auto state = std::make_unique<State>(std::move(*folder));
    state->fringe = setup.patterns.has_value();
    state->depth_unit_mm = setup.depth_unit_mm;
    if (setup.rig) {
        state->size = setup.rig->camera.size;
        capture::RigFile file{*setup.rig, std::nullopt};
        if (!state->fringe) {
            file.depth_unit_mm = setup.depth_unit_mm;
        }
        if (auto ok = state->folder.write("rig.yaml", capture::rig_text(file)); !ok) {
            return ok.error();
        }
    }
    if (setup.patterns) {
        state->patterns = static_cast<int>(setup.patterns->patterns.size());
        if (auto ok = state->folder.write("pattern.yaml", capture::patterns_text(*setup.patterns));
            !ok) {
            return ok.error();
        }
    }
    if (auto ok = state->folder.make_folder(state->fringe ? "frames" : "depth"); !ok) {
        return ok.error();
    }
    return RecordingWriter(std::move(state));
}

namespace {

Result<void> check_next(const std::vector<RecordingEntry>& entries, Size expected, Size size,
                        Stamp stamp) {
    if (!entries.empty() && stamp < entries.back().stamp) {
        return bad("stamp of frame " + std::to_string(entries.size()) +
                   " goes backwards; add frames in the order of time");
    }
    if (!is_image_size(size) || (expected != Size{} && size != expected)) {
        return bad("size of frame " + std::to_string(entries.size()) + " is " +
                   std::to_string(size.width) + "x" + std::to_string(size.height) +
                   "; give images of one size, the rig's camera_size, of at most " +
                   std::to_string(kMaxImageSide_px) + " pixels a side and 64 million in all");
    }
    return {};
}

}  // namespace

Result<void> RecordingWriter::add(const Frame& frame) {
    State& s = *state_;
    if (!s.fringe) {
        return bad("a recording without patterns holds depth; add a DepthFrame");
    }
    if (frame.pattern < kUnknownPattern || frame.pattern >= s.patterns) {
        return bad("pattern of frame " + std::to_string(s.entries.size()) + " is " +
                   std::to_string(frame.pattern) + "; give -1 (unknown) to " +
                   std::to_string(s.patterns - 1));
    }
    if (auto ok = check_next(s.entries, s.size, frame.size(), frame.stamp); !ok) {
        return ok;
    }
    const auto png = capture::encode_png(frame.pixels.view(), frame.format);
    if (!png) {
        return png.error();
    }
    const std::string file = "frames/" + image_name(s.entries.size());
    s.size = frame.size();
    RecordingEntry entry{file, frame.stamp, frame.sequence, frame.pattern};
    const bool all = frame.clean_row_begin <= 0 && frame.clean_row_end >= frame.height();
    if (!all && frame.clean_row_begin < frame.clean_row_end) {
        entry.clean_row_begin = std::max(frame.clean_row_begin, 0);
        entry.clean_row_end = std::min(frame.clean_row_end, frame.height());
    }
    return add_image(s.folder, s.entries, std::move(entry), *png);
}

Result<void> RecordingWriter::add(const DepthFrame& depth) {
    State& s = *state_;
    if (s.fringe) {
        return bad("a recording with patterns holds fringes; add a Frame");
    }
    if (depth.depth_unit_mm != s.depth_unit_mm) {
        return bad("depth_unit_mm of frame " + std::to_string(s.entries.size()) +
                   " is not the recording's; convert it");
    }
    if (auto ok = check_next(s.entries, s.size, depth.depth.size(), depth.stamp); !ok) {
        return ok;
    }
    const auto png = capture::encode_png(depth.depth.view());
    if (!png) {
        return png.error();
    }
    const std::string file = "depth/" + image_name(s.entries.size());
    s.size = depth.depth.size();
    return add_image(s.folder, s.entries, {file, depth.stamp, depth.sequence, kUnknownPattern},
                     *png);
}

Result<void> RecordingWriter::add_truth(ImageView<const std::uint16_t> depth,
                                        ImageView<const std::uint8_t> mask) {
    State& s = *state_;
    if (s.entries.empty()) {
        return bad("truth belongs to a frame; add the frame first");
    }
    const std::string name = image_name(s.entries.size() - 1);
    const auto write = [&](const std::string& folder, Size size, bool& made,
                           const Result<std::string>& png) -> Result<void> {
        if (size != s.size) {
            return bad("truth/" + folder + " of frame " + name +
                       " is of another size than the frame; give the frame's");
        }
        if (!png) {
            return png.error();
        }
        if (!made) {
            if (auto ok = s.folder.make_folder(std::filesystem::path("truth") / folder); !ok) {
                return ok;
            }
            made = true;
        }
        return s.folder.write(std::filesystem::path("truth") / folder / name, *png);
    };
    if (!depth.empty()) {
        if (auto ok = write("depth", depth.size(), s.has_truth_depth, capture::encode_png(depth));
            !ok) {
            return ok;
        }
    }
    if (!mask.empty()) {
        return write("mask", mask.size(), s.has_truth_mask,
                     capture::encode_png(mask, PixelFormat::grey8));
    }
    return {};
}

Result<void> RecordingWriter::add_text(const std::string& name, const std::string& text) {
    if (!base::stays_inside(name)) {
        return bad("name of a text file leaves the recording; give a relative one");
    }
    const std::filesystem::path inside(name);
    if (inside.has_parent_path()) {
        if (auto ok = state_->folder.make_folder(inside.parent_path()); !ok) {
            return ok;
        }
    }
    return state_->folder.write(inside, text);
}

const std::filesystem::path& RecordingWriter::folder() const noexcept {
    return state_->folder.path();
}

Result<void> RecordingWriter::close() {
    State& s = *state_;
    if (s.entries.empty()) {
        s.folder.discard();
        return bad("a recording holds at least one frame; add one before close()");
    }
    // What the reader would refuse is not written: its own judgement, so that they cannot differ.
    const std::string list = capture::frame_list_text(s.entries);
    const auto read_back =
        capture::parse_frame_list(list, kFrameList, static_cast<std::size_t>(s.patterns));
    if (!read_back) {
        s.folder.discard();
        return bad(read_back.error().message);
    }
    return s.folder.commit();
}

}  // namespace xtrack
