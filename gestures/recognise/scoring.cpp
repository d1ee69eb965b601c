// SPDX-License-Identifier: Apache-2.0
#include <xtrack/scoring.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace xtrack {

namespace {

constexpr double kZ95 = 1.959963984540054;
constexpr double kTail = 0.025;
constexpr Duration kAfterLabel = std::chrono::milliseconds{200};
constexpr double kSecondsAnHour = 3600.0;
constexpr std::string_view kOkSign = "x_ok";

/// P(X <= k) of a Poisson variable, whose terms are kept as logarithms: the first, exp(-mean), is
/// below every double from a mean of 745 on.
double poisson_below(int k, double mean) {
    double log_term = -mean;
    double sum = std::exp(log_term);
    for (int i = 1; i <= k; ++i) {
        log_term += std::log(mean / i);
        sum += std::exp(log_term);
    }
    return std::min(sum, 1.0);
}

/// The mean at which poisson_below(k) is `probability`, by bisection: it falls as the mean grows.
double poisson_mean(int k, double probability) {
    double low = 0.0;
    double high = 20.0 + 2.0 * k + 10.0 * std::sqrt(static_cast<double>(k));
    constexpr int kHalvings = 80;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = 0.5 * (low + high);
        (poisson_below(k, middle) > probability ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// What is labelled; whose session it is, and that a hand is there, are not.
bool is_gesture(GestureType type) {
    return type != GestureType::hand && type != GestureType::engage;
}

/// `_left` and the like.
bool is_direction(GestureType type, std::string_view text) {
    return text.starts_with('_') && std::ranges::any_of(directions_of(type), [&](Direction d) {
               return text.substr(1) == to_string(d);
           });
}

/// A gesture of a stream, from begin to its last event.
struct Life {
    GestureEvent begin;
    Stamp last;
    EventPhase how = EventPhase::begin;  ///< the last one's
    CancelReason reason = CancelReason::none;

    [[nodiscard]] bool cancelled() const noexcept { return how == EventPhase::cancel; }
    [[nodiscard]] bool closed() const noexcept { return cancelled() || how == EventPhase::end; }
};

std::vector<Life> lives_of(std::span<const GestureEvent> events) {
    std::vector<Life> lives;
    for (const GestureEvent& e : events) {
        if (!is_gesture(e.type)) {
            continue;
        }
        if (e.phase == EventPhase::begin) {
            lives.push_back({e, e.sensor});
            continue;
        }
        const auto life = std::find_if(lives.rbegin(), lives.rend(), [&](const Life& l) {
            return l.begin.gesture_id == e.gesture_id;
        });
        if (life != lives.rend()) {
            life->last = e.sensor;
            life->how = life->cancelled() ? EventPhase::cancel : e.phase;
            life->reason = e.cancel_reason;
        }
    }
    return lives;
}

bool same_gesture(const GestureLabel& label, const GestureEvent& event) {
    return label.gesture == name_of(event) || label.gesture == to_string(event.type);
}

bool same_hand(const GestureLabel& label, const GestureEvent& event) {
    return label.hand == Chirality::unknown || event.hand == Chirality::unknown ||
           label.hand == event.hand;
}

bool inside(const GestureLabel& label, Stamp stamp) {
    return label.start <= stamp && stamp <= label.end + kAfterLabel;
}

std::optional<std::size_t> find(std::span<const GestureLabel> labels,
                                const std::vector<bool>& matched, auto&& wanted) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        // The one that ends first, so that a later event can still have the other.
        if (!matched[i] && wanted(labels[i]) && (!best || labels[i].end < labels[*best].end)) {
            best = i;
        }
    }
    return best;
}

}  // namespace

Estimate wilson(int successes, int trials) noexcept {
    if (trials <= 0) {
        return {0.0, 0.0, 1.0};
    }
    const double n = trials;
    const double p = successes / n;
    const double z2 = kZ95 * kZ95;
    const double centre = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
    const double half = kZ95 * std::sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n)) / (1.0 + z2 / n);
    return {p, std::max(centre - half, 0.0), std::min(centre + half, 1.0)};
}

Estimate poisson(int events, double exposure) noexcept {
    if (exposure <= 0.0) {
        return {};
    }
    const double low = events > 0 ? poisson_mean(events - 1, 1.0 - kTail) : 0.0;
    const double high = poisson_mean(events, kTail);
    return {events / exposure, low / exposure, high / exposure};
}

double percentile(std::vector<double> values, double share) {
    if (values.empty()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    std::sort(values.begin(), values.end());
    const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    const double part = at - static_cast<double>(below);
    return values[below] + part * (values[above] - values[below]);
}

const char* to_string(Verdict v) noexcept {
    switch (v) {
        case Verdict::correct: return "correct";
        case Verdict::allowed: return "allowed";
        case Verdict::wrong_hand: return "wrong hand";
        case Verdict::overlap: return "overlap";
        case Verdict::stray: return "stray";
        case Verdict::cancelled: return "cancelled";
    }
    return "unknown";
}

double GestureScore::jaccard() const noexcept {
    const int all = labelled + false_events();  // correct + missed = labelled
    return all > 0 ? static_cast<double>(correct) / all : 0.0;
}

void GestureScore::add(const GestureScore& o) {
    labelled += o.labelled;
    correct += o.correct;
    allowed += o.allowed;
    wrong_hand += o.wrong_hand;
    overlapping += o.overlapping;
    stray += o.stray;
    cancelled += o.cancelled;
    cancelled_in_label += o.cancelled_in_label;
    without_reason += o.without_reason;
    unclosed += o.unclosed;
    from_start_ms.insert(from_start_ms.end(), o.from_start_ms.begin(), o.from_start_ms.end());
    from_onset_ms.insert(from_onset_ms.end(), o.from_onset_ms.begin(), o.from_onset_ms.end());
    from_end_ms.insert(from_end_ms.end(), o.from_end_ms.begin(), o.from_end_ms.end());
    from_commit_ms.insert(from_commit_ms.end(), o.from_commit_ms.begin(), o.from_commit_ms.end());
}

GestureScorer::GestureScorer(const GestureSettings& settings) : settings_(settings) {}

bool GestureScorer::scored(std::string_view name) const {
    for (std::size_t t = 0; t < kGestureTypeCount; ++t) {
        const auto type = static_cast<GestureType>(t);
        const std::string_view word = to_string(type);
        if (is_gesture(type) && is_wanted(settings_, type) && name.starts_with(word) &&
            (name.size() == word.size() || is_direction(type, name.substr(word.size())))) {
            return true;
        }
    }
    return false;
}

std::vector<JudgedEvent> GestureScorer::add(std::span<const GestureEvent> events,
                                            std::span<const GestureLabel> labels, Duration length) {
    const std::vector<Life> lives = lives_of(events);
    std::vector<bool> matched(labels.size(), false);
    std::vector<JudgedEvent> judged;
    for (const GestureLabel& label : labels) {
        if (scored(label.gesture)) {
            ++gestures_[label.gesture].labelled;
        }
    }
    for (const Life& life : lives) {
        const GestureEvent& e = life.begin;
        JudgedEvent& verdict = judged.emplace_back();
        verdict.event = e;
        verdict.last = life.last;
        for (const GestureLabel& label : labels) {
            if (inside(label, e.sensor)) {
                verdict.during = label.gesture;
            }
        }
        if (life.cancelled()) {
            verdict.verdict = Verdict::cancelled;
            continue;  // counted below, when it is known what was matched
        }
        const auto hit = find(labels, matched, [&](const GestureLabel& l) {
            return scored(l.gesture) && same_gesture(l, e) && same_hand(l, e) &&
                   inside(l, e.sensor);
        });
        // A label without a direction is a row of its own, in which its finds are counted.
        GestureScore& score = gestures_[hit ? labels[*hit].gesture : name_of(e)];
        score.unclosed += life.closed() ? 0 : 1;
        const auto ok_sign = find(labels, matched, [&](const GestureLabel& l) {
            return l.gesture == kOkSign && e.type == GestureType::pinch && same_hand(l, e) &&
                   inside(l, e.sensor);
        });
        const bool other_hand =
            std::any_of(labels.begin(), labels.end(), [&](const GestureLabel& l) {
                return same_gesture(l, e) && !same_hand(l, e) && inside(l, e.sensor);
            });
        const bool overlaps = std::any_of(labels.begin(), labels.end(), [&](const GestureLabel& l) {
            const bool ours =
                same_gesture(l, e) || (l.gesture == kOkSign && e.type == GestureType::pinch);
            return ours && e.onset <= l.end && l.start <= life.last;
        });
        if (hit) {
            matched[*hit] = true;
            verdict.label = hit;
            verdict.verdict = Verdict::correct;
            ++score.correct;
            const GestureLabel& label = labels[*hit];
            score.from_start_ms.push_back(to_seconds(e.sensor - label.start) * 1e3);
            score.from_onset_ms.push_back(to_seconds(e.sensor - e.onset) * 1e3);
            score.from_end_ms.push_back(to_seconds(e.sensor - label.end) * 1e3);
            if (label.commit) {
                score.from_commit_ms.push_back(to_seconds(e.sensor - *label.commit) * 1e3);
            }
        } else if (ok_sign) {
            matched[*ok_sign] = true;
            verdict.label = ok_sign;
            verdict.verdict = Verdict::allowed;
            ++score.allowed;
        } else if (other_hand) {
            verdict.verdict = Verdict::wrong_hand;
            ++score.wrong_hand;
        } else if (overlaps) {
            verdict.verdict = Verdict::overlap;
            ++score.overlapping;
        } else {
            verdict.verdict = Verdict::stray;
            ++score.stray;
        }
    }
    for (const Life& life : lives) {
        if (!life.cancelled()) {
            continue;
        }
        GestureScore& score = gestures_[name_of(life.begin)];
        ++score.cancelled;
        score.without_reason += life.reason == CancelReason::none ? 1 : 0;
        const auto lost = find(labels, matched, [&](const GestureLabel& l) {
            return same_gesture(l, life.begin) && inside(l, life.begin.sensor);
        });
        score.cancelled_in_label += lost ? 1 : 0;
    }
    if (labels.empty()) {
        unlabelled_events_ +=
            static_cast<int>(std::count_if(judged.begin(), judged.end(), [](const JudgedEvent& e) {
                return e.verdict != Verdict::cancelled;
            }));
        unlabelled_hours_ += to_seconds(length) / kSecondsAnHour;
    }
    return judged;
}

void GestureScorer::add(const GestureScorer& other) {
    for (const auto& [name, score] : other.gestures_) {
        gestures_[name].add(score);
    }
    unlabelled_events_ += other.unlabelled_events_;
    unlabelled_hours_ += other.unlabelled_hours_;
}

GestureScore GestureScorer::all() const {
    GestureScore sum;
    for (const auto& [name, score] : gestures_) {
        sum.add(score);
    }
    return sum;
}

}  // namespace xtrack
