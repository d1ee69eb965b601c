// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <xtrack/gesture_recogniser.hpp>

#include "tools/corpus/definitions.hpp"
#include "tools/corpus/tracked.hpp"
#include "tools/trial.hpp"

namespace xtrack::tools::corpus {

namespace {

double seconds(Stamp s) { return static_cast<double>(s.ns) * 1e-9; }

std::vector<const Movement*> pointers(const Sequence& sequence) {
    std::vector<const Movement*> hands;
    for (const Movement& m : sequence.hands) {
        hands.push_back(&m);
    }
    return hands;
}

/// Every frame of a sequence.
void follow(const Sequence& sequence, Tracked& tracked, const auto& take) {
    const auto frames = static_cast<std::uint64_t>(sequence.end_s * sequence.frame_hz);
    for (std::uint64_t i = 0; i < frames; ++i) {
        take(tracked.at(static_cast<double>(i) / sequence.frame_hz));
    }
}

/// What the machines said no to.
struct Refused {
    Stamp stamp;
    const char* machine;
    const char* why;
};

/// The name of the machine that decides a gesture begins the gesture's name: swipe of swipe_left.
std::string why_missed(const GestureLabel& label, const std::vector<Refused>& refused) {
    for (auto r = refused.rbegin(); r != refused.rend(); ++r) {
        if (r->stamp >= label.start && r->stamp <= label.end + std::chrono::milliseconds(200) &&
            label.gesture.starts_with(r->machine)) {
            return r->why;
        }
    }
    return "nothing said";
}

bool is_false(Verdict v) {
    return v == Verdict::wrong_hand || v == Verdict::overlap || v == Verdict::stray;
}

}  // namespace

void Tally::add(const Tally& other) {
    for (const auto& [name, score] : other.scores) {
        scores[name].add(score);
    }
    for (const auto& [name, delays] : other.delay_ms) {
        auto& mine = delay_ms[name];
        mine.insert(mine.end(), delays.begin(), delays.end());
    }
    findings.insert(findings.end(), other.findings.begin(), other.findings.end());
    hours += other.hours;
    sequences += other.sequences;
    false_events += other.false_events;
    strange_events += other.strange_events;
    owner_changes += other.owner_changes;
    engagements += other.engagements;
    short_of_definition += other.short_of_definition;
}

GestureScore Tally::all() const {
    GestureScore sum;
    for (const auto& [name, score] : scores) {
        sum.add(score);
    }
    return sum;
}

std::vector<double> Tally::all_delays() const {
    std::vector<double> all;
    for (const auto& [name, delays] : delay_ms) {
        all.insert(all.end(), delays.begin(), delays.end());
    }
    return all;
}

Result<Tally> run(const Sequence& sequence, const GestureSettings& settings) {
    auto recogniser = GestureRecogniser::create(settings);
    if (!recogniser) {
        return recogniser.error();
    }
    Tally tally;
    tally.sequences = 1;
    tally.hours = sequence.end_s / 3600.0;
    tally.short_of_definition = sequence.short_of_definition;
    std::vector<Refused> refused;
    recogniser->set_trace([&refused](const RecogniserTrace& trace) {
        if (*trace.why != '\0') {
            refused.push_back({trace.stamp, trace.machine, trace.why});
        }
    });
    std::vector<GestureEvent> heard;   // of hands that may act
    std::vector<std::size_t> hand_of;  // of each that begins
    const std::string where = fmt::format("{} {} ({} {:.0f} Hz)", sequence.name, sequence.seed,
                                          to_string(sequence.view), sequence.frame_hz);
    const auto note = [&](const GestureEvent& event, std::size_t hand, bool wrong_hand) {
        const Movement& m = sequence.hands[hand];
        const double t = seconds(event.sensor);
        Finding f;
        f.sequence = where;
        f.t_s = t;
        f.gesture = name_of(event);
        f.doing = m.doing_at(t);
        f.wrong_hand = wrong_hand;
        f.strange = sequence.strange[hand];
        f.by_definition = definitions::fulfilled_before(m, f.gesture, t);
        tally.findings.push_back(std::move(f));
    };
    const std::vector<const Movement*> hands = pointers(sequence);
    Tracked tracked(sequence.view, sequence.frame_hz, sequence.seed, hands);
    std::optional<std::size_t> owner;
    const auto take = [&](std::span<const GestureEvent> events) {
        for (const GestureEvent& event : events) {
            if (event.type == GestureType::hand) {
                continue;
            }
            const std::size_t hand = tracked.owner_of(event.hand_id);
            if (event.type == GestureType::engage) {
                if (event.phase == EventPhase::begin) {
                    ++tally.engagements;
                    if (sequence.strange[hand]) {
                        tally.owner_changes += owner && !sequence.strange[*owner] ? 1 : 0;
                        note(event, hand, false);
                    }
                    owner = hand;
                } else if (event.phase != EventPhase::update && owner == hand) {
                    owner.reset();
                }
                continue;
            }
            if (!sequence.strange[hand]) {
                heard.push_back(event);
                if (event.phase == EventPhase::begin) {
                    hand_of.push_back(hand);
                }
            } else if (event.phase == EventPhase::begin) {
                ++tally.strange_events;
                note(event, hand, false);
            }
        }
    };
    follow(sequence, tracked, [&](const HandFrame& frame) { take(recogniser->push(frame)); });
    take(recogniser->finish());
    GestureScorer scorer(settings);
    const std::vector<JudgedEvent> judged =
        scorer.add(heard, sequence.labels, Duration{std::llround(sequence.end_s * 1e9)});
    tally.scores = scorer.gestures();
    for (const JudgedEvent& event : judged) {
        if (!is_false(event.verdict)) {
            continue;
        }
        ++tally.false_events;
        const auto begun = std::find_if(heard.begin(), heard.end(), [&](const GestureEvent& e) {
            return e.gesture_id == event.event.gesture_id && e.phase == EventPhase::begin;
        });
        const auto index =
            static_cast<std::size_t>(std::count_if(heard.begin(), begun, [](const GestureEvent& e) {
                return e.phase == EventPhase::begin;
            }));
        note(event.event, hand_of[index], event.verdict == Verdict::wrong_hand);
    }
    for (const CommitDelay& delay : delays_after_commit(judged, sequence.labels)) {
        tally.delay_ms[delay.gesture].push_back(delay.ms);
    }
    for (const GestureLabel& label : sequence.labels) {
        const bool found = std::any_of(judged.begin(), judged.end(), [&](const JudgedEvent& e) {
            return e.verdict == Verdict::correct && name_of(e.event) == label.gesture &&
                   e.event.sensor >= label.start &&
                   e.event.sensor <= label.end + std::chrono::milliseconds(200);
        });
        if (!found) {
            Finding f;
            f.sequence = where;
            f.t_s = seconds(label.start);
            f.gesture = label.gesture;
            f.missed = true;
            f.why_not = why_missed(label, refused);
            tally.findings.push_back(std::move(f));
        }
    }
    return tally;
}

std::vector<HandFrame> frames_of(const Sequence& sequence) {
    std::vector<HandFrame> frames;
    const std::vector<const Movement*> hands = pointers(sequence);
    Tracked tracked(sequence.view, sequence.frame_hz, sequence.seed, hands);
    follow(sequence, tracked, [&frames](const HandFrame& frame) { frames.push_back(frame); });
    return frames;
}

}  // namespace xtrack::tools::corpus
