// SPDX-License-Identifier: Apache-2.0
#include "tools/control.hpp"

#include <cstddef>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "tools/settings_option.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

namespace {

constexpr std::size_t kMostLine = 256;

bool is_long(const std::string& line) {
    if (line.size() <= kMostLine) {
        return false;
    }
    print_error(
        fmt::format("xtrack: a line of more than {} characters is no setting\n", kMostLine));
    return true;
}

double percent_with_depth(const DepthFrame& depth) {
    std::size_t known = 0;
    for (int y = 0; y < depth.depth.height(); ++y) {
        for (int x = 0; x < depth.depth.width(); ++x) {
            known += depth.depth.at(x, y) != 0 ? 1 : 0;
        }
    }
    return 100.0 * static_cast<double>(known) /
           (static_cast<double>(depth.depth.width()) * depth.depth.height());
}

}  // namespace

void Control::poll(Session& session, const PipelineView& view) {
    paper_ = view.paper != nullptr ? view.paper : paper_;
    if (!open_) {
        return;
    }
    if (pending_.find('\n') == std::string::npos) {
        const auto some = input_.read_some();
        open_ = some.has_value();
        pending_ += some.value_or("\n");
    }
    // One line an image: a change may make the decoder anew, and images must not wait for a flood.
    const std::size_t end = pending_.find('\n');
    if (end != std::string::npos) {
        const std::string line = pending_.substr(0, end);
        pending_.erase(0, end + 1);
        if (!std::exchange(skipping_, false) && !is_long(line)) {
            take(line, session);
        }
    } else if (skipping_ || is_long(pending_)) {
        skipping_ = true;
        pending_.clear();
    }
}

void Control::take(std::string line, Session& session) const {
    if (!line.empty() && line.back() == '\r') {
        line.pop_back();
    }
    if (line.empty()) {
        return;
    }
    if (is_gesture_setting(line)) {
        GestureSettings gestures = session.gesture_settings();
        auto changed = apply_gesture_settings({line}, gestures);
        if (changed) {
            changed = session.set_gesture_settings(gestures);
        }
        print_error(changed ? fmt::format("{}: from the next image on\n", line)
                            : fmt::format("xtrack: {}\n", changed.error().message));
        return;
    }
    const DecodeSettings before = session.decode_settings();
    DecodeSettings settings = before;
    auto done = apply_settings({line}, settings);
    if (done) {
        done = check_settings({line}, session.method(),
                              [&](const DecodeField& field) { return session.uses(field); });
    }
    if (done && settings.mode == CaptureMode::hold && paper_ == nullptr) {
        done = Error{ErrorCode::invalid_argument,
                     line + ": nothing was decoded yet that could be held"};
    }
    if (done && settings != before) {
        done = session.set_decode_settings(settings);
    }
    if (!done) {
        print_error(fmt::format("xtrack: {}\n", done.error().message));
    } else if (settings.mode == CaptureMode::hold) {
        print_error(fmt::format("{}: {:.1f} % of the pixels have depth\n", line,
                                percent_with_depth(paper_->depth())));
    } else {
        print_error(fmt::format("{}: from the next image on\n", line));
    }
}

}  // namespace xtrack::tools
