// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>

#include <xtrack/frame.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/rig.hpp>

namespace xtrack::test {

/// A wall that faces the camera and a plate before it, which hides part of the wall from the camera
/// and shades another from the projector. No lenses.
struct StepScene {
    static constexpr Size kCamera{320, 240};
    double wall_mm = 900.0;
    double plate_mm = 600.0;  ///< 0: none
    double plate_left_mm = -40.0;
    double plate_right_mm = 60.0;
    double plate_top_mm = -60.0;
    double plate_bottom_mm = 60.0;
    double noise_grey = 1.0;
    double contrast_grey = 180.0;

    [[nodiscard]] static Rig rig() {
        Rig rig;
        rig.camera.matrix << 300.0, 0.0, 159.5, 0.0, 300.0, 119.5, 0.0, 0.0, 1.0;
        rig.camera.size = kCamera;
        Pinhole projector;
        projector.matrix << 1000.0, 0.0, 420.0, 0.0, 1000.0, 384.0, 0.0, 0.0, 1.0;
        projector.size = {1280, 768};
        rig.projector = projector;
        rig.projector_from_camera_T << 150.0, 0.0, 0.0;
        rig.working_volume = WorkingVolume{400.0, 1000.0};
        return rig;
    }

    [[nodiscard]] bool on_plate(double x_mm, double y_mm) const {
        return plate_mm > 0.0 && x_mm >= plate_left_mm && x_mm <= plate_right_mm &&
               y_mm >= plate_top_mm && y_mm <= plate_bottom_mm;
    }
    /// Depth that pixel (u, v) sees, mm.
    [[nodiscard]] double depth_mm(int u, int v) const {
        const double x = (u - 159.5) / 300.0;
        const double y = (v - 119.5) / 300.0;
        return on_plate(x * plate_mm, y * plate_mm) ? plate_mm : wall_mm;
    }
    /// Projector px of that point.
    [[nodiscard]] double coordinate_px(int u, int v) const {
        const double z = depth_mm(u, v);
        return 1000.0 * ((u - 159.5) / 300.0 + 150.0 / z) + 420.0;
    }
    [[nodiscard]] bool shaded(int u, int v) const {
        if (plate_mm <= 0.0 || depth_mm(u, v) == plate_mm) {
            return false;
        }
        // Where the ray from the projector to the wall passes the plate.
        const double share = plate_mm / wall_mm;
        const double x_mm = (u - 159.5) / 300.0 * wall_mm + 150.0;
        const double y_mm = (v - 119.5) / 300.0 * wall_mm;
        return on_plate(share * x_mm - 150.0, share * y_mm);
    }

    [[nodiscard]] std::shared_ptr<Frame> frame(const PatternSequence& patterns, int pattern,
                                               int number) const {
        auto frame = std::make_shared<Frame>();
        frame->stamp = Stamp::from_us(16667 * number);
        frame->sequence = static_cast<std::uint64_t>(number);
        frame->pattern = pattern;
        frame->clean_row_end = kCamera.height;
        frame->pixels.resize(kCamera.width, kCamera.height);
        std::mt19937 random(static_cast<unsigned>(number + 1));
        const Pattern& p = patterns.patterns[static_cast<std::size_t>(pattern)];
        for (int v = 0; v < kCamera.height; ++v) {
            for (int u = 0; u < kCamera.width; ++u) {
                const double lit = shaded(u, v) ? 0.0 : intensity(p, coordinate_px(u, v));
                // Uniform, of this standard deviation.
                const double noise =
                    noise_grey * 1.732 * (2.0 * static_cast<double>(random()) / 4294967295.0 - 1.0);
                const double grey = 30.0 + contrast_grey * lit + noise;
                frame->pixels.at(u, v) =
                    static_cast<std::uint8_t>(std::lround(std::clamp(grey, 0.0, 255.0)));
            }
        }
        return frame;
    }
};

}  // namespace xtrack::test
