// SPDX-License-Identifier: Apache-2.0
#include <xtrack/session.hpp>

#include <exception>
#include <new>
#include <string>
#include <utility>

#include "core/base/setting_up.hpp"
#include "gestures/pipeline/session_impl.hpp"

namespace xtrack {

namespace {

Error callback_threw(const std::exception& e) {
    return {ErrorCode::invalid_argument, std::string("a callback threw: ") + e.what()};
}

}  // namespace

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

Result<void> no_paper_decoder() {
    return Error{ErrorCode::unsupported,
                 "the session decodes by its patterns; make it with DecodeMethod::paper"};
}

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
        auto made = make_processor(*source);
        if (!made) {
            return made.error();
        }
        return Session(std::make_unique<Impl>(Input(std::move(source)), std::move(*made), pace));
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

bool Session::metric() const noexcept { return impl_->processor.metric(); }

DecodeMethod Session::method() const noexcept { return impl_->processor.method(); }

Result<void> Session::set_decode_settings(const DecodeSettings& settings) {
    return impl_->processor.set_decode_settings(settings);
}

DecodeSettings Session::decode_settings() const noexcept {
    return impl_->processor.decode_settings();
}

bool Session::uses(const DecodeField& field) const noexcept { return impl_->processor.uses(field); }

Result<void> Session::set_gesture_settings(const GestureSettings& settings) {
    if (auto valid = validate(settings); !valid) {
        return valid;
    }
    if (!metric() && demands_of(settings).metric) {
        return Error{ErrorCode::unsupported,
                     "gesture settings: without a calibration there are no true millimetres, which "
                     "some of these gestures need; take without_millimetres() of them"};
    }
    const MutexLock lock(impl_->wishes_mutex);
    impl_->gesture_settings = settings;
    impl_->wishes = true;
    return {};
}

GestureSettings Session::gesture_settings() const {
    const MutexLock lock(impl_->wishes_mutex);
    return impl_->gesture_settings;
}

void Session::pause(bool paused) {
    const MutexLock lock(impl_->wishes_mutex);
    impl_->paused = paused;
    impl_->wishes = true;
}

void Session::set_trace(GestureRecogniser::TraceSink sink) {
    impl_->processor.recogniser().set_trace(std::move(sink));
}

Result<void> Session::learn_background() {
    PaperDecoder* paper = impl_->processor.paper();
    return paper == nullptr ? no_paper_decoder() : paper->learn_background();
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
