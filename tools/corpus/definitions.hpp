// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tools/corpus/movement.hpp"

// When a movement becomes a gesture, by the definitions of docs/gestures and nothing else: asked of
// the movement as it was meant, which has no noise. They know no recogniser. Each looks from
// `start_s` to `end_s` and gives the first moment, s, or nothing where the movement never gets
// there. Vectors are of the camera frame.
namespace xtrack::tools::corpus::definitions {

using Moment = std::optional<double>;

/// 100 mm at a mean of 300 mm/s, from where it has 200 mm/s on; no farther aside than 30 mm and a
/// fifth of its length. @param along unit
[[nodiscard]] Moment stroke(const Movement& m, const Vec3f& along, double start_s, double end_s);
/// 330 mm/s over 240 ms within 30 degrees of `along`.
[[nodiscard]] Moment thrust(const Movement& m, const Vec3f& along, double start_s, double end_s);
/// Thumb to index 20 mm (or 0.11 of the hand's length) for 50 ms.
[[nodiscard]] Moment pinch(const Movement& m, double start_s, double end_s);
/// Fingers folded to 0.8 of a fist.
[[nodiscard]] Moment grab(const Movement& m, double start_s, double end_s);
/// The index finger bends by 30 degrees at 180 degrees a second.
[[nodiscard]] Moment tap(const Movement& m, double start_s, double end_s);
/// 1.5 pi round a centre.
[[nodiscard]] Moment circle(const Movement& m, const Vec3f& centre, double start_s, double end_s);
/// 150 mm up, then still for 200 ms.
[[nodiscard]] Moment raise(const Movement& m, double start_s, double end_s);
/// Within 5 mm for 500 ms.
[[nodiscard]] Moment dwell(const Movement& m, double start_s, double end_s);
/// A force that 42 mm toward the screen at 150 mm/s fill, or 8 mm at 500 mm/s.
[[nodiscard]] Moment press(const Movement& m, double start_s, double end_s);
/// Nearer to the plane than 50 mm. @param plane_mm camera Z
[[nodiscard]] Moment touch(const Movement& m, double plane_mm, double start_s, double end_s);
/// 30 mm from where it was at start_s (`grabbed`: 10 mm).
[[nodiscard]] Moment drag(const Movement& m, bool grabbed, double start_s, double end_s);
/// 0.8 of the way to a shape, for 500 ms, slower than 100 mm/s.
[[nodiscard]] Moment pose(const Movement& m, const sim::FingerAngles& shape,
                          const sim::FingerAngles& from, double start_s, double end_s);
/// The distance of two hands that hold on since start_s changes by 20 mm.
[[nodiscard]] Moment zoom(const Movement& a, const Movement& b, double start_s, double end_s);
/// The line between them turns by 10 degrees.
[[nodiscard]] Moment rotate(const Movement& a, const Movement& b, double start_s, double end_s);

/// Whether the half second before `t_s` fulfils the plain definition of a swipe, push, pull, pinch
/// or grab; of other names nothing is said.
[[nodiscard]] bool fulfilled_before(const Movement& m, const std::string& gesture, double t_s);

}  // namespace xtrack::tools::corpus::definitions
