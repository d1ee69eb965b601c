// SPDX-License-Identifier: Apache-2.0
#include "tools/interrupt.hpp"

#include <atomic>
#include <csignal>

namespace xtrack::tools {

namespace {

// A handler may hardly do anything but set a flag, which other threads read.
std::atomic<bool> noted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void note(int number) {
    noted = true;
    std::signal(number, SIG_DFL);
}

}  // namespace

NoteInterrupt::NoteInterrupt() {
    noted = false;
    for (Before& signal : before_) {
        signal.handler = std::signal(signal.number, note);
        if (signal.handler == SIG_IGN) {  // whoever started us (nohup) wants it so
            std::signal(signal.number, SIG_IGN);
        }
    }
}

NoteInterrupt::~NoteInterrupt() {
    for (const Before& signal : before_) {
        std::signal(signal.number, signal.handler);
    }
}

bool interrupted() noexcept { return noted; }

}  // namespace xtrack::tools
