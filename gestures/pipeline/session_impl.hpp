// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>

#include <xtrack/session.hpp>

#include "core/base/mutex.hpp"
#include "core/base/time_histogram.hpp"
#include "gestures/pipeline/input.hpp"
#include "gestures/pipeline/input_queue.hpp"
#include "gestures/pipeline/processor.hpp"
#include "gestures/pipeline/stream_clock.hpp"
#include "gestures/session/event_queue.hpp"
#include "gestures/session/subscribers.hpp"

namespace xtrack {

/// What runs: session_impl.cpp reads, processes and delivers; session.cpp is the public face.
struct Session::Impl {
    using Wall = StreamClock::Wall;

    Impl(Input in, Processor proc, Pace pace_in)
        : input(std::move(in)),
          processor(std::move(proc)),
          pace(pace_in),
          clock(pace_in, input.delivery_delay()),
          gesture_settings(processor.recogniser().settings()) {}

    template <typename Source, typename MakeProcessor>
    static Result<Session> session_of(std::unique_ptr<Source> source, Pace pace,
                                      const MakeProcessor& make_processor) noexcept;

    /// Asks the source, and sets when the item is due. False, `timeout` later, where it has none.
    bool read(Duration timeout, InputItem& into);
    /// The next item if one is due within `timeout`, read in the calling thread.
    bool read_due(Duration timeout);
    /// The item through the pipeline, its events to the subscribers.
    Result<StepStatus> take();
    Result<StepStatus> step(Duration timeout);
    /// Reads in a thread of its own and processes in this one, until the end.
    Result<void> run_live();
    Result<void> run();
    void read_live();
    void tick();
    /// What was asked for from any thread since the last item.
    void heed_wishes();
    void deliver(std::span<const GestureEvent> events);
    /// Notes that what is thrown meanwhile is the caller's.
    template <typename Callbacks, typename Arg>
    void call_back(const Callbacks& callbacks, const Arg& arg) {
        in_callback = true;
        callbacks.call(arg);
        in_callback = false;
    }
    Result<StepStatus> finish(StepStatus how);
    template <typename Call>
    auto guarded(Call&& call) noexcept -> decltype(call());

    Input input;
    Processor processor;
    Pace pace;
    StreamClock clock;
    InputItem item;
    bool item_waits = false;  ///< read, but not due yet
    bool in_callback = false;
    bool finished = false;  ///< open gestures have ended or were cancelled
    std::optional<Error> failure;
    Wall::duration reading{};  ///< spent on asking the source since it last gave an item
    Stamp newest;
    Wall::time_point newest_due;
    std::optional<Wall::time_point> newest_taken;  ///< when the item with that stamp was taken
    InputQueue queue;

    Subscribers<const GestureEvent&> event_callbacks;
    Subscribers<const HandFrame&> hands_callbacks;
    Subscribers<const PipelineView&> pipeline_callbacks;
    std::atomic<int> last_handle{0};
    EventQueue event_queue;

    std::atomic<bool> stop_requested{false};
    std::atomic<bool> running{false};
    std::thread worker;
    std::atomic<std::thread::id> worker_id;
    Result<void> worker_result;

    mutable Mutex wishes_mutex;
    GestureSettings gesture_settings XTRACK_GUARDED_BY(wishes_mutex);
    bool paused XTRACK_GUARDED_BY(wishes_mutex) = false;
    std::atomic<bool> wishes{false};  ///< one of the two has changed

    mutable Mutex statistics_mutex;
    SessionStatistics counters XTRACK_GUARDED_BY(statistics_mutex);
    TimeHistogram whole_time XTRACK_GUARDED_BY(statistics_mutex);
    TimeHistogram latency XTRACK_GUARDED_BY(statistics_mutex);
};

inline TimeStatistics statistics_of(const TimeHistogram& h) {
    return {h.count(), h.quantile_us(0.5), h.quantile_us(0.99), h.max_us()};
}

inline Error no_thread(const std::system_error& e) {
    return {ErrorCode::io, std::string("the system gives no thread: ") + e.what()};
}

}  // namespace xtrack
