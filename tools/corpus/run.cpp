// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>
#include <xtrack/gesture_recogniser.hpp>

#include "tools/corpus/definitions.hpp"
#include "tools/corpus/tracked.hpp"

namespace xtrack::tools::corpus {

namespace {

constexpr Duration kAfterLabel = std::chrono::milliseconds(200);  // as the scorer has it

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

/// Whether a machine decides a gesture: swipe of swipe_left, tap of double_tap, push of pull.
bool decides(const std::string& machine, const std::string& gesture) {
    return gesture.starts_with(machine) || gesture.ends_with("_" + machine) ||
           (gesture == "pull" && machine == "push");
}

std::string why_missed(const GestureLabel& label, std::span<const Refusal> refusals) {
    for (auto r = refusals.rbegin(); r != refusals.rend(); ++r) {
        if (r->stamp >= label.start && r->stamp <= label.end + kAfterLabel &&
            decides(r->machine, label.gesture)) {
            return r->why;
        }
    }
    return "nothing said";
}

std::string name_of(const Sequence& sequence) {
    return fmt::format("{} {} ({} {:.0f} Hz)", sequence.name, sequence.seed,
                       to_string(sequence.view), sequence.frame_hz);
}

Finding finding_of(const Sequence& sequence, const GestureEvent& event, std::size_t hand,
                   bool wrong_hand) {
    const Movement& m = sequence.hands[hand];
    Finding f;
    f.sequence = name_of(sequence);
    f.t_s = seconds(event.sensor);
    f.gesture = xtrack::name_of(event);
    f.doing = m.doing_at(f.t_s);
    f.wrong_hand = wrong_hand;
    f.strange = sequence.strange[hand];
    f.by_definition = definitions::fulfilled_before(m, f.gesture, f.t_s);
    return f;
}

}  // namespace

void Tally::add(const Tally& other) {
    for (const auto& [name, score] : other.scores) {
        scores[name].add(score);
    }
    findings.insert(findings.end(), other.findings.begin(), other.findings.end());
    hours += other.hours;
    engaged_hours += other.engaged_hours;
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

Tally tally_of(const Sequence& sequence, std::map<std::string, GestureScore> scores,
               std::span<const JudgedEvent> judged, const HandOf& hand_of,
               std::span<const Refusal> refusals) {
    Tally tally;
    tally.sequences = 1;
    tally.hours = sequence.end_s / 3600.0;
    tally.short_of_definition = sequence.short_of_definition;
    tally.scores = std::move(scores);
    for (const JudgedEvent& event : judged) {
        if (is_false(event.verdict)) {
            ++tally.false_events;
            tally.findings.push_back(finding_of(sequence, event.event, hand_of(event.event),
                                                event.verdict == Verdict::wrong_hand));
        }
    }
    for (const GestureLabel& label : sequence.labels) {
        const bool found = std::any_of(judged.begin(), judged.end(), [&](const JudgedEvent& e) {
            return e.verdict == Verdict::correct && name_of(e.event) == label.gesture &&
                   e.event.sensor >= label.start && e.event.sensor <= label.end + kAfterLabel;
        });
        if (!found) {
            Finding f;
            f.sequence = name_of(sequence);
            f.t_s = seconds(label.start);
            f.gesture = label.gesture;
            f.missed = true;
            f.why_not = why_missed(label, refusals);
            tally.findings.push_back(std::move(f));
        }
    }
    return tally;
}

Result<Tally> run(const Sequence& sequence, const GestureSettings& settings) {
    auto recogniser = GestureRecogniser::create(settings);
    if (!recogniser) {
        return recogniser.error();
    }
    std::vector<Refusal> refusals;
    recogniser->set_trace([&refusals](const RecogniserTrace& trace) {
        if (*trace.why != '\0') {
            refusals.push_back({trace.stamp, trace.machine, trace.why});
        }
    });
    const std::vector<const Movement*> hands = pointers(sequence);
    Tracked tracked(sequence.view, sequence.frame_hz, sequence.seed, hands);
    const HandOf hand_of = [&tracked](const GestureEvent& e) {
        return tracked.owner_of(e.hand_id);
    };
    std::vector<GestureEvent> heard;  // of hands that may act
    Tally of_strangers;
    double engaged_s = 0.0;
    bool owned = false;  // by one who has been there ever since
    const auto take = [&](std::span<const GestureEvent> events) {
        for (const GestureEvent& event : events) {
            if (event.type == GestureType::hand) {
                continue;
            }
            const std::size_t hand = hand_of(event);
            const bool strange = sequence.strange[hand];
            const bool begins = event.phase == EventPhase::begin;
            if (event.type == GestureType::engage) {
                if (begins) {
                    ++of_strangers.engagements;
                    of_strangers.owner_changes += strange && owned ? 1 : 0;
                    owned = owned || !strange;
                }
            } else if (!strange) {
                heard.push_back(event);
            } else if (begins) {
                ++of_strangers.strange_events;
            }
            if (strange && begins) {
                of_strangers.findings.push_back(finding_of(sequence, event, hand, false));
            }
        }
    };
    follow(sequence, tracked, [&](const HandFrame& frame) {
        take(recogniser->push(frame));
        if (recogniser->session_owner() != 0) {
            engaged_s += 1.0 / sequence.frame_hz;
        }
    });
    take(recogniser->finish());
    GestureScorer scorer(settings);
    const std::vector<JudgedEvent> judged =
        scorer.add(heard, sequence.labels, Duration{std::llround(sequence.end_s * 1e9)});
    Tally tally = tally_of(sequence, scorer.gestures(), judged, hand_of, refusals);
    tally.add(of_strangers);
    tally.engaged_hours = engaged_s / 3600.0;
    return tally;
}

std::vector<HandFrame> joints_of(const Sequence& sequence) {
    std::vector<HandFrame> frames;
    const std::vector<const Movement*> hands = pointers(sequence);
    Tracked tracked(View::joints, sequence.frame_hz, sequence.seed, hands);
    follow(sequence, tracked, [&frames](const HandFrame& frame) { frames.push_back(frame); });
    return frames;
}

}  // namespace xtrack::tools::corpus
