// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <xtrack/source.hpp>

namespace xtrack {

/// A camera that is not there: its stream is over before the first frame. For tests, and for
/// programs that must run without a device.
/// @thread any
/// @since 0.1
[[nodiscard]] std::unique_ptr<FrameSource> null_frame_source(Rig rig = {},
                                                             PatternSequence patterns = {});

/// The same for depth.
/// @thread any
/// @since 0.1
[[nodiscard]] std::unique_ptr<DepthSource> null_depth_source(Rig rig = {});

}  // namespace xtrack
