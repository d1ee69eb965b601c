// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <xtrack/labels.hpp>
#include <xtrack/stamp.hpp>

#include "tools/standard_input.hpp"

namespace xtrack::tools {

/// `GESTURE` or `GESTURE:HAND`. @errors as label_of()
[[nodiscard]] Result<GestureLabel> parse_label_option(const std::string& text);

/// Labels as somebody gives them while a stream runs. At a terminal a key begins and ends one; from
/// a pipe, lines do: `begin GESTURE [HAND]` and `end` (of the newest that is open) or
/// `end GESTURE [HAND]`. What happened is said on stderr, and lines that are none are named and
/// passed over.
/// @thread one at a time
class LabelInput {
 public:
    /// @param kinds what the keys 1 to 9 stand for
    explicit LabelInput(std::vector<GestureLabel> kinds);

    /// Takes what has come; never waits. @param now of the stream
    /// @return whether a label was ended
    bool poll(Stamp now);
    /// Ends what is open. @return whether anything was
    bool finish(Stamp now);

    /// What was ended so far, in the order of start.
    [[nodiscard]] const std::vector<GestureLabel>& labels() const noexcept { return done_; }
    /// What can be typed, for people; empty: nothing.
    [[nodiscard]] std::string help() const;

 private:
    void key(char key, Stamp now);
    void line(const std::string& line, Stamp now);
    void begin(const GestureLabel& kind, Stamp now);
    void end(std::size_t open, Stamp now);
    [[nodiscard]] std::optional<std::size_t> find_open(const GestureLabel& kind) const;

    std::vector<GestureLabel> kinds_;
    StandardInput input_;
    std::optional<KeysOneByOne> keys_;  // where there are keys to press
    std::string pending_;               // a line whose end has not come
    bool more_ = true;                  // standard input has not ended
    std::vector<GestureLabel> open_;
    std::vector<GestureLabel> done_;
};

}  // namespace xtrack::tools
