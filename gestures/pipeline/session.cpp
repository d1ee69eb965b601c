// SPDX-License-Identifier: Apache-2.0
#include <xtrack/session.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "core/base/mutex.hpp"
#include "core/base/setting_up.hpp"
#include "core/base/time_histogram.hpp"
#include "gestures/pipeline/input.hpp"
#include "gestures/pipeline/input_queue.hpp"
#include "gestures/pipeline/processor.hpp"
#include "gestures/pipeline/stream_clock.hpp"
#include "gestures/session/event_queue.hpp"
#include "gestures/session/subscribers.hpp"

namespace xtrack {

namespace {

using Wall = StreamClock::Wall;

// A device's lost hands are noticed by the clock, and stop() by all, at 50 Hz when no item comes.
constexpr Duration kTick = std::chrono::milliseconds(20);
// Deadlines are now + time-out: "for ever" must not overflow them.
constexpr Duration kLongestWait = std::chrono::hours(1);

TimeStatistics statistics_of(const TimeHistogram& h) {
    return {h.count(), h.quantile_us(0.5), h.quantile_us(0.99), h.max_us()};
}

Error no_thread(const std::system_error& e) {
    return {ErrorCode::io, std::string("the system gives no thread: ") + e.what()};
}

Error callback_threw(const std::exception& e) {
    return {ErrorCode::invalid_argument, std::string("a callback threw: ") + e.what()};
}

}  // namespace

struct Session::Impl {
    Impl(Input in, Processor proc, Pace pace_in)
        : input(std::move(in)),
          processor(std::move(proc)),
          pace(pace_in),
          clock(pace_in, input.delivery_delay()) {}

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

    mutable Mutex statistics_mutex;
    SessionStatistics counters XTRACK_GUARDED_BY(statistics_mutex);
    TimeHistogram whole_time XTRACK_GUARDED_BY(statistics_mutex);
    TimeHistogram latency XTRACK_GUARDED_BY(statistics_mutex);
};

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

void Session::Impl::tick() {
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

// --- The public face -----------------------------------------------------------------------------

/// Callbacks are the caller's code: what they throw must not cross our threads and API. A session
/// that has failed stays failed: half an item may have been delivered.
template <typename Call>
auto Session::Impl::guarded(Call&& call) noexcept -> decltype(call()) {
    if (failure) {
        return *failure;
    }
    try {
        auto result = call();
        if (!result) {
            failure = result.error();
        }
        return result;
    } catch (const std::bad_alloc& e) {
        failure = in_callback ? callback_threw(e) : base::out_of_memory("Session");
    } catch (const std::exception& e) {
        failure = callback_threw(e);
    } catch (...) {
        failure = Error{ErrorCode::invalid_argument, "a callback threw something unknown"};
    }
    finished = true;
    return *failure;
}

namespace {

/// Only one of run(), step() and the session's own thread at a time.
class Turn {
 public:
    explicit Turn(std::atomic<bool>& running) : running_(running), mine_(!running.exchange(true)) {}
    ~Turn() {
        if (mine_) {
            running_ = false;
        }
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;
    [[nodiscard]] bool mine() const noexcept { return mine_; }

 private:
    std::atomic<bool>& running_;
    bool mine_;
};

Error already_running() {
    return {ErrorCode::invalid_argument,
            "the session runs already; use one of run(), start() and step() at a time"};
}

}  // namespace

Session::Session(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Session::Session(Session&&) noexcept = default;

Session& Session::operator=(Session&& other) noexcept {
    if (this != &other) {
        const Session before(std::move(*this));  // stops and joins what ran here
        impl_ = std::move(other.impl_);
    }
    return *this;
}

Session::~Session() {
    if (impl_) {
        stop();
        if (impl_->worker.joinable()) {
            impl_->worker.join();
        }
    }
}

template <typename Source, typename MakeProcessor>
Result<Session> Session::Impl::session_of(std::unique_ptr<Source> source, Pace pace,
                                          const MakeProcessor& make_processor) noexcept {
    return base::setting_up("Session::create", "the source threw", [&]() -> Result<Session> {
        if (!source) {
            return Error{ErrorCode::invalid_argument, "Session::create: the source is null"};
        }
        auto processor = make_processor(*source);
        if (!processor) {
            return processor.error();
        }
        return Session(
            std::make_unique<Impl>(Input(std::move(source)), std::move(*processor), pace));
    });
}

Result<Session> Session::create(std::unique_ptr<FrameSource> source,
                                const SessionOptions& options) {
    return Impl::session_of(std::move(source), options.pace, [&](const FrameSource& frames) {
        return Processor::for_frames(frames.rig(), frames.patterns(), options);
    });
}

Result<Session> Session::create(std::unique_ptr<DepthSource> source,
                                const SessionOptions& options) {
    return Impl::session_of(std::move(source), options.pace, [&](const DepthSource& depths) {
        return Processor::for_depth(depths.rig(), options);
    });
}

Result<Session> Session::create(std::unique_ptr<HandSource> source, const SessionOptions& options) {
    return Impl::session_of(std::move(source), options.pace,
                            [&](const HandSource&) { return Processor::for_hands(options); });
}

int Session::subscribe(EventCallback callback) {
    return impl_->event_callbacks.add(++impl_->last_handle, std::move(callback));
}

int Session::subscribe(GestureType type, EventCallback callback) {
    return subscribe([type, call = std::move(callback)](const GestureEvent& event) {
        if (event.type == type) {
            call(event);
        }
    });
}

int Session::subscribe_hands(HandsCallback callback) {
    return impl_->hands_callbacks.add(++impl_->last_handle, std::move(callback));
}

int Session::subscribe_pipeline(PipelineCallback callback) {
    return impl_->pipeline_callbacks.add(++impl_->last_handle, std::move(callback));
}

void Session::unsubscribe(int handle) {
    impl_->event_callbacks.remove(handle);
    impl_->hands_callbacks.remove(handle);
    impl_->pipeline_callbacks.remove(handle);
}

bool Session::poll(GestureEvent& event) { return impl_->event_queue.pop(event); }

Result<void> Session::run() {
    const Turn turn(impl_->running);
    if (!turn.mine()) {
        return already_running();
    }
    return impl_->guarded([this] { return impl_->run(); });
}

Result<void> Session::start() {
    if (impl_->running.exchange(true)) {
        return already_running();
    }
    if (impl_->worker.joinable()) {
        impl_->worker.join();  // a run that is over and that nobody waited for
    }
    // The thread keeps the Impl and not the Session, which may be moved meanwhile.
    Impl* impl = impl_.get();
    try {
        impl->worker = std::thread([impl] {
            impl->worker_id = std::this_thread::get_id();
            impl->worker_result = impl->guarded([impl] { return impl->run(); });
            impl->running = false;
        });
    } catch (const std::system_error& e) {
        impl->running = false;
        return no_thread(e);
    }
    return {};
}

Result<void> Session::wait() {
    if (impl_->worker_id.load() == std::this_thread::get_id()) {
        return Error{ErrorCode::invalid_argument,
                     "a callback cannot wait() for the thread that it runs in; use stop()"};
    }
    if (impl_->worker.joinable()) {
        impl_->worker.join();
        impl_->worker_id = std::thread::id{};  // the system may give the number to another thread
    }
    return impl_->worker_result;
}

Result<StepStatus> Session::step(Duration timeout) {
    const Turn turn(impl_->running);
    if (!turn.mine()) {
        return already_running();
    }
    return impl_->guarded([this, timeout] { return impl_->step(timeout); });
}

void Session::stop() noexcept {
    impl_->stop_requested = true;
    impl_->queue.close();
}

SessionStatistics Session::statistics() const {
    const MutexLock lock(impl_->statistics_mutex);
    SessionStatistics s = impl_->counters;
    s.whole = statistics_of(impl_->whole_time);
    s.latency = statistics_of(impl_->latency);
    s.dropped = impl_->queue.dropped();
    s.events_dropped = impl_->event_queue.dropped();
    return s;
}

}  // namespace xtrack
