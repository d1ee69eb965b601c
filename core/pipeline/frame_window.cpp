// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/frame_window.hpp"

#include <algorithm>

namespace xtrack {
namespace {

int clean_rows(const Frame& frame) noexcept { return frame.clean_row_end - frame.clean_row_begin; }

// True where `frame` saw every row that `other` saw.
bool covers(const Frame& frame, const Frame& other) noexcept {
    return frame.clean_row_begin <= other.clean_row_begin &&
           frame.clean_row_end >= other.clean_row_end;
}

template <class Slot>
void erase(Slot& slot, std::size_t at) noexcept {
    std::rotate(slot.begin() + static_cast<std::ptrdiff_t>(at),
                slot.begin() + static_cast<std::ptrdiff_t>(at) + 1, slot.end());
    slot.back() = {};
}

}  // namespace

// Frees the last entry for a frame of `show`. Frames go that no row can need: those of all but the
// newest show that is over, and what another frame of that show saw as well.
void FrameWindow::make_room(Slot& slot, std::uint64_t show) noexcept {
    std::uint64_t over = 0;  // the newest show that is over
    for (const Entry& entry : slot) {
        if (entry.frame && entry.show != show) {
            over = std::max(over, entry.show);
        }
    }
    for (std::size_t n = slot.size(); n-- > 0;) {
        if (!slot[n].frame || slot[n].show == show) {
            continue;
        }
        bool needed = slot[n].show == over;
        for (std::size_t other = 0; other < slot.size(); ++other) {
            needed = needed && !(other != n && slot[other].frame && slot[other].show == over &&
                                 covers(*slot[other].frame, *slot[n].frame));
        }
        if (!needed) {
            erase(slot, n);
        }
    }
    // Of the show that goes on: the frame before, or one that saw more.
    std::size_t same = 0;
    while (same < slot.size() && slot[same].frame && slot[same].show == show) {
        ++same;
    }
    if (same >= kFramesPerShow) {
        const bool older_saw_more = clean_rows(*slot[1].frame) > clean_rows(*slot[0].frame);
        erase(slot, older_saw_more ? 0 : 1);
    }
}

void FrameWindow::push(const FramePtr& frame) noexcept {
    // A pattern that never changes would be one show without an end, and its images are not to be
    // averaged: what moves would smear.
    const bool goes_on = slots_.size() > 1 && pushed_ > 0 && frame->pattern == pattern_ &&
                         frame->sequence == sequence_ + 1;
    if (!goes_on) {
        ++shows_;
        last_show_frames_ = show_frames_;
        show_frames_ = 0;
    }
    ++show_frames_;
    pattern_ = frame->pattern;
    sequence_ = frame->sequence;
    Slot& slot = slots_[static_cast<std::size_t>(frame->pattern)];
    make_room(slot, shows_);
    std::rotate(slot.begin(), slot.end() - 1, slot.end());
    slot[0] = {frame, ++pushed_, shows_};
}

void FrameWindow::clear() noexcept {
    for (Slot& slot : slots_) {
        slot = {};
    }
    pushed_ = 0;
    shows_ = 0;
    show_frames_ = 0;
    last_show_frames_ = 0;
}

const FrameWindow::Entry* FrameWindow::fullest(int pattern, int shows_ago) const noexcept {
    const Slot& entries = slot(pattern);
    const Entry* best = nullptr;
    for (const Entry& entry : entries) {
        const bool newest_show = entry.show == entries[0].show;
        if (entry.frame && newest_show == (shows_ago == 0) &&
            (best == nullptr || clean_rows(*entry.frame) > clean_rows(*best->frame))) {
            best = &entry;
        }
    }
    return best;
}

const FrameWindow::Entry* FrameWindow::held(int pattern) const noexcept {
    const Slot& entries = slot(pattern);
    return entries[1].frame && entries[1].show == entries[0].show ? &entries[1] : nullptr;
}

const Frame* FrameWindow::clean(int pattern, int y) const noexcept {
    for (const Entry& entry : slot(pattern)) {
        if (entry.frame && saw(*entry.frame, y)) {
            return entry.frame.get();
        }
    }
    return nullptr;
}

std::size_t FrameWindow::clean_show(
    int pattern, int y, std::array<const Frame*, kFramesPerShow>& frames) const noexcept {
    std::size_t count = 0;
    std::uint64_t show = 0;
    for (const Entry& entry : slot(pattern)) {
        if (entry.frame && saw(*entry.frame, y) && (count == 0 || entry.show == show) &&
            count < frames.size()) {
            frames[count++] = entry.frame.get();
            show = entry.show;
        }
    }
    return count;
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
