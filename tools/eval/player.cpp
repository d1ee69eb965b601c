// SPDX-License-Identifier: Apache-2.0
#include "tools/eval/player.hpp"

#include <optional>

#include <xtrack/gesture_recogniser.hpp>

namespace xtrack::tools {

Result<PlayedRecording> play_recording(const std::string& folder, const SessionOptions& options) {
    auto session = Session::open(folder, options);
    if (!session) {
        return session.error();
    }
    PlayedRecording played;
    played.metric = session->metric();
    bool started = false;
    session->subscribe_pipeline([&](const PipelineView& view) {
        Moment& moment = played.moments.emplace_back();
        moment.seen = view.interaction_hands != nullptr;
        if (moment.seen) {
            moment.hands = *view.interaction_hands;
            moment.now = moment.hands.stamp;
            played.begin = started ? played.begin : moment.now;
            played.length = moment.now - played.begin;
            started = true;
        }
        if (view.frame != nullptr) {  // a depth image is as old as the middle of its fringes
            moment.now = (*view.frame)->stamp;
        } else if (view.depth != nullptr) {
            moment.now = view.depth->stamp;
        }
    });
    const Result<void> ended = session->run();
    if (!ended) {
        return ended.error();
    }
    return played;
}

Result<std::vector<GestureEvent>> recognise(const PlayedRecording& recording,
                                            GestureSettings settings) {
    if (!recording.metric) {
        settings = without_millimetres(settings);  // as a session does
    }
    auto recogniser = GestureRecogniser::create(settings);
    if (!recogniser) {
        return recogniser.error();
    }
    std::vector<GestureEvent> all;
    const auto take = [&all](std::span<const GestureEvent> events, Stamp now) {
        for (GestureEvent event : events) {
            event.sensor = event.emit = now;
            all.push_back(event);
        }
    };
    std::optional<Duration> lag;  // of the hands behind the items
    Stamp newest;
    for (const Moment& moment : recording.moments) {
        newest = moment.now;
        if (moment.seen) {
            lag = moment.now - moment.hands.stamp;
            take(recogniser->push(moment.hands), newest);
        } else if (lag) {
            take(recogniser->advance(moment.now - *lag), newest);
        }
    }
    take(recogniser->finish(), newest);
    return all;
}

}  // namespace xtrack::tools
