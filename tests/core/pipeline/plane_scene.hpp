// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <xtrack/frame.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/rig.hpp>

namespace xtrack::test {

// A wall that faces the camera, and how the camera sees a pattern on it; no noise, no lenses.
inline Rig plane_rig(Size camera = {96, 64}) {
    Rig rig;
    rig.camera.matrix << 90.0, 0.0, 0.5 * camera.width, 0.0, 90.0, 0.5 * camera.height, 0.0, 0.0,
        1.0;
    rig.camera.size = camera;
    Pinhole projector;
    projector.matrix << 350.0, 0.0, 256.0, 0.0, 350.0, 192.0, 0.0, 0.0, 1.0;
    projector.size = {512, 384};
    rig.projector = projector;
    rig.projector_from_camera_T << 100.0, 0.0, 0.0;
    rig.working_volume = WorkingVolume{400.0, 1200.0};
    return rig;
}

inline double plane_coordinate(const Rig& rig, int u, double z_mm) {
    const double x = (u - rig.camera.matrix(0, 2)) / rig.camera.matrix(0, 0) * z_mm +
                     rig.projector_from_camera_T.x();
    return rig.projector->matrix(0, 0) * x / z_mm + rig.projector->matrix(0, 2);
}

inline std::shared_ptr<Frame> plane_frame(const Rig& rig, const PatternSequence& patterns,
                                          int pattern, int number, double z_mm,
                                          PixelFormat format = PixelFormat::grey8) {
    auto frame = std::make_shared<Frame>();
    frame->format = format;
    frame->stamp = Stamp::from_us(10000 * number);
    frame->sequence = static_cast<std::uint64_t>(number);
    frame->pattern = pattern;
    frame->clean_row_end = rig.camera.size.height;
    const int channels = frame->channels();
    frame->pixels.resize(rig.camera.size.width * channels, rig.camera.size.height);
    const Pattern& p = patterns.patterns[static_cast<std::size_t>(pattern)];
    for (int u = 0; u < rig.camera.size.width; ++u) {
        const double x = std::clamp(plane_coordinate(rig, u, z_mm), 0.0, 511.0);
        for (int c = 0; c < channels; ++c) {
            const double light = intensity(p, x, 2 - c);  // in bytes blue comes first
            const auto grey = static_cast<std::uint8_t>(std::lround(30.0 + 180.0 * light));
            for (int v = 0; v < rig.camera.size.height; ++v) {
                frame->pixels.at(u * channels + c, v) = grey;
            }
        }
    }
    return frame;
}

}  // namespace xtrack::test
