// SPDX-License-Identifier: Apache-2.0
#include "tools/progress.hpp"

#include <cstdio>
#include <utility>

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

namespace xtrack::tools {

namespace {

constexpr std::chrono::milliseconds kQuiet{1000};
constexpr std::chrono::milliseconds kRedraw{100};
constexpr std::size_t kBarLength = 30;

}  // namespace

bool is_terminal(std::FILE* stream) {
#ifdef _WIN32
    return _isatty(_fileno(stream)) != 0;
#else
    return isatty(fileno(stream)) != 0;
#endif
}

Progress::Progress(std::string what, std::size_t steps)
    : what_(std::move(what)),
      steps_(steps),
      terminal_(is_terminal(stderr)),
      begin_(Clock::now()),
      last_(begin_) {}

Progress::~Progress() {
    if (drawn_) {
        std::fputs("\r\x1b[K", stderr);
    }
}

void Progress::step() {
    ++done_;
    const Clock::time_point now = Clock::now();
    if (!terminal_ || steps_ == 0 || now - begin_ < kQuiet || now - last_ < kRedraw) {
        return;
    }
    last_ = now;
    drawn_ = true;
    const std::size_t filled = done_ >= steps_ ? kBarLength : done_ * kBarLength / steps_;
    const std::string bar = std::string(filled, '#') + std::string(kBarLength - filled, '.');
    std::fprintf(stderr, "\r%s [%s] %zu/%zu", what_.c_str(), bar.c_str(), done_, steps_);
    std::fflush(stderr);
}

}  // namespace xtrack::tools
