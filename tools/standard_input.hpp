// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace xtrack::tools {

/// What comes on standard input while something else is done. Reading never waits, and in the
/// background of a shell there is nothing to read.
/// @thread one at a time
class StandardInput {
 public:
    StandardInput();
    /// What has come since the last time; empty: nothing yet; nothing: its end.
    [[nodiscard]] std::optional<std::string> read_some() const;
};

/// While it lives, keys come without being shown and without Enter, where standard input is a
/// terminal that this program may use; elsewhere it does nothing. Ctrl-C stays what it is.
/// @thread one at a time
class KeysOneByOne {
 public:
    KeysOneByOne();
    ~KeysOneByOne();
    KeysOneByOne(const KeysOneByOne&) = delete;
    KeysOneByOne& operator=(const KeysOneByOne&) = delete;

    /// Whether keys come.
    [[nodiscard]] bool on() const noexcept;

 private:
    struct Before;
    std::unique_ptr<Before> before_;
};

}  // namespace xtrack::tools
