// SPDX-License-Identifier: Apache-2.0
#include "tools/record/label_input.hpp"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "core/base/text.hpp"
#include "tools/progress.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

namespace {

constexpr std::size_t kMostKeys = 9;
constexpr std::size_t kMostLine = 256;

std::string text_of(const GestureLabel& label) {
    return label.hand == Chirality::unknown ? label.gesture
                                            : label.gesture + " " + to_string(label.hand);
}

double seconds(Stamp stamp) { return static_cast<double>(stamp.us()) * 1e-6; }

}  // namespace

Result<GestureLabel> parse_label_option(const std::string& text) {
    const std::size_t colon = text.find(':');
    return label_of(text.substr(0, colon),
                    colon == std::string::npos ? "unknown" : text.substr(colon + 1));
}

LabelInput::LabelInput(std::vector<GestureLabel> kinds) : kinds_(std::move(kinds)) {
    kinds_.resize(std::min(kinds_.size(), kMostKeys));
    if (!is_terminal(stdin)) {
        return;
    }
    more_ = false;  // lines come from programs, and keys where there are any
    if (!kinds_.empty()) {
        more_ = keys_.emplace().on();
    }
}

std::string LabelInput::help() const {
    if (!is_terminal(stdin)) {
        return "";
    }
    std::string text;
    for (std::size_t i = 0; more_ && i < kinds_.size(); ++i) {
        text += fmt::format("{}{} {}", i == 0 ? "keys that begin and end a label: " : ", ", i + 1,
                            text_of(kinds_[i]));
    }
    return text;
}

bool LabelInput::poll(Stamp now) {
    const std::size_t before = done_.size();
    while (more_) {
        const auto some = input_.read_some();
        more_ = some.has_value();
        if (keys_) {
            for (const char c : some.value_or("")) {
                key(c, now);
            }
        } else {
            pending_ += some.value_or("\n");
            for (std::size_t end = 0; (end = pending_.find('\n')) != std::string::npos;) {
                line(pending_.substr(0, end), now);
                pending_.erase(0, end + 1);
            }
            if (pending_.size() > kMostLine) {
                print_error(fmt::format("xtrack: a line of more than {} characters is no label\n",
                                        kMostLine));
                pending_.clear();
            }
        }
        if (!some || some->empty()) {
            break;
        }
    }
    return done_.size() > before;
}

bool LabelInput::finish(Stamp now) {
    const bool any = !open_.empty();
    while (!open_.empty()) {
        end(open_.size() - 1, now);
    }
    keys_.reset();
    return any;
}

void LabelInput::key(char key, Stamp now) {
    const auto number = static_cast<std::size_t>(key - '1');
    if (key < '1' || number >= kinds_.size()) {
        return;
    }
    if (const auto open = find_open(kinds_[number])) {
        end(*open, now);
    } else {
        begin(kinds_[number], now);
    }
}

void LabelInput::line(const std::string& line, Stamp now) {
    std::istringstream words(line);
    std::string verb;
    std::string gesture;
    std::string hand;
    std::string rest;
    words >> verb >> gesture >> hand >> rest;
    if (verb.empty()) {
        return;
    }
    const auto refuse = [&line](const std::string& why) {
        print_error(fmt::format("xtrack: {}: {}\n", base::quoted(line), why));
    };
    if ((verb != "begin" && verb != "end") || !rest.empty() ||
        (verb == "begin" && gesture.empty())) {
        return refuse("is no label; give begin GESTURE [HAND], or end [GESTURE [HAND]]");
    }
    if (gesture.empty()) {
        return open_.empty() ? refuse("no label is open; begin one first")
                             : end(open_.size() - 1, now);
    }
    const auto kind = label_of(gesture, hand.empty() ? "unknown" : hand);
    if (!kind) {
        return refuse(kind.error().message);
    }
    const auto open = find_open(*kind);
    if (verb == "begin") {
        return open ? refuse("this label is open already; end it first") : begin(*kind, now);
    }
    return open ? end(*open, now) : refuse("this label is not open; begin it first");
}

void LabelInput::begin(const GestureLabel& kind, Stamp now) {
    GestureLabel label = kind;
    label.start = now;
    open_.push_back(label);
    print_error(fmt::format("label {}: begun at {:.3f} s\n", text_of(label), seconds(now)));
}

void LabelInput::end(std::size_t open, Stamp now) {
    GestureLabel label = open_[open];
    open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(open));
    label.end = now;
    print_error(fmt::format("label {}: ended at {:.3f} s\n", text_of(label), seconds(now)));
    const auto after = std::upper_bound(
        done_.begin(), done_.end(), label,
        [](const GestureLabel& a, const GestureLabel& b) { return a.start < b.start; });
    done_.insert(after, std::move(label));
}

std::optional<std::size_t> LabelInput::find_open(const GestureLabel& kind) const {
    for (std::size_t i = open_.size(); i-- > 0;) {
        if (open_[i].gesture == kind.gesture && open_[i].hand == kind.hand) {
            return i;
        }
    }
    return std::nullopt;
}

}  // namespace xtrack::tools
