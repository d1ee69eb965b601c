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
    std::signal(SIGINT, note);
    std::signal(SIGTERM, note);
}

NoteInterrupt::~NoteInterrupt() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

bool interrupted() noexcept { return noted; }

}  // namespace xtrack::tools
