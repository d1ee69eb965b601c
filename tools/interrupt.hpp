// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>

namespace xtrack::tools {

constexpr int kInterruptedStatus = 130;  // what shells say of Ctrl-C

/// While it lives, Ctrl-C, SIGTERM and SIGHUP leave a note instead of ending the program; a second
/// one ends it at once, whatever it hangs in. One that is ignored stays so; after it all is as it
/// was.
/// @thread one at a time
class NoteInterrupt {
 public:
    NoteInterrupt();
    ~NoteInterrupt();
    NoteInterrupt(const NoteInterrupt&) = delete;
    NoteInterrupt& operator=(const NoteInterrupt&) = delete;

 private:
    struct Before {
        int number;
        void (*handler)(int) = SIG_DFL;
    };
    Before before_[3] = {{SIGINT}, {SIGTERM}, {SIGHUP}};
};

/// Whether there is a note since the last NoteInterrupt was made. @thread any
[[nodiscard]] bool interrupted() noexcept;

}  // namespace xtrack::tools
