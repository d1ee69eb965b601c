// SPDX-License-Identifier: Apache-2.0
#include "core/capture/yaml_file.hpp"

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

#include "core/base/setting_up.hpp"
#include "core/capture/yaml_reader.hpp"
#include "core/pattern/response_curve.hpp"

namespace xtrack::capture {

namespace {

Error in_file(const std::string& name, const Error& error) {
    return {ErrorCode::malformed, name + ": " + error.message};
}

// Calls `read` on the file's top level; whatever OpenCV throws becomes an Error.
template <typename T, typename Read>
Result<T> with_storage(const std::string& text, const std::string& name, const Read& read) {
    if (auto ok = check_yaml_text(text, name); !ok) {
        return ok.error();
    }
    try {
        const cv::FileStorage storage(
            text, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
        if (storage.isOpened() && storage.root().isMap()) {
            return read(YamlMap(storage.root(), name));
        }
    } catch (const std::bad_alloc&) {
        return base::out_of_memory(name.c_str());
    } catch (const std::exception&) {
        // OpenCV's texts name its own source lines; the user needs to know the file.
    }
    return Error{ErrorCode::malformed, name +
                                           ": is not YAML as OpenCV writes it; save it with "
                                           "cv::FileStorage or mend its syntax"};
}

template <int kRows, int kCols, typename Matrix>
Result<void> read_matrix(const YamlMap& map, const char* key, Matrix& out) {
    const auto values = map.matrix(key, kRows, kCols);
    if (!values) {
        return values.error();
    }
    for (int row = 0; row < kRows; ++row) {
        for (int col = 0; col < kCols; ++col) {
            out(row, col) = (*values)[static_cast<std::size_t>(row * kCols + col)];
        }
    }
    return {};
}

Result<Pinhole> read_pinhole(const YamlMap& map, const std::string& who) {
    // OpenCV also knows four thin-prism and two tilt coefficients, which no rig of ours has.
    constexpr std::size_t kMaxCoefficients = 14;
    Pinhole pinhole;
    if (auto ok = read_matrix<3, 3>(map, (who + "_matrix").c_str(), pinhole.matrix); !ok) {
        return ok.error();
    }
    const std::string key = who + "_distortion";
    if (map.has(key.c_str())) {
        const auto values = map.numbers(key.c_str(), 0, kMaxCoefficients);
        if (!values) {
            return values.error();
        }
        for (std::size_t i = 0; i < values->size(); ++i) {
            if (i < pinhole.distortion.size()) {
                pinhole.distortion[i] = (*values)[i];
            } else if ((*values)[i] != 0.0) {
                return map.error(key.c_str(),
                                 "has thin-prism or tilt terms; calibrate with at "
                                 "most k1 k2 p1 p2 k3 k4 k5 k6");
            }
        }
    }
    const auto size = map.size((who + "_size").c_str());
    if (!size) {
        return size.error();
    }
    pinhole.size = *size;
    return pinhole;
}

Result<void> read_projector(const YamlMap& map, Rig& rig) {
    auto projector = read_pinhole(map, "projector");
    if (!projector) {
        return projector.error();
    }
    rig.projector = *projector;
    if (auto ok = read_matrix<3, 3>(map, "projector_from_camera_R", rig.projector_from_camera_R);
        !ok) {
        return ok;
    }
    return read_matrix<3, 1>(map, "projector_from_camera_T", rig.projector_from_camera_T);
}

Result<void> read_optional_fields(const YamlMap& map, RigFile& file) {
    Rig& rig = file.rig;
    if (map.has("interaction_from_camera")) {
        if (auto ok = read_matrix<4, 4>(map, "interaction_from_camera",
                                        rig.interaction_from_camera.emplace());
            !ok) {
            return ok;
        }
    }
    if (map.has("camera_from_projector_rgb")) {
        if (auto ok = read_matrix<3, 3>(map, "camera_from_projector_rgb",
                                        rig.camera_from_projector_rgb.emplace());
            !ok) {
            return ok;
        }
    }
    if (map.has("working_volume_mm")) {
        const auto ends = map.numbers("working_volume_mm", 2, 2);
        if (!ends) {
            return ends.error();
        }
        rig.working_volume = WorkingVolume{(*ends)[0], (*ends)[1]};
    }
    if (map.has("depth_unit_mm")) {
        const auto unit = map.number("depth_unit_mm");
        if (!unit) {
            return unit.error();
        }
        if (!is_depth_unit(*unit)) {
            return map.error("depth_unit_mm", "is not from 0.001 to 1000; give mm a step");
        }
        file.depth_unit_mm = *unit;
    }
    return {};
}

Result<void> read_phases(const YamlMap& map, Pattern& p) {
    if (p.kind == PatternKind::ramp) {
        return {};
    }
    if (p.kind == PatternKind::sine) {
        const auto phase = map.number("phase_rad");
        if (!phase) {
            return phase.error();
        }
        p.phase_rad[0] = *phase;
        return {};
    }
    const auto phases = map.numbers("phase_rad", 3, 3);
    if (!phases) {
        return phases.error();
    }
    std::copy(phases->begin(), phases->end(), p.phase_rad.begin());
    return {};
}

Result<void> read_gray_code(const YamlMap& map, Pattern& p) {
    const auto bit = map.integer("bit");
    if (!bit) {
        return bit.error();
    }
    const auto bits = map.integer("bits");
    if (!bits) {
        return bits.error();
    }
    const auto cell = map.number("cell_px");
    if (!cell) {
        return cell.error();
    }
    p.bit = *bit;
    p.bits = *bits;
    p.cell_px = *cell;
    if (map.has("offset_px")) {
        const auto offset = map.number("offset_px");
        if (!offset) {
            return offset.error();
        }
        p.offset_px = *offset;
    }
    if (map.has("inverted")) {
        const auto inverted = map.flag("inverted");
        if (!inverted) {
            return inverted.error();
        }
        p.inverted = *inverted;
    }
    return {};
}

Result<Pattern> read_pattern(const YamlMap& map) {
    const auto kind = map.word("kind");
    if (!kind) {
        return kind.error();
    }
    Pattern p;
    if (*kind == "flat") {
        p.kind = PatternKind::flat;
        const auto level = map.number("level");
        if (!level) {
            return level.error();
        }
        p.level = *level;
        return p;
    }
    if (*kind == "gray_code") {
        p.kind = PatternKind::gray_code;
        if (auto ok = read_gray_code(map, p); !ok) {
            return ok.error();
        }
        return p;
    }
    if (*kind != "sine" && *kind != "rgb_sine" && *kind != "ramp") {
        return map.error("kind",
                         "is none that is known; use sine, rgb_sine, gray_code, ramp or flat");
    }
    p.kind = *kind == "sine"       ? PatternKind::sine
             : *kind == "rgb_sine" ? PatternKind::rgb_sine
                                   : PatternKind::ramp;
    const auto period = map.number("period_px");
    if (!period) {
        return period.error();
    }
    p.period_px = *period;
    if (auto ok = read_phases(map, p); !ok) {
        return ok.error();
    }
    return p;
}

Result<RigFile> read_rig(const YamlMap& map) {
    RigFile file;
    auto camera = read_pinhole(map, "camera");
    if (!camera) {
        return camera.error();
    }
    file.rig.camera = *camera;
    // Any field of the projector calls for all of them: half a projector is a torn file.
    for (const char* key : {"projector_matrix", "projector_size", "projector_distortion",
                            "projector_from_camera_R", "projector_from_camera_T"}) {
        if (map.has(key)) {
            if (auto ok = read_projector(map, file.rig); !ok) {
                return ok.error();
            }
            break;
        }
    }
    if (auto ok = read_optional_fields(map, file); !ok) {
        return ok.error();
    }
    return file;
}

// One colour calls for all of them.
Result<void> read_response(const YamlMap& map, PatternSequence& s) {
    if (std::none_of(kResponseFields.begin(), kResponseFields.end(),
                     [&](const char* key) { return map.has(key); })) {
        return {};
    }
    ProjectorResponse& response = s.response.emplace();
    for (std::size_t c = 0; c < kResponseFields.size(); ++c) {
        auto light = map.numbers(kResponseFields[c], kMinResponseSteps, kMaxResponseSteps);
        if (!light) {
            return light.error();
        }
        response.light[c] = *std::move(light);
    }
    return {};
}

Result<PatternSequence> read_patterns(const YamlMap& map) {
    PatternSequence s;
    const auto axis = map.word("axis");
    if (!axis) {
        return axis.error();
    }
    if (*axis != "x" && *axis != "y") {
        return map.error("axis", "is neither x nor y; give the projector axis that is coded");
    }
    s.axis = *axis == "x" ? Axis::x : Axis::y;
    const auto size = map.size("projector_size");
    if (!size) {
        return size.error();
    }
    s.projector_size = *size;
    if (map.has("gamma")) {
        const auto gamma = map.number("gamma");
        if (!gamma) {
            return gamma.error();
        }
        s.gamma = *gamma;
    }
    if (auto ok = read_response(map, s); !ok) {
        return ok.error();
    }
    const auto entries = map.maps("sequence", kMaxPatterns);
    if (!entries) {
        return entries.error();
    }
    for (const YamlMap& entry : *entries) {
        auto pattern = read_pattern(entry);
        if (!pattern) {
            return pattern.error();
        }
        s.patterns.push_back(*pattern);
    }
    return s;
}

}  // namespace

Result<RigFile> parse_rig(const std::string& text, const std::string& name) {
    auto file = with_storage<RigFile>(text, name, read_rig);
    if (file) {
        if (auto ok = validate(file->rig); !ok) {
            return in_file(name, ok.error());
        }
    }
    return file;
}

Result<PatternSequence> parse_patterns(const std::string& text, const std::string& name) {
    auto sequence = with_storage<PatternSequence>(text, name, read_patterns);
    if (sequence) {
        if (auto ok = validate(*sequence); !ok) {
            return in_file(name, ok.error());
        }
    }
    return sequence;
}

}  // namespace xtrack::capture
