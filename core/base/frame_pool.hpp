// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include <xtrack/frame.hpp>

namespace xtrack::base {

/// Lends frames and takes them back when their last holder lets go. After the constructor nothing
/// is allocated: pixels, Frame and the shared pointer's control block are all used again (as long
/// as no weak_ptr outlives its frame). Frames may outlive the pool.
///
/// Bound: `capacity` frames. It never waits: acquire() gives null when all are lent, and the caller
/// says what happens then (our sources make a frame of its own: callers may keep what they get).
/// @thread any thread may acquire and release
class FramePool {
 public:
    /// @param capacity frames of `size` and `format` that exist, 1 or more
    FramePool(std::size_t capacity, Size size, PixelFormat format);
    FramePool(const FramePool&) = delete;
    FramePool& operator=(const FramePool&) = delete;
    ~FramePool();

    /// A frame to fill: pixels sized and holding what they held, all other fields at their
    /// defaults. Publish it as FramePtr. Null when all are lent.
    [[nodiscard]] std::shared_ptr<Frame> acquire() noexcept;

    /// Frames that can be had right now.
    [[nodiscard]] std::size_t available() const noexcept;

 private:
    struct State;
    struct GiveBack;
    template <typename T>
    struct BlockAllocator;

    std::shared_ptr<State> state_;
};

}  // namespace xtrack::base
