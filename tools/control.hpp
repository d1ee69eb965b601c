// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <xtrack/session.hpp>

#include "tools/standard_input.hpp"

namespace xtrack::tools {

/// `--control`: reads NAME=VALUE lines from standard input while a session runs, and says on stderr
/// what each did. On hold (mode=hold) it says of how many pixels the images at hand then have
/// depth.
/// @thread that of the session
class Control {
 public:
    /// Takes what has come; never waits. Lines that are no setting are named and passed over.
    void poll(Session& session, const PipelineView& view);

 private:
    void take(std::string line, Session& session) const;

    StandardInput input_;
    const PaperDecoder* paper_ = nullptr;  // on hold no view has it
    std::string pending_;                  // a line whose end has not come
    bool skipping_ = false;                // the rest of a line that is too long
    bool open_ = true;
};

}  // namespace xtrack::tools
