// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include <xtrack/pattern.hpp>

namespace xtrack {

namespace {

// Rounds the period up past what lens distortion and calibration error can add.
constexpr double kPeriodMargin = 1.02;
// x(u, v) is a smooth ratio of planes: its extremes over the image are met on a coarse grid.
constexpr int kGridSteps = 16;
// An axis along which the whole volume moves less than this measures no depth.
constexpr double kMinParallax_px = 2.0;

// Written so that the first phase is 0 and not -0.
double step_phase_rad(int step, int steps) { return 0.0 - 2.0 * std::numbers::pi * step / steps; }

void append_steps(PatternSequence& s, double period_px, int steps) {
    for (int i = 0; i < steps; ++i) {
        Pattern p;
        p.kind = PatternKind::sine;
        p.period_px = period_px;
        p.phase_rad[0] = step_phase_rad(i, steps);
        s.patterns.push_back(p);
    }
}

PatternSequence empty_sequence(Axis axis, Size projector_size) {
    PatternSequence s;
    s.axis = axis;
    s.projector_size = projector_size;
    return s;
}

int bits_for(double cells) {
    int bits = 1;
    while (std::ldexp(1.0, bits) < cells && bits < kMaxGrayBits) {
        ++bits;
    }
    return bits;
}

}  // namespace

PatternSequence n_step_sequence(Axis axis, Size projector_size, double period_px, int steps) {
    PatternSequence s = empty_sequence(axis, projector_size);
    append_steps(s, period_px, steps);
    return s;
}

PatternSequence three_step_sequence(Axis axis, Size projector_size, double period_px) {
    return n_step_sequence(axis, projector_size, period_px, 3);
}

PatternSequence dual_sequence(Axis axis, Size projector_size, double coarse_period_px,
                              double fine_period_px) {
    PatternSequence s = three_step_sequence(axis, projector_size, coarse_period_px);
    append_steps(s, fine_period_px, 3);
    return s;
}

PatternSequence gray_code_sequence(Axis axis, Size projector_size, double period_px) {
    PatternSequence s = empty_sequence(axis, projector_size);
    for (const double level : {1.0, 0.0}) {
        Pattern flat;
        flat.level = level;
        s.patterns.push_back(flat);
    }
    const int bits = bits_for(std::ceil(s.coded_length_px() / period_px));
    for (int bit = 0; bit < bits; ++bit) {
        Pattern p;
        p.kind = PatternKind::gray_code;
        p.bit = bit;
        p.bits = bits;
        p.cell_px = period_px;
        s.patterns.push_back(p);
    }
    append_steps(s, period_px, 3);
    return s;
}

PatternSequence rgb_sequence(Axis axis, Size projector_size,
                             const std::vector<double>& periods_px) {
    PatternSequence s = empty_sequence(axis, projector_size);
    for (const double period_px : periods_px) {
        Pattern p;
        p.kind = PatternKind::rgb_sine;
        p.period_px = period_px;
        for (int i = 0; i < 3; ++i) {
            p.phase_rad[static_cast<std::size_t>(i)] = step_phase_rad(i, 3);
        }
        s.patterns.push_back(p);
    }
    return s;
}

Result<double> volume_wide_period_px(const Rig& rig, Axis axis) {
    if (auto ok = validate(rig); !ok) {
        return ok.error();
    }
    if (!rig.projector || !rig.working_volume) {
        return Error{ErrorCode::invalid_argument,
                     std::string(rig.projector ? "working_volume_mm" : "projector_matrix") +
                         " is missing; a volume-wide period needs both"};
    }
    const Mat3d ray_from_pixel = rig.camera.matrix.inverse();
    const int coded = axis == Axis::x ? 0 : 1;
    double widest_px = 0.0;
    for (int i = 0; i <= kGridSteps; ++i) {
        for (int j = 0; j <= kGridSteps; ++j) {
            const Vec3d pixel((rig.camera.size.width - 1.0) * i / kGridSteps,
                              (rig.camera.size.height - 1.0) * j / kGridSteps, 1.0);
            double x_px[2] = {};
            for (const int end : {0, 1}) {
                const double z =
                    end == 0 ? rig.working_volume->near_mm : rig.working_volume->far_mm;
                const Vec3d point = ray_from_pixel * pixel * z;
                const Vec3d seen = rig.projector->matrix * (rig.projector_from_camera_R * point +
                                                            rig.projector_from_camera_T);
                if (!(seen.z() > 0.0)) {
                    return Error{ErrorCode::invalid_argument,
                                 "working_volume_mm reaches behind the projector; raise its near "
                                 "end"};
                }
                x_px[end] = seen[coded] / seen.z();
            }
            widest_px = std::max(widest_px, std::abs(x_px[0] - x_px[1]));
        }
    }
    if (widest_px < kMinParallax_px) {
        return Error{ErrorCode::invalid_argument,
                     "projector_from_camera_T has no part along this axis; code the other one"};
    }
    return std::ceil(widest_px * kPeriodMargin);
}

}  // namespace xtrack
