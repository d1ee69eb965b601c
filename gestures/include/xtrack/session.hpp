// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include <xtrack/depth_decoder.hpp>
#include <xtrack/gesture_event.hpp>
#include <xtrack/gesture_recogniser.hpp>
#include <xtrack/gesture_settings.hpp>
#include <xtrack/hand.hpp>
#include <xtrack/hand_source.hpp>
#include <xtrack/hand_tracker.hpp>
#include <xtrack/paper_decoder.hpp>
#include <xtrack/result.hpp>
#include <xtrack/source.hpp>

namespace xtrack {

/// How a session treats the stamps of its source.
/// @since 0.1
enum class Pace {
    /// As fast as it can, nothing dropped, `emit` = `sensor`: the same input gives the same bits.
    replay,
    /// A recording or the simulator as if it were live: each item waits until it is due.
    own_pace,
    /// A device, whose stamps are CLOCK_MONOTONIC.
    live,
};

/// How fringe images become depth.
/// @since 0.1
enum class DecodeMethod {
    /// `pattern` where there is a rig, else `paper`.
    automatic,
    /// DepthDecoder: the fringe order from the patterns or the working volume.
    pattern,
    /// PaperDecoder: one period, unwrapped in space. Without a rig depth is relative; hands and
    /// gestures are then measured in palm widths (Session::metric()).
    paper,
};

/// What a session is made with; the defaults replay, and recognise everything.
/// @since 0.1
struct SessionOptions {
    Pace pace = Pace::replay;
    DecodeMethod method = DecodeMethod::automatic;
    /// False: fringes are decoded as if the source had no calibration.
    bool use_rig = true;
    DecodeSettings decode;
    TrackerSettings tracker;
    GestureSettings gestures;
    /// How long it takes from a source's newest image until a cursor at Hand::pointer_mm is seen:
    /// transfer, processing, display. The pointer of a moving hand is put so far ahead, after what
    /// depth lags behind its images, which is known; together at most 150 ms.
    Duration pointer_ahead = Duration::zero();
};

/// What one step did.
/// @since 0.1
enum class StepStatus {
    processed,  ///< one item went through the whole pipeline
    waiting,    ///< nothing was due within the time-out
    end,        ///< the stream is over; what was open has ended
    stopped,    ///< stop() was called
};

/// Everything that one item became on its way, for viewers and recorders. Pointers are null where a
/// source enters the pipeline later (a depth camera has no `frame`) or a stage gave nothing.
/// @ownership borrowed for the length of the call; copy `frame`'s FramePtr to keep it
/// @since 0.1
struct PipelineView {
    const FramePtr* frame = nullptr;
    const DepthDecoder* decoder = nullptr;  ///< set when `depth` came from fringes, either this
    const PaperDecoder* paper = nullptr;    ///< or this
    const DepthFrame* depth = nullptr;
    const HandTracker* tracker = nullptr;          ///< set when `camera_hands` came from depth
    const HandFrame* camera_hands = nullptr;       ///< camera frame
    const HandFrame* interaction_hands = nullptr;  ///< interaction frame
};

/// A length of time measured often.
/// @since 0.1
struct TimeStatistics {
    std::uint64_t count = 0;
    double median_us = 0.0;
    double p99_us = 0.0;
    double max_us = 0.0;
};

/// Counts and wall-clock times since the session was made.
/// @since 0.1
struct SessionStatistics {
    std::uint64_t items = 0;    ///< frames, depth images or hand frames processed
    std::uint64_t dropped = 0;  ///< arrived faster than they could be processed (never in replay)
    std::uint64_t rejected =
        0;  ///< of these: damaged, of an unknown pattern or another size, on hold
    std::uint64_t depth_frames = 0;
    std::uint64_t events = 0;
    std::uint64_t events_dropped = 0;  ///< lost by a reader that polled too slowly; 0 without one
    TimeStatistics decode;             ///< frame to depth
    TimeStatistics track;              ///< depth to hands
    TimeStatistics recognise;          ///< hands to events
    TimeStatistics whole;              ///< an item's way through all of it, callbacks included
    TimeStatistics latency;            ///< event: sensor to emit; empty in replay
};

/// From a source to gesture events. Three ways to run it:
///  - run(): in the calling thread until the end;
///  - start() and wait(): in a thread of its own;
///  - step(): one item a call, for programs that own their loop.
/// It opens no window and needs no main thread.
///
/// Callbacks run in the thread that calls run() or step(), or in the session's own thread after
/// start(), one at a time. They may subscribe, unsubscribe, poll and stop(); they must not destroy
/// or move the session. A callback that throws ends the session with an Error.
///
/// A session plays its source once. After its end run() and start() do nothing, after stop() they
/// return at once, and once it has failed they and step() give the same Error again. A session that
/// was moved from may be destroyed or assigned to, nothing else.
/// @since 0.1
class Session {
 public:
    using EventCallback = std::function<void(const GestureEvent&)>;
    using HandsCallback = std::function<void(const HandFrame& interaction)>;
    using PipelineCallback = std::function<void(const PipelineView&)>;

    /// Opens a source by name: `sim`, `sim:PRESET`, or the folder of a recording.
    /// @return an Error that names the source and the mend; memory that runs out is one
    /// @thread any
    static Result<Session> open(std::string_view source, const SessionOptions& options = {});

    /// Takes over a source that the caller made. @ownership the session owns the source
    /// @return an Error: the source is null, throws, or has a rig that cannot be used; a setting is
    ///         out of its range
    /// @thread any
    static Result<Session> create(std::unique_ptr<FrameSource> source,
                                  const SessionOptions& options);
    static Result<Session> create(std::unique_ptr<DepthSource> source,
                                  const SessionOptions& options);
    static Result<Session> create(std::unique_ptr<HandSource> source,
                                  const SessionOptions& options);

    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;
    /// Stops and joins the thread of start(); callbacks may still run until it returns.
    /// @pre no run() or step() is under way. @thread not from a callback
    ~Session();

    /// Calls back for every event of one type. @return a handle for unsubscribe(). @thread any
    int subscribe(GestureType type, EventCallback callback);
    /// Calls back for every event. @thread any
    int subscribe(EventCallback callback);
    /// Calls back with the hands of every frame, interaction frame. @thread any
    int subscribe_hands(HandsCallback callback);
    /// Calls back after every processed item with all that it became. @thread any
    int subscribe_pipeline(PipelineCallback callback);
    /// An event whose delivery has begun in another thread may still reach the callback after this;
    /// what it uses must live until then, at the latest until wait() or the destructor returns.
    /// @thread any, a callback included
    void unsubscribe(int handle);

    /// The other way to events: a queue of the newest 256. False when there is none. @thread any
    bool poll(GestureEvent& event);

    /// Runs until the stream ends, fails, or stop() is called. @thread any, one at a time
    Result<void> run();
    /// Runs in a thread of the session's own. @return an Error if it runs already
    /// @thread any, one at a time
    Result<void> start();
    /// Waits for the thread of start(). @return how it ended; an Error in a callback
    /// @thread one at a time
    Result<void> wait();
    /// Processes at most one item in the calling thread; waits for it up to `timeout` (0: not at
    /// all). Nothing is dropped: a loop that turns more slowly than items come must call it until
    /// it says `waiting` (a replay never does), or falls ever further behind. Let every turn do so,
    /// 50 a second or more, since a device's lost hands are noticed here. @thread one at a time
    Result<StepStatus> step(Duration timeout = Duration::zero());
    /// Ends run(), step() or the thread of start() within 20 ms of a source that keeps its
    /// time-outs; what was open is cancelled. Cannot fail; again is harmless. @thread any, a
    /// callback included
    void stop() noexcept;

    /// False where the source has fringes and no rig, or none is used: depth is relative, and
    /// positions, speeds and lengths are in nominal millimetres, in which a palm is 80 wide. So are
    /// the thresholds: 100 mm are one and a quarter palm widths. Along the line of sight they are
    /// an estimate, good to a factor of two. Gestures that compare what is smaller than a hand need
    /// true millimetres and are not recognised (pinch). @thread any
    [[nodiscard]] bool metric() const noexcept;

    /// What fringes are decoded by: `pattern` or `paper`; `automatic` where there are none.
    /// @thread any
    [[nodiscard]] DecodeMethod method() const noexcept;

    /// Settings of the decoder from the next frame on; on hold (DecodeSettings::mode, of `paper`
    /// alone) the images at hand are decoded again at once.
    /// @thread that of run() or step(); after start() a callback alone
    /// @errors unsupported: the session has no fringes; invalid_argument; io: no memory; nothing
    ///         changed
    Result<void> set_decode_settings(const DecodeSettings& settings);
    /// Those of now; the defaults where there are no fringes. @thread as set_decode_settings()
    [[nodiscard]] DecodeSettings decode_settings() const noexcept;
    /// Whether a setting means anything to the decoder at hand. @thread as set_decode_settings()
    [[nodiscard]] bool uses(const DecodeField& field) const noexcept;
    /// Other gestures and thresholds, from the next item on; what is active and is switched off is
    /// cancelled. @thread any
    /// @errors invalid_argument: a setting out of its range; unsupported: the session has no true
    ///         millimetres (metric()) and the gesture needs them; nothing changed
    Result<void> set_gesture_settings(const GestureSettings& settings);
    /// Those that were set last. @thread any
    [[nodiscard]] GestureSettings gesture_settings() const;
    /// While paused hands come and go and no gesture begins; what is active is cancelled.
    /// @thread any
    void pause(bool paused);
    /// Hears every transition of the gestures' state machines and every reason not to; empty turns
    /// it off. @thread that of run() or step(), and called there; after start() a callback alone
    void set_trace(GestureRecogniser::TraceSink sink);

    /// Takes the last decode for the empty scene (PaperDecoder::learn_background()).
    /// @thread that of run() or step(); after start() a callback alone
    /// @errors unsupported: the session has no PaperDecoder, or nothing was decoded yet; io
    Result<void> learn_background();

    /// Counts and times so far. @thread any
    [[nodiscard]] SessionStatistics statistics() const;

 private:
    struct Impl;
    explicit Session(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace xtrack
