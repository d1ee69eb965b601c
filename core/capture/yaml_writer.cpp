// SPDX-License-Identifier: Apache-2.0
#include "core/base/text.hpp"
#include "core/capture/yaml_file.hpp"
#include "core/pattern/response_curve.hpp"

namespace xtrack::capture {

namespace {

constexpr const char* kHead = "%YAML:1.0\n---\n";

// OpenCV tells whole numbers from real ones by the point.
std::string real_text(double v) {
    std::string text = base::number_text(v);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

template <typename Matrix>
std::string matrix_text(const char* key, const Matrix& m) {
    std::string data;
    for (Eigen::Index row = 0; row < m.rows(); ++row) {
        for (Eigen::Index col = 0; col < m.cols(); ++col) {
            data += (data.empty() ? " " : ", ") + real_text(m(row, col));
        }
    }
    return std::string(key) + ": !!opencv-matrix\n   rows: " + std::to_string(m.rows()) +
           "\n   cols: " + std::to_string(m.cols()) + "\n   dt: d\n   data: [" + data + " ]\n";
}

std::string size_text(const std::string& key, Size s) {
    return key + ": [ " + std::to_string(s.width) + ", " + std::to_string(s.height) + " ]\n";
}

std::string pinhole_text(const std::string& who, const Pinhole& p) {
    const Eigen::Map<const Eigen::Matrix<double, 1, 8>> distortion(p.distortion.data());
    return matrix_text((who + "_matrix").c_str(), p.matrix) +
           matrix_text((who + "_distortion").c_str(), distortion) +
           size_text(who + "_size", p.size);
}

std::string pattern_text(const Pattern& p) {
    switch (p.kind) {
        case PatternKind::sine:
            return "kind: sine, period_px: " + real_text(p.period_px) +
                   ", phase_rad: " + real_text(p.phase_rad[0]);
        case PatternKind::rgb_sine:
            return "kind: rgb_sine, period_px: " + real_text(p.period_px) + ", phase_rad: [ " +
                   real_text(p.phase_rad[0]) + ", " + real_text(p.phase_rad[1]) + ", " +
                   real_text(p.phase_rad[2]) + " ]";
        case PatternKind::gray_code:
            return "kind: gray_code, bit: " + std::to_string(p.bit) +
                   ", bits: " + std::to_string(p.bits) + ", cell_px: " + real_text(p.cell_px) +
                   ", offset_px: " + real_text(p.offset_px) +
                   ", inverted: " + (p.inverted ? "1" : "0");
        case PatternKind::ramp: return "kind: ramp, period_px: " + real_text(p.period_px);
        case PatternKind::flat: break;
    }
    return "kind: flat, level: " + real_text(p.level);
}

}  // namespace

std::string rig_text(const RigFile& file) {
    const Rig& rig = file.rig;
    std::string text = kHead + pinhole_text("camera", rig.camera);
    if (rig.projector) {
        text += pinhole_text("projector", *rig.projector);
        text += matrix_text("projector_from_camera_R", rig.projector_from_camera_R);
        text += matrix_text("projector_from_camera_T", rig.projector_from_camera_T);
    }
    if (rig.interaction_from_camera) {
        text += matrix_text("interaction_from_camera", *rig.interaction_from_camera);
    }
    if (rig.working_volume) {
        text += "working_volume_mm: [ " + real_text(rig.working_volume->near_mm) + ", " +
                real_text(rig.working_volume->far_mm) + " ]\n";
    }
    if (rig.camera_from_projector_rgb) {
        text += matrix_text("camera_from_projector_rgb", *rig.camera_from_projector_rgb);
    }
    if (file.depth_unit_mm) {
        text += "depth_unit_mm: " + real_text(*file.depth_unit_mm) + "\n";
    }
    return text;
}

std::string patterns_text(const PatternSequence& s) {
    std::string text = kHead;
    text += std::string("axis: ") + (s.axis == Axis::x ? "x" : "y") + "\n";
    text += size_text("projector_size", s.projector_size);
    if (s.gamma) {
        text += "gamma: " + real_text(*s.gamma) + "\n";
    }
    if (s.response) {
        for (std::size_t c = 0; c < kResponseFields.size(); ++c) {
            std::string list;
            for (const double light : s.response->light[c]) {
                list += (list.empty() ? " " : ", ") + real_text(light);
            }
            text += std::string(kResponseFields[c]) + ": [" + list + " ]\n";
        }
    }
    text += "sequence:\n";
    for (const Pattern& p : s.patterns) {
        text += "   - { " + pattern_text(p) + " }\n";
    }
    return text;
}

}  // namespace xtrack::capture
