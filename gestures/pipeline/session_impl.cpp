// SPDX-License-Identifier: Apache-2.0
#include "gestures/pipeline/session_impl.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace xtrack {

namespace {

// A device's lost hands are noticed by the clock, and stop() by all, at 50 Hz when no item comes.
constexpr Duration kTick = std::chrono::milliseconds(20);
// Deadlines are now + time-out: "for ever" must not overflow them.
constexpr Duration kLongestWait = std::chrono::hours(1);

}  // namespace

bool Session::Impl::read(Duration timeout, InputItem& into) {
    const auto asked = Wall::now();
    input.read(timeout, into);
    const bool nothing = into.status == SourceStatus::lost || into.status == SourceStatus::timeout;
    if (nothing) {
        // Sources may say so at once: to ask again then would spin.
        (void)queue.wait_until(asked + timeout);
    }
    const auto got = Wall::now();
    reading += got - asked;
    if (into.status == SourceStatus::ok) {
        clock.begin(into.stamp);
        clock.note_read(into.stamp, std::exchange(reading, {}), got);
        into.due = clock.due(into.stamp);
    }
    return !nothing;
}

bool Session::Impl::read_due(Duration timeout) {
    const auto asked = Wall::now();
    if (!item_waits) {
        if (!read(timeout, item)) {
            return false;
        }
        if (item.status != SourceStatus::ok) {
            return true;
        }
        item_waits = true;
    }
    const auto due = item.due;
    const auto deadline = std::max(asked + timeout, Wall::now());
    if (due > deadline) {
        queue.wait_until(deadline);
        return false;
    }
    if (due > Wall::now() && !queue.wait_until(due)) {
        return false;
    }
    item_waits = false;
    return true;
}

void Session::Impl::deliver(std::span<const GestureEvent> events) {
    for (const GestureEvent& original : events) {
        GestureEvent event = original;
        event.sensor = newest;
        event.emit = pace == Pace::replay ? event.sensor : clock.now(newest, newest_due);
        {
            const MutexLock lock(statistics_mutex);
            ++counters.events;
            if (pace != Pace::replay) {
                latency.add(event.emit - event.sensor);
            }
        }
        event_queue.push(event);
        call_back(event_callbacks, event);
    }
}

void Session::Impl::heed_wishes() {
    if (!wishes.exchange(false)) {
        return;
    }
    GestureSettings settings;
    bool pause = false;
    {
        const MutexLock lock(wishes_mutex);
        settings = gesture_settings;
        pause = paused;
    }
    if (const auto cancelled = processor.recogniser().set_settings(settings)) {
        deliver(*cancelled);
    }
    deliver(processor.recogniser().pause(pause));
}

void Session::Impl::tick() {
    heed_wishes();
    // What counts is how long ago the newest item came, not how old its stamp is: a source that
    // delivers 150 ms late has not lost the hand. Only a device's time goes on without items: what
    // a recording or a simulator shows next says itself how long the hand was away, however long
    // that takes to make.
    if (newest_taken && pace == Pace::live) {
        deliver(processor.advance(newest + (Wall::now() - *newest_taken)));
    }
}

Result<StepStatus> Session::Impl::finish(StepStatus how) {
    if (!finished) {
        finished = true;
        deliver(how == StepStatus::end ? processor.recogniser().finish()
                                       : processor.recogniser().abandon(CancelReason::disengaged));
    }
    return how;
}

Result<StepStatus> Session::Impl::take() {
    switch (item.status) {
        case SourceStatus::ok: break;
        case SourceStatus::timeout:
        case SourceStatus::lost: return StepStatus::waiting;
        case SourceStatus::end: return finish(StepStatus::end);
        case SourceStatus::failed:
            (void)finish(StepStatus::stopped);
            return Error{ErrorCode::io, item.message};
    }
    heed_wishes();
    const auto begin = Wall::now();
    auto outcome = processor.process(item);
    if (!outcome) {
        (void)finish(StepStatus::stopped);
        return outcome.error();
    }
    newest = item.stamp;
    newest_due = item.due;
    newest_taken = begin;
    deliver(outcome->events);
    if (outcome->view.interaction_hands != nullptr) {
        call_back(hands_callbacks, *outcome->view.interaction_hands);
    }
    call_back(pipeline_callbacks, outcome->view);
    const MutexLock lock(statistics_mutex);
    whole_time.add(Wall::now() - begin);
    ++counters.items;
    counters.rejected = processor.rejected();
    counters.depth_frames = processor.depth_frames();
    counters.decode = statistics_of(processor.decode_time());
    counters.track = statistics_of(processor.track_time());
    counters.recognise = statistics_of(processor.recognise_time());
    return StepStatus::processed;
}

Result<StepStatus> Session::Impl::step(Duration timeout) {
    if (stop_requested) {
        return finish(StepStatus::stopped);
    }
    if (finished) {
        return StepStatus::end;
    }
    // A tick at a time: a source that waits hears nothing of stop(), and hands may be lost
    // meanwhile.
    const auto deadline = Wall::now() + std::clamp(timeout, Duration::zero(), kLongestWait);
    while (true) {
        const Duration left = std::max(deadline - Wall::now(), Duration::zero());
        if (read_due(std::min(left, kTick))) {
            return take();
        }
        if (stop_requested) {
            return finish(StepStatus::stopped);
        }
        tick();
        if (left <= kTick) {
            return StepStatus::waiting;
        }
    }
}

void Session::Impl::read_live() {
    InputItem next;
    while (!queue.closed()) {
        if (!read(kTick, next)) {
            continue;
        }
        const bool last = next.status == SourceStatus::end || next.status == SourceStatus::failed;
        if (!last && next.due > Wall::now() && !queue.wait_until(next.due)) {
            return;
        }
        queue.push(next);
        if (last) {
            return;
        }
    }
}

Result<void> Session::Impl::run_live() {
    if (item_waits) {  // step() had read it already
        queue.push(item);
        item_waits = false;
    }
    std::thread reader;
    try {
        reader = std::thread([this] { read_live(); });
    } catch (const std::system_error& e) {
        return no_thread(e);
    }
    Result<void> result;
    try {
        while (true) {
            if (stop_requested) {
                (void)finish(StepStatus::stopped);
                break;
            }
            if (!queue.pop(item, kTick)) {
                tick();
                continue;
            }
            const auto status = take();
            if (!status) {
                result = status.error();
                break;
            }
            if (*status == StepStatus::end) {
                break;
            }
        }
    } catch (...) {
        queue.close();
        reader.join();
        throw;
    }
    queue.close();
    reader.join();
    return result;
}

Result<void> Session::Impl::run() {
    if (finished) {
        return {};
    }
    if (pace != Pace::replay) {
        return run_live();
    }
    while (true) {
        const auto status = step(kTick);
        if (!status) {
            return status.error();
        }
        if (*status == StepStatus::end || *status == StepStatus::stopped) {
            return {};
        }
    }
}

}  // namespace xtrack
