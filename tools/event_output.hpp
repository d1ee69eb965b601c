// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

#include <xtrack/gesture_event.hpp>
#include <xtrack/hand.hpp>
#include <xtrack/session.hpp>

namespace xtrack::tools {

enum class EventFormat { none, text, jsonl };

/// One line for people: when, what, whose, and how long it took.
[[nodiscard]] std::string to_text(const GestureEvent& event, Pace pace);

/// Events of one-shot gestures come twice, begin and end in the same frame; people need one line.
[[nodiscard]] bool worth_a_text_line(const GestureEvent& event);

/// Prints events to `out`, each as it happens (flushed).
/// One line of the why-not trace, as print_event() prints events.
void print_trace(std::FILE* out, EventFormat format, const RecogniserTrace& line);

void print_event(std::FILE* out, EventFormat format, const GestureEvent& event, Pace pace);

/// One line of JSON a hand: `{"type":"hand_pose",...}`, in the coordinates of `hands`.
[[nodiscard]] std::string to_json(const HandFrame& hands, const Hand& hand);

/// A table of times and counts, for people, or one JSON object.
[[nodiscard]] std::string to_text(const SessionStatistics& statistics);
[[nodiscard]] std::string to_json(const SessionStatistics& statistics);

}  // namespace xtrack::tools
