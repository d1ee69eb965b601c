// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include <xtrack/depth.hpp>
#include <xtrack/frame.hpp>
#include <xtrack/pattern.hpp>
#include <xtrack/rig.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// What a source has to say when asked for its next item.
/// @since 0.1
enum class SourceStatus {
    ok,       ///< an item
    timeout,  ///< none yet; ask again. Not a failure.
    end,      ///< the stream is over: a recording's last frame, a simulation's last second
    lost,     ///< the device went away; it may come back: ask again
    failed,   ///< broken for good; `message` says why
};

/// Camera images of projected fringes, from a device, a recording, the simulator, or nothing.
/// @thread one thread at a time
/// @since 0.1
class FrameSource {
 public:
    struct Item {
        SourceStatus status = SourceStatus::end;
        FramePtr frame;       ///< set when ok
        std::string message;  ///< set when lost or failed; names the device or file
    };

    FrameSource() = default;
    FrameSource(const FrameSource&) = delete;
    FrameSource& operator=(const FrameSource&) = delete;
    virtual ~FrameSource() = default;

    /// Without a calibration: no projector, and of the camera its size alone.
    [[nodiscard]] virtual const Rig& rig() const = 0;
    [[nodiscard]] virtual const PatternSequence& patterns() const = 0;
    /// Waits up to `timeout` for the next frame. Stamps never decrease.
    virtual Item next(Duration timeout) = 0;
    /// How long after its stamp a real camera hands a frame over: the rest of the exposure and of
    /// the readout. Whoever plays a source at its own pace waits so long. Zero where it is not
    /// known.
    [[nodiscard]] virtual Duration delivery_delay() const { return Duration::zero(); }
};

/// Depth images from any depth camera, a recording, or nothing.
/// @thread one thread at a time
/// @since 0.1
class DepthSource {
 public:
    DepthSource() = default;
    DepthSource(const DepthSource&) = delete;
    DepthSource& operator=(const DepthSource&) = delete;
    virtual ~DepthSource() = default;

    [[nodiscard]] virtual const Rig& rig() const = 0;
    /// Waits up to `timeout` and fills `depth` when the status is ok. Stamps never decrease.
    virtual SourceStatus next(Duration timeout, DepthFrame& depth, std::string& message) = 0;
};

}  // namespace xtrack
