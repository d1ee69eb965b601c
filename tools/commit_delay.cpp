// SPDX-License-Identifier: Apache-2.0
#include "tools/commit_delay.hpp"

#include <chrono>

namespace xtrack::tools {

std::vector<CommitDelay> delays_after_commit(std::span<const JudgedEvent> events,
                                             std::span<const GestureLabel> labels) {
    std::vector<CommitDelay> delays;
    for (const JudgedEvent& judged : events) {
        if (judged.verdict != Verdict::correct) {
            continue;
        }
        const std::string name = name_of(judged.event);
        for (const GestureLabel& label : labels) {
            if (label.gesture == name && label.commit && judged.event.sensor >= label.start &&
                judged.event.sensor <= label.end + std::chrono::milliseconds(200)) {
                delays.push_back({name, to_seconds(judged.event.sensor - *label.commit) * 1e3});
            }
        }
    }
    return delays;
}

}  // namespace xtrack::tools
