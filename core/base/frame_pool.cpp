// SPDX-License-Identifier: Apache-2.0
#include "core/base/frame_pool.hpp"

#include <new>
#include <utility>
#include <vector>

#include "core/base/mutex.hpp"

namespace xtrack::base {

namespace {

// A releasing thread hands back the frame a moment before its control block; the frame may be lent
// again in between. One block a thread that releases at the same time covers that.
constexpr std::size_t kSpareBlocks = 8;

}  // namespace

// Shared by the pool and every lent frame, so that frames may outlive the pool.
struct FramePool::State {
    State(std::size_t capacity, Size frame_size, PixelFormat frame_format)
        : size(frame_size), format(frame_format), frames(capacity) {
        free_frames.reserve(capacity);
        free_blocks.reserve(capacity + kSpareBlocks);
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        for (void* block : free_blocks) {
            ::operator delete(block);
        }
    }

    [[nodiscard]] void* take_block(std::size_t bytes) {
        {
            const MutexLock lock(mutex);
            if (bytes == block_bytes && !free_blocks.empty()) {
                void* block = free_blocks.back();
                free_blocks.pop_back();
                return block;
            }
        }
        return ::operator new(bytes);
    }
    [[nodiscard]] std::size_t block_size() const {
        const MutexLock lock(mutex);
        return block_bytes;
    }
    void give_block(void* block, std::size_t bytes) noexcept {
        {
            const MutexLock lock(mutex);
            if (block_bytes == 0) {
                block_bytes = bytes;  // the first control block says how big they are
            }
            if (bytes == block_bytes && free_blocks.size() < free_blocks.capacity()) {
                free_blocks.push_back(block);
                return;
            }
        }
        ::operator delete(block);
    }

    const Size size;
    const PixelFormat format;
    mutable Mutex mutex;
    std::vector<Frame> frames;  // never resized: lent pointers point into it
    std::vector<Frame*> free_frames XTRACK_GUARDED_BY(mutex);
    std::vector<void*> free_blocks XTRACK_GUARDED_BY(mutex);
    std::size_t block_bytes XTRACK_GUARDED_BY(mutex) = 0;
};

struct FramePool::GiveBack {
    std::shared_ptr<State> state;
    void operator()(Frame* frame) const noexcept {
        const MutexLock lock(state->mutex);
        state->free_frames.push_back(frame);  // reserved: does not allocate
    }
};

template <typename T>
struct FramePool::BlockAllocator {
    using value_type = T;
    std::shared_ptr<State> state;

    explicit BlockAllocator(std::shared_ptr<State> s) noexcept : state(std::move(s)) {}
    template <typename U>
    BlockAllocator(const BlockAllocator<U>& other) noexcept  // NOLINT(google-explicit-constructor)
        : state(other.state) {}

    [[nodiscard]] T* allocate(std::size_t n) {
        static_assert(alignof(T) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__);
        return static_cast<T*>(state->take_block(n * sizeof(T)));
    }
    void deallocate(T* block, std::size_t n) noexcept { state->give_block(block, n * sizeof(T)); }

    template <typename U>
    bool operator==(const BlockAllocator<U>& other) const noexcept {
        return state == other.state;
    }
};

FramePool::FramePool(std::size_t capacity, Size size, PixelFormat format)
    : state_(std::make_shared<State>(capacity, size, format)) {
    const int channels = format == PixelFormat::grey8 ? 1 : 3;
    for (Frame& frame : state_->frames) {
        frame.pixels = Image<std::uint8_t>(size.width * channels, size.height, 0);
        const MutexLock lock(state_->mutex);
        state_->free_frames.push_back(&frame);
    }
    // Lend every frame once: this makes the control blocks that are used again from now on.
    std::vector<std::shared_ptr<Frame>> all(capacity);
    for (auto& frame : all) {
        frame = acquire();
    }
    all.clear();
    for (std::size_t i = 0; i < kSpareBlocks && state_->block_size() != 0; ++i) {
        state_->give_block(::operator new(state_->block_size()), state_->block_size());
    }
}

FramePool::~FramePool() = default;

std::shared_ptr<Frame> FramePool::acquire() noexcept {
    Frame* frame = nullptr;
    {
        const MutexLock lock(state_->mutex);
        if (state_->free_frames.empty()) {
            return nullptr;
        }
        frame = state_->free_frames.back();
        state_->free_frames.pop_back();
    }
    Image<std::uint8_t> pixels = std::move(frame->pixels);
    *frame = Frame{};
    frame->format = state_->format;
    frame->pixels = std::move(pixels);
    const int channels = frame->channels();
    frame->pixels.resize(state_->size.width * channels, state_->size.height);
    try {
        return {frame, GiveBack{state_}, BlockAllocator<Frame>(state_)};
    } catch (const std::bad_alloc&) {
        return nullptr;  // the shared_ptr has called GiveBack
    }
}

std::size_t FramePool::available() const noexcept {
    const MutexLock lock(state_->mutex);
    return state_->free_frames.size();
}

}  // namespace xtrack::base
