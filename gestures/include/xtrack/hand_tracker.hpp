// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <xtrack/depth.hpp>
#include <xtrack/hand.hpp>
#include <xtrack/hand_region.hpp>
#include <xtrack/result.hpp>
#include <xtrack/rig.hpp>
#include <xtrack/tracker_settings.hpp>

namespace xtrack {

/// What became of the last depth image.
/// @since 0.1
enum class TrackStatus {
    ok,
    repeated_stamp,    ///< the same stamp again: skipped, the hands are those of the frame before
    decreasing_stamp,  ///< an error of the caller's: skipped, nothing changed
    wrong_size,        ///< not the size given to create(): skipped
    not_metric,        ///< relative depth has no millimetres: skipped
};

/// For logs. Static storage. @thread any
/// @since 0.1
[[nodiscard]] const char* to_string(TrackStatus s) noexcept;

/// Finds up to two hands in depth images and follows them: stable ids, palm, fingertips, pinch and
/// grab, in the camera frame, mm. Learns the background while it runs; works from the first frame
/// on. It is told the time by the images' stamps and allocates nothing after create().
/// @thread one thread at a time
/// @since 0.1
class HandTracker {
 public:
    /// @param rig camera intrinsics and distortion are used; `rig.camera.size`, where set and
    ///        different from `size`, scales them
    /// @param size of the depth images, px; from 80 x 60 to 1920 x 1200
    /// @errors invalid_argument: a size or a setting out of range, a rig that validate() refuses;
    ///         io: memory runs out
    [[nodiscard]] static Result<HandTracker> create(const Rig& rig, Size size,
                                                    const TrackerSettings& settings = {});

    HandTracker(HandTracker&&) noexcept;
    HandTracker& operator=(HandTracker&&) noexcept;
    ~HandTracker();

    /// Takes the next depth image.
    /// @return the hands at its stamp, camera frame. A hand that is not seen in this image is not
    ///         in the list; its id waits for TrackerSettings::reacquire_time.
    /// @ownership borrowed until the next call
    const HandFrame& track(const DepthFrame& depth);

    [[nodiscard]] TrackStatus status() const noexcept;

    /// The hands of the last image again. @ownership borrowed until the next track()
    [[nodiscard]] const HandFrame& hands() const noexcept;

    /// The regions behind hands(): region i belongs to hand i. For pictures.
    /// @ownership borrowed until the next track()
    [[nodiscard]] HandSegmentation segmentation() const noexcept;

    /// Forgets hands, background and time: for the next stream. Ids go on counting.
    void reset() noexcept;

 private:
    struct State;
    explicit HandTracker(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

}  // namespace xtrack
