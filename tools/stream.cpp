// SPDX-License-Identifier: Apache-2.0
#include "tools/stream.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "tools/control.hpp"
#include "tools/interrupt.hpp"
#include "tools/progress.hpp"
#include "tools/settings_option.hpp"

namespace xtrack::tools {

namespace {

std::string known_gestures() {
    std::string names;
    for (const GestureField& field : gesture_fields()) {
        if (field.is_switch) {
            names += names.empty() ? field.name : std::string(", ") + field.name;
        }
    }
    return names;
}

EventFormat format_of(const std::string& name) {
    if (name == "jsonl") {
        return EventFormat::jsonl;
    }
    return name == "text" ? EventFormat::text : EventFormat::none;
}

/// Ctrl-C, SIGTERM and a closed terminal end the session in order: what is open is cancelled,
/// statistics are printed. So does an answer that cannot be written: nobody would see the rest.
class StopOnInterrupt {
 public:
    explicit StopOnInterrupt(Session& session)
        : watcher_([&session](const std::stop_token& over) {
              while (!over.stop_requested()) {
                  if (interrupted() || std::ferror(stdout) != 0) {
                      session.stop();
                  }
                  std::this_thread::sleep_for(kPoll);
              }
          }) {}

 private:
    static constexpr std::chrono::milliseconds kPoll{20};
    NoteInterrupt note_;
    std::jthread watcher_;
};

}  // namespace

void add_stream_options(CLI::App& command, StreamOptions& options) {
    command.add_option(
        "--gestures", options.gestures,
        "Comma-separated list of what is recognised: " + known_gestures() +
            " (default: swipe, push, pull, pinch, grab, tap, circle; without rig.yaml "
            "those that need no millimetres)");
    command
        .add_option_function<std::string>(
            "--events", [&options](const std::string& name) { options.events = format_of(name); },
            "How events are printed: text, jsonl or none")
        ->check(CLI::IsMember({"text", "jsonl", "none"}))
        ->default_str("text");
    command
        .add_option_function<std::string>(
            "--hands", [&options](const std::string& name) { options.hands = format_of(name); },
            "Print every hand of every frame, in the camera's coordinates (a recording of "
            "joints: the user's, as events are): jsonl or none")
        ->check(CLI::IsMember({"jsonl", "none"}))
        ->default_str("none");
    add_settings_option(command, options.changes, [](const DecodeField&) { return true; });
    command.add_flag("--why", options.why,
                     "Print every transition of the gestures' state machines and every reason why "
                     "a candidate was none, between the events");
    command.add_flag("--stats", options.statistics,
                     "At the end, print the time of every stage on stderr");
    command
        .add_option_function<std::string>(
            "--mode",
            [&options](const std::string& name) {
                options.mode = name == "burst" ? CaptureMode::burst : CaptureMode::sliding;
            },
            "Unwrap fringes in space, as recordings without rig.yaml always are: default (every "
            "image, with those before it) or burst (whole sets of new images); motion is off "
            "unless "
            "--set says otherwise")
        ->check(CLI::IsMember({"default", "burst"}));
    command.add_flag("--without-rig", options.without_rig,
                     "Fringes: as if there were no rig.yaml; depth is relative");
    command.add_flag("--json", options.json, "Events as jsonl, and --stats as JSON");
}

Result<void> choose_gestures(const std::optional<std::string>& list, GestureSettings& settings) {
    if (!list) {
        return {};
    }
    for (const GestureField& field : gesture_fields()) {
        if (field.is_switch) {
            field.set(settings, 0.0);
        }
    }
    std::istringstream names(*list + ',');  // so that what is empty is read, and refused
    for (std::string wanted; std::getline(names, wanted, ',');) {
        bool found = false;
        for (const GestureField& field : gesture_fields()) {
            if (field.is_switch && wanted == field.name) {
                field.set(settings, 1.0);
                found = true;
            }
        }
        if (!found) {
            return Error{ErrorCode::invalid_argument,
                         fmt::format("--gestures: '{}' is not known; choose from {}", wanted,
                                     known_gestures())};
        }
    }
    return {};
}

Result<SessionOptions> session_options(const StreamOptions& stream, Pace pace) {
    SessionOptions options;
    options.pace = pace;
    if (const auto chosen = choose_gestures(stream.gestures, options.gestures); !chosen) {
        return chosen.error();
    }
    options.use_rig = !stream.without_rig;
    if (stream.mode) {
        options.method = DecodeMethod::paper;
        options.decode.motion = MotionHandling::off;  // each image for itself, as in the paper
        options.decode.mode = *stream.mode;
    }
    std::vector<std::string> decoder;
    std::vector<std::string> gestures;
    for (const std::string& change : stream.changes) {
        (is_gesture_setting(change) ? gestures : decoder).push_back(change);
    }
    for (const auto& set : {apply_settings(decoder, options.decode),
                            apply_gesture_settings(gestures, options.gestures)}) {
        if (!set) {
            return Error{set.error().code, "--set " + set.error().message};
        }
    }
    return options;
}

namespace {

/// A gesture that was asked for by its name and needs millimetres; empty: none.
std::string in_vain(const StreamOptions& options) {
    const std::string list = ',' + options.gestures.value_or("") + ',';
    for (std::size_t t = 0; t < kGestureTypeCount; ++t) {
        const auto type = static_cast<GestureType>(t);
        if (needs_millimetres(type) &&
            list.find(std::string(",") + to_string(type) + ',') != std::string::npos) {
            return to_string(type);
        }
    }
    return {};
}

Result<void> check_metric(const Session& session, const StreamOptions& options) {
    if (options.without_rig && session.metric()) {
        return Error{ErrorCode::invalid_argument,
                     "--without-rig: is for fringes, and the source has depth or joints; leave it "
                     "out"};
    }
    const std::string gesture = in_vain(options);
    if (!session.metric() && !gesture.empty()) {
        const char* mend = options.without_rig
                               ? "needs millimetres; leave out --without-rig, or choose from"
                               : "needs millimetres, and the source has no rig.yaml; add the "
                                 "calibration, or choose from";
        return Error{ErrorCode::unsupported,
                     fmt::format("--gestures {}: {} swipe, push, pull, grab, circle, wave, raise",
                                 gesture, mend)};
    }
    return {};
}

}  // namespace

Result<void> check_stream(const Session& session, const StreamOptions& options) {
    const auto used = check_settings(options.changes, session.method(),
                                     [&](const DecodeField& field) { return session.uses(field); });
    if (!used) {
        return Error{used.error().code, "--set " + used.error().message};
    }
    if (session.decode_settings().mode == CaptureMode::hold) {
        return Error{
            ErrorCode::invalid_argument,
            "--set mode=hold: there are no images to hold yet; run --control takes it as a "
            "line while it runs"};
    }
    return check_metric(session, options);
}

int play(Session& session, const StreamOptions& options, Pace pace, bool whole, std::size_t items) {
    const EventFormat format =
        options.json && options.events == EventFormat::text ? EventFormat::jsonl : options.events;
    session.subscribe(
        [format, pace](const GestureEvent& event) { print_event(stdout, format, event, pace); });
    if (options.why) {
        session.set_trace(
            [format](const RecogniserTrace& line) { print_trace(stdout, format, line); });
    }
    if (options.hands == EventFormat::jsonl) {
        session.subscribe_pipeline([](const PipelineView& view) {
            const HandFrame* hands =
                view.camera_hands != nullptr ? view.camera_hands : view.interaction_hands;
            if (hands == nullptr) {
                return;
            }
            for (const Hand& hand : hands->all()) {
                fmt::print("{}\n", to_json(*hands, hand));
            }
            std::fflush(stdout);
        });
    }
    if (!session.metric()) {
        print_error(
            "xtrack: without a rig.yaml depth is relative; lengths are in eightieths of a palm's "
            "width, not in mm, and pinches are not looked for\n");
    }
    std::optional<Control> control;
    if (options.control) {
        control.emplace();
        session.subscribe_pipeline([&](const PipelineView& view) { control->poll(session, view); });
    }
    // A bar between lines of events on the same screen would help nobody.
    std::optional<Progress> progress;
    if (items > 0 && !is_terminal(stdout)) {
        progress.emplace("replay", items);
        session.subscribe_pipeline([&progress](const PipelineView&) { progress->step(); });
    }
    const StopOnInterrupt guard(session);
    const Result<void> result = session.run();
    progress.reset();
    std::fflush(stdout);
    if (options.statistics) {
        const SessionStatistics statistics = session.statistics();
        print_error((options.json ? to_json(statistics) : to_text(statistics)) + "\n");
    }
    if (!result) {
        return fail(result.error());
    }
    if (whole && interrupted()) {
        print_error("xtrack: interrupted; the events above are not all of the recording's\n");
        return kInterruptedStatus;
    }
    return 0;
}

Error with_mode(Error error) {
    if (error.message.ends_with("unwrap in space")) {
        error.message += " with --mode default";
    }
    return error;
}

void print_error(const std::string& text) { (void)std::fputs(text.c_str(), stderr); }

int fail(const Error& error) {
    print_error("xtrack: " + error.message + "\n");
    return 1;
}

int usage(const Error& error) {
    (void)fail(error);
    return 2;
}

Error no_complete_set(const RecordingReader& recording) {
    return {ErrorCode::malformed,
            fmt::format("{}: holds no complete set of its {} patterns; record all of them",
                        (recording.folder() / "frames.csv").string(),
                        recording.patterns().patterns.size())};
}

}  // namespace xtrack::tools
