// SPDX-License-Identifier: Apache-2.0
#include "tools/standard_input.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>

#ifndef _WIN32
#include <poll.h>
#include <termios.h>
#include <unistd.h>
#endif

namespace xtrack::tools {

#ifdef _WIN32

struct KeysOneByOne::Before {};

StandardInput::StandardInput() = default;
std::optional<std::string> StandardInput::read_some() const { return std::nullopt; }
KeysOneByOne::KeysOneByOne() = default;
KeysOneByOne::~KeysOneByOne() = default;

#else

struct KeysOneByOne::Before {
    termios settings;
};

StandardInput::StandardInput() {
    // In the background of a shell, reading would stop the program: then there is nothing to read.
    std::signal(SIGTTIN, SIG_IGN);
}

std::optional<std::string> StandardInput::read_some() const {
    constexpr std::size_t kAtOnce = 256;
    pollfd in{STDIN_FILENO, POLLIN, 0};
    if (::poll(&in, 1, 0) <= 0) {
        return "";
    }
    std::array<char, kAtOnce> bytes{};
    const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) {
        return "";
    }
    return count > 0 ? std::optional<std::string>(
                           std::string(bytes.data(), static_cast<std::size_t>(count)))
                     : std::nullopt;
}

KeysOneByOne::KeysOneByOne() {
    Before before{};
    // A program in the background that changes the terminal is stopped by it.
    if (::isatty(STDIN_FILENO) == 0 || ::tcgetpgrp(STDIN_FILENO) != ::getpgrp() ||
        ::tcgetattr(STDIN_FILENO, &before.settings) != 0) {
        return;
    }
    termios keys = before.settings;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    if (::tcsetattr(STDIN_FILENO, TCSANOW, &keys) == 0) {
        before_ = std::make_unique<Before>(before);
    }
}

KeysOneByOne::~KeysOneByOne() {
    if (before_ != nullptr) {
        ::tcsetattr(STDIN_FILENO, TCSANOW, &before_->settings);
    }
}

#endif

bool KeysOneByOne::on() const noexcept { return before_ != nullptr; }

}  // namespace xtrack::tools
