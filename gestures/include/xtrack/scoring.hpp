// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <xtrack/gesture_event.hpp>
#include <xtrack/gesture_settings.hpp>
#include <xtrack/labels.hpp>
#include <xtrack/stamp.hpp>

namespace xtrack {

/// A number with its 95 % interval.
/// @since 0.1
struct Estimate {
    double value = 0.0;
    double low = 0.0;
    double high = 0.0;
};

// Statistics. @thread any

/// Share of successes. Wilson's score interval (1927); 0..1 without trials.
/// @since 0.1
[[nodiscard]] Estimate wilson(int successes, int trials) noexcept;
/// Events per unit of exposure. Garwood's exact Poisson interval (1936); 0 without exposure.
/// @since 0.1
[[nodiscard]] Estimate poisson(int events, double exposure) noexcept;
/// Linear interpolation between order statistics; NaN without values. @param share 0..1
/// @since 0.1
[[nodiscard]] double percentile(std::vector<double> values, double share);

/// What an event turned out to be.
/// @since 0.1
enum class Verdict {
    correct,     ///< a label of the same gesture and hand, not matched before
    allowed,     ///< a pinch during x_ok: right, but nothing was asked for
    wrong_hand,  ///< correct but for the hand; counts as false
    overlap,     ///< false, and overlaps a label of its gesture (twice, too early, too late)
    stray,       ///< false
    cancelled,   ///< begun and cancelled: neither right nor false
};

/// Whether it counts against the recogniser. @thread any
/// @since 0.1
[[nodiscard]] constexpr bool is_false(Verdict v) noexcept {
    return v == Verdict::wrong_hand || v == Verdict::overlap || v == Verdict::stray;
}

/// As eval prints it. Static storage. @thread any
/// @since 0.1
[[nodiscard]] const char* to_string(Verdict v) noexcept;

/// One gesture that was recognised in a stream, and what it was.
/// @since 0.1
struct JudgedEvent {
    GestureEvent event;  ///< its begin
    Stamp last;          ///< of its newest event: where it ended or was cancelled
    Verdict verdict = Verdict::stray;
    std::string during;                ///< label that it fell into; empty = between labels
    std::optional<std::size_t> label;  ///< the one that it matched (correct, allowed), by index
};

/// Figures of one gesture (or of all) over some streams.
/// @since 0.1
struct GestureScore {
    int labelled = 0;
    int correct = 0;
    int allowed = 0;
    int wrong_hand = 0;
    int overlapping = 0;  ///< Verdict::overlap
    int stray = 0;
    int cancelled = 0;           ///< begun and cancelled: no event
    int cancelled_in_label = 0;  ///< of these, while the same gesture was labelled and not matched
    int without_reason = 0;      ///< of these, without a CancelReason: a bug of the recogniser's
    int unclosed = 0;            ///< begun, with neither end nor cancel: another one
    std::vector<double> from_start_ms;  ///< label's start to deciding frame
    std::vector<double> from_onset_ms;  ///< the event's own onset to deciding frame
    std::vector<double> from_end_ms;    ///< label's end to deciding frame; negative: before it
    /// GestureLabel::commit to deciding frame, of labels that have it.
    std::vector<double> from_commit_ms;

    /// Events that match nothing, partial overlaps counted (as SHREC'22 publishes) ...
    [[nodiscard]] int false_events() const noexcept { return wrong_hand + overlapping + stray; }
    /// ... and not counted (as its script does).
    [[nodiscard]] int false_without_overlaps() const noexcept { return wrong_hand + stray; }

    [[nodiscard]] Estimate detection() const noexcept { return wilson(correct, labelled); }
    [[nodiscard]] Estimate false_per_label() const noexcept {
        return poisson(false_events(), labelled);
    }
    [[nodiscard]] Estimate false_per_label_without_overlaps() const noexcept {
        return poisson(false_without_overlaps(), labelled);
    }
    /// correct / (correct + missed + false)
    [[nodiscard]] double jaccard() const noexcept;
    [[nodiscard]] Estimate wrong_hands() const noexcept {
        return wilson(wrong_hand, correct + wrong_hand);
    }
    /// Share of cancels that took back what nobody had asked for; the others lost a gesture.
    [[nodiscard]] Estimate right_cancels() const noexcept {
        return wilson(cancelled - cancelled_in_label, cancelled);
    }
    void add(const GestureScore& other);
};

/// Compares events with labels. An event (cancelled ones are none) matches a label of the same
/// gesture and hand when its deciding frame lies between the label's start and its end + 200 ms;
/// each label once; a label without a direction (`swipe`) matches any. Every other event is false,
/// inside a label or not. A label whose hand is unknown matches either hand; so does an event that
/// does not claim one.
/// @thread one thread at a time
/// @since 0.1
class GestureScorer {
 public:
    /// @param settings which gestures are scored: those that are switched on. Labels of others are
    ///        treated like `x_` labels: nothing is asked for, events inside are false.
    explicit GestureScorer(const GestureSettings& settings = {});

    /// @param events all events of one stream, in order, finish() included
    /// @param length of the stream; only of streams without labels does it matter
    /// @return every gesture with its verdict, in the order of their beginnings
    std::vector<JudgedEvent> add(std::span<const GestureEvent> events,
                                 std::span<const GestureLabel> labels, Duration length);
    /// Adds what another scorer found in other streams.
    void add(const GestureScorer& other);

    /// Whether labels of this name ask for an event.
    [[nodiscard]] bool scored(std::string_view name) const;

    /// By name (`swipe_left`, `pinch`): what was labelled or recognised.
    [[nodiscard]] const std::map<std::string, GestureScore>& gestures() const noexcept {
        return gestures_;
    }
    [[nodiscard]] GestureScore all() const;
    /// Events of streams without labels.
    [[nodiscard]] int unlabelled_events() const noexcept { return unlabelled_events_; }
    [[nodiscard]] double unlabelled_hours() const noexcept { return unlabelled_hours_; }
    [[nodiscard]] Estimate false_per_hour() const noexcept {
        return poisson(unlabelled_events_, unlabelled_hours_);
    }

 private:
    GestureSettings settings_;
    std::map<std::string, GestureScore> gestures_;
    int unlabelled_events_ = 0;
    double unlabelled_hours_ = 0.0;
};

}  // namespace xtrack
