// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/frame_window.hpp"

#include <algorithm>

namespace xtrack {
namespace {

bool saw(const Frame& frame, int y) noexcept {
    return y >= frame.clean_row_begin && y < frame.clean_row_end;
}

}  // namespace

void FrameWindow::push(const FramePtr& frame) noexcept {
    Slot& slot = slots_[static_cast<std::size_t>(frame->pattern)];
    std::rotate(slot.begin(), slot.end() - 1, slot.end());
    slot[0].frame = frame;
    slot[0].count = ++pushed_;
}

void FrameWindow::clear() noexcept {
    for (Slot& slot : slots_) {
        slot = {};
    }
    pushed_ = 0;
}

const Frame* FrameWindow::clean(int pattern, int y) const noexcept {
    for (const Entry& entry : slot(pattern)) {
        if (entry.frame && saw(*entry.frame, y)) {
            return entry.frame.get();
        }
    }
    return nullptr;
}

bool FrameWindow::consecutive(int y, std::span<const Frame*> frames) const noexcept {
    std::fill(frames.begin(), frames.end(), nullptr);
    for (const Slot& slot : slots_) {
        for (const Entry& entry : slot) {
            const std::uint64_t age = pushed_ - entry.count;
            if (entry.frame && age < frames.size()) {
                frames[frames.size() - 1 - static_cast<std::size_t>(age)] = entry.frame.get();
            }
        }
    }
    const auto patterns = static_cast<int>(slots_.size());
    for (std::size_t n = 0; n < frames.size(); ++n) {
        if (frames[n] == nullptr || !saw(*frames[n], y)) {
            return false;
        }
        if (n > 0 && (frames[n]->sequence != frames[n - 1]->sequence + 1 ||
                      frames[n]->pattern != (frames[n - 1]->pattern + 1) % patterns)) {
            return false;
        }
    }
    return true;
}

std::span<const int> FrameWindow::row_edges(int height) noexcept {
    row_edges_.clear();
    row_edges_.push_back(0);
    row_edges_.push_back(height);
    for (const Slot& slot : slots_) {
        for (const Entry& entry : slot) {
            if (entry.frame) {
                row_edges_.push_back(std::clamp(entry.frame->clean_row_begin, 0, height));
                row_edges_.push_back(std::clamp(entry.frame->clean_row_end, 0, height));
            }
        }
    }
    std::sort(row_edges_.begin(), row_edges_.end());
    row_edges_.erase(std::unique(row_edges_.begin(), row_edges_.end()), row_edges_.end());
    return row_edges_;
}

}  // namespace xtrack
