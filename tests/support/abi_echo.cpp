// SPDX-License-Identifier: Apache-2.0
#include "tests/support/abi_echo.hpp"

#include <utility>

namespace xtrack::abi {

namespace {

template <typename T>
void grow(Image<T>& image) {
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            image.at(x, y) = static_cast<T>(image.at(x, y) + T{1});
        }
    }
}

template <typename Matrix>
void grow_matrix(Matrix& m) {
    m.array() += typename Matrix::Scalar{1};
}

void grow_pinhole(Pinhole& p) {
    grow_matrix(p.matrix);
    for (double& k : p.distortion) {
        k += 1.0;
    }
    ++p.size.width;
    ++p.size.height;
}

void grow_point(TrackedPoint& p) {
    grow_matrix(p.position_mm);
    p.valid = !p.valid;
}

}  // namespace

template <typename T>
Layout layout_in_library() {
    return {sizeof(T), alignof(T)};
}

template Layout layout_in_library<Stamp>();
template Layout layout_in_library<Result<Stamp>>();
template Layout layout_in_library<Frame>();
template Layout layout_in_library<Pattern>();
template Layout layout_in_library<PatternSequence>();
template Layout layout_in_library<Rig>();
template Layout layout_in_library<PhaseMap>();
template Layout layout_in_library<DepthFrame>();
template Layout layout_in_library<PointCloud>();
template Layout layout_in_library<Hand>();
template Layout layout_in_library<HandFrame>();
template Layout layout_in_library<GestureEvent>();

Stamp echo(Stamp value) { return {value.ns + 1}; }

Result<Stamp> echo(Result<Stamp> value) {
    if (value.ok()) {
        return echo(*value);
    }
    return Error{value.error().code, value.error().message + "!"};
}

Frame echo(Frame value) {
    value.status = FrameStatus::damaged;
    value.format = PixelFormat::bgr8;
    value.stamp = echo(value.stamp);
    ++value.sequence;
    ++value.pattern;
    ++value.clean_row_begin;
    ++value.clean_row_end;
    grow(value.pixels);
    return value;
}

Pattern echo(Pattern value) {
    value.kind = PatternKind::gray_code;
    value.period_px += 1.0;
    for (double& phase : value.phase_rad) {
        phase += 1.0;
    }
    ++value.bit;
    ++value.bits;
    value.cell_px += 1.0;
    value.offset_px += 1.0;
    value.inverted = !value.inverted;
    value.level += 1.0;
    return value;
}

PatternSequence echo(PatternSequence value) {
    value.axis = Axis::y;
    ++value.projector_size.width;
    ++value.projector_size.height;
    value.gamma = value.gamma.value_or(0.0) + 1.0;
    if (value.response) {
        for (std::vector<double>& light : value.response->light) {
            for (double& step : light) {
                step += 1.0;
            }
        }
    }
    for (Pattern& pattern : value.patterns) {
        pattern = echo(pattern);
    }
    return value;
}

Rig echo(Rig value) {
    grow_pinhole(value.camera);
    if (value.projector) {
        grow_pinhole(*value.projector);
    }
    grow_matrix(value.projector_from_camera_R);
    grow_matrix(value.projector_from_camera_T);
    if (value.interaction_from_camera) {
        grow_matrix(*value.interaction_from_camera);
    }
    if (value.working_volume) {
        value.working_volume->near_mm += 1.0;
        value.working_volume->far_mm += 1.0;
    }
    if (value.camera_from_projector_rgb) {
        grow_matrix(*value.camera_from_projector_rgb);
    }
    return value;
}

PhaseMap echo(PhaseMap value) {
    value.stamp = echo(value.stamp);
    value.period_px += 1.0;
    grow(value.phase_rad);
    grow(value.modulation);
    return value;
}

DepthFrame echo(DepthFrame value) {
    value.stamp = echo(value.stamp);
    ++value.sequence;
    value.span += Duration{1};
    value.depth_unit_mm += 1.0;
    value.metric = !value.metric;
    grow(value.depth);
    grow(value.quality);
    return value;
}

PointCloud echo(PointCloud value) {
    value.metric = !value.metric;
    for (Vec3f& point : value.points_mm) {
        grow_matrix(point);
    }
    for (auto& colour : value.colours_rgb) {
        for (std::uint8_t& channel : colour) {
            ++channel;
        }
    }
    // The caller frees what the library allocated.
    value.points_mm.push_back(Vec3f::Constant(9.0F));
    value.colours_rgb.push_back({9, 9, 9});
    return value;
}

Hand echo(Hand value) {
    ++value.id;
    value.chirality = Chirality::right;
    value.chirality_confidence += 1.0F;
    value.confidence += 1.0F;
    value.touches_border = !value.touches_border;
    grow_matrix(value.palm_mm);
    value.palm_radius_mm += 1.0F;
    grow_matrix(value.palm_normal);
    grow_matrix(value.palm_velocity_mmps);
    for (TrackedPoint& tip : value.fingertips) {
        grow_point(tip);
    }
    for (float& extension : value.finger_extension) {
        extension += 1.0F;
    }
    ++value.extended_fingers;
    value.pinch_aperture_mm += 1.0F;
    value.pinch_value += 1.0F;
    value.grab_value += 1.0F;
    for (TrackedPoint& joint : value.joints) {
        grow_point(joint);
    }
    return value;
}

HandFrame echo(HandFrame value) {
    value.stamp = echo(value.stamp);
    value.span += Duration{1};
    value.coordinates = CoordinateFrame::interaction;
    for (Hand& hand : value.hands) {
        hand = echo(hand);
    }
    ++value.count;
    return value;
}

GestureEvent echo(GestureEvent value) {
    value.type = GestureType::pinch;
    value.direction = Direction::down;
    value.phase = EventPhase::cancel;
    value.cancel_reason = CancelReason::edge;
    ++value.gesture_id;
    ++value.hand_id;
    value.hand = Chirality::right;
    value.hand_confidence += 1.0F;
    value.onset = echo(value.onset);
    value.sensor = echo(value.sensor);
    value.emit = echo(value.emit);
    grow_matrix(value.position_mm);
    grow_matrix(value.velocity_mmps);
    value.progress += 1.0F;
    value.value += 1.0F;
    value.confidence += 1.0F;
    value.metric = !value.metric;
    return value;
}

}  // namespace xtrack::abi
