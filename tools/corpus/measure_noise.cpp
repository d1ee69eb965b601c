// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/measure_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <xtrack/scoring.hpp>
#include <xtrack/session.hpp>
#include <xtrack/sim.hpp>

#include "tools/corpus/images.hpp"
#include "tools/corpus/noise.hpp"
#include "tools/corpus/performer.hpp"
#include "tools/corpus/seen_hand.hpp"

namespace xtrack::tools::corpus {

namespace {

constexpr float kSameHandMm = 150.0F;  // farther off it is another thing that was taken for a hand
constexpr float kMovesMmps = 100.0F;

/// Errors of one quantity through time.
class Errors {
 public:
    /// @param follows the value before it in the same run is its neighbour in time
    void add(double value, bool follows) {
        values_.push_back(value);
        follows_.push_back(follows);
    }
    [[nodiscard]] std::size_t count() const { return values_.size(); }

    /// median, robust standard deviation, 95 % of the magnitude, correlation with the frame before
    [[nodiscard]] std::string text() const {
        if (values_.size() < 3) {
            return fmt::format("{:>6} {:>8} {:>8} {:>8} {:>6}", values_.size(), "-", "-", "-", "-");
        }
        const double median = percentile(values_, 0.5);
        std::vector<double> off;
        std::vector<double> magnitude;
        for (const double v : values_) {
            off.push_back(std::abs(v - median));
            magnitude.push_back(std::abs(v));
        }
        constexpr double kSigmaOfMedianDeviation = 1.4826;
        const double sigma = kSigmaOfMedianDeviation * percentile(off, 0.5);
        // Of what is no outlier: one wild value would decide it alone.
        double together = 0.0;
        double alone = 0.0;
        for (std::size_t i = 1; i < values_.size(); ++i) {
            const double a = values_[i - 1] - median;
            const double b = values_[i] - median;
            if (follows_[i] && std::max(std::abs(a), std::abs(b)) < 4.0 * sigma) {
                together += a * b;
                alone += 0.5 * (a * a + b * b);
            }
        }
        return fmt::format("{:>6} {:>8.2f} {:>8.2f} {:>8.2f} {:>6.2f}", values_.size(), median,
                           sigma, percentile(magnitude, 0.95),
                           alone > 0.0 ? together / alone : 0.0);
    }

 private:
    std::vector<double> values_;
    std::vector<bool> follows_;
};

/// A share, counted.
struct Share {
    int of = 0;
    int hits = 0;
    void add(bool hit) {
        ++of;
        hits += hit ? 1 : 0;
    }
    [[nodiscard]] std::string text() const {
        return fmt::format("{:>6} {:>8.3f}", of, of > 0 ? static_cast<double>(hits) / of : 0.0);
    }
};

/// Everything that is measured on one rig; a hand that rests and one that moves apart.
struct Measured {
    std::array<std::array<Errors, 3>, 2> palm;  ///< sideways, up and down, to the camera
    std::array<Errors, 2> palm_along;           ///< along the fingers, as a share of the scale
    std::array<Errors, 2> palm_to_thumb;
    std::array<Errors, 2> palm_norm;
    std::array<Errors, 2> radius;
    std::array<Errors, 2> tip;  ///< sideways
    std::array<Errors, 2> tip_norm;
    std::array<Share, kTipGaps_mm.size()> tip_valid;  ///< of those that stand out, by gap
    Share hidden_tip_valid;
    std::array<Errors, kApertures_mm.size()> aperture;
    std::array<Share, kApertures_mm.size()> aperture_known;
    std::array<Errors, 2> extension_straight;
    std::array<Errors, 2> extension_between;
    Errors grab_open;
    Errors grab_between;
    std::array<Errors, 2> confidence;
    Share chirality_unknown;
    Share chirality_wrong;
    std::array<Share, 2> lost;
    std::vector<double> lost_ms;
    std::array<Share, 2> elsewhere;
    Errors normal_deg;
};

class Meter {
 public:
    Meter(const Movement& movement, Measured& out) : motion_(movement), out_(out) {}

    void see(const HandFrame& frame) {
        if (frame.stamp == last_) {
            return;
        }
        const double t = static_cast<double>(frame.stamp.ns) * 1e-9;
        const SeenHand truth =
            look_at(motion_.at(t), motion_.hand(), motion_.person().scale(), corpus_camera());
        constexpr double kClearOfBodyMm = 130.0F;
        const bool clear = truth.in_view && !truth.touches_border &&
                           truth.palm_mm.z() < motion_.person().chest_mm - kClearOfBodyMm;
        const double before = t - 0.05;
        const bool moves =
            (motion_.at(t).palm_mm - motion_.at(before).palm_mm).norm() > kMovesMmps * 0.05F;
        const Hand* nearest = nullptr;
        for (const Hand& hand : frame.all()) {
            if (nearest == nullptr ||
                (hand.palm_mm - truth.palm_mm).norm() < (nearest->palm_mm - truth.palm_mm).norm()) {
                nearest = &hand;
            }
        }
        last_ = frame.stamp;
        if (!clear) {
            follows_ = false;
            lost_since_.reset();
            return;
        }
        out_.lost[moves].add(nearest == nullptr);
        if (nearest == nullptr) {
            follows_ = false;
            lost_since_ = lost_since_ ? lost_since_ : frame.stamp;
            return;
        }
        if (lost_since_) {
            out_.lost_ms.push_back(to_seconds(frame.stamp - *lost_since_) * 1e3);
            lost_since_.reset();
        }
        const bool same = (nearest->palm_mm - truth.palm_mm).norm() < kSameHandMm;
        out_.elsewhere[moves].add(!same);
        if (!same) {
            follows_ = false;
            return;
        }
        compare(*nearest, truth, moves);
        follows_ = true;
    }

 private:
    void compare(const Hand& hand, const SeenHand& truth, bool moves) {
        const float scale = motion_.person().scale();
        const Vec3f off = hand.palm_mm - truth.palm_mm;
        for (int axis = 0; axis < 3; ++axis) {
            out_.palm[moves][static_cast<std::size_t>(axis)].add(off[axis], follows_);
        }
        const auto joint = [&](Joint j) { return truth.joints_mm[static_cast<std::size_t>(j)]; };
        const Vec3f along = (joint(Joint::palm) - joint(Joint::wrist)).normalized();
        const Vec3f to_thumb =
            (joint(Joint::index_proximal) - joint(Joint::little_proximal)).normalized();
        out_.palm_along[moves].add(off.dot(along) / scale, follows_);
        out_.palm_to_thumb[moves].add(off.dot(to_thumb) / scale, follows_);
        out_.palm_norm[moves].add(off.norm(), follows_);
        out_.radius[moves].add((hand.palm_radius_mm - truth.palm_radius_mm) / scale, follows_);
        out_.confidence[moves].add(hand.confidence, follows_);
        constexpr double kDegrees = 57.29577951;
        if (hand.palm_normal.norm() > 0.0F) {
            const double cosine = std::clamp(hand.palm_normal.dot(truth.palm_normal), -1.0F, 1.0F);
            out_.normal_deg.add(std::acos(cosine) * kDegrees, follows_);
        }
        out_.chirality_unknown.add(hand.chirality == Chirality::unknown);
        if (hand.chirality != Chirality::unknown) {
            out_.chirality_wrong.add((hand.chirality == Chirality::right) !=
                                     (motion_.hand() == SimHand::right));
        }
        for (std::size_t f = 0; f < kFingerCount; ++f) {
            const bool valid = hand.fingertips[f].valid;
            if (!truth.tip_seen[f] && truth.tip_gap_mm[f] > kTipGaps_mm[1] * scale) {
                out_.hidden_tip_valid.add(valid);
                continue;
            }
            out_.tip_valid[bin_of(truth.tip_gap_mm[f] / scale, kTipGaps_mm)].add(valid);
            if (!truth.tip_seen[f]) {
                continue;
            }
            if (valid) {
                const Vec3f error = hand.fingertips[f].position_mm - truth.tips_mm[f];
                // A tip with its neighbour's name is an outlier that the 95 % show.
                out_.tip[moves].add(error.x(), false);
                out_.tip_norm[moves].add(error.norm(), false);
            }
            Errors& extension = truth.extension[f] >= 0.999F ? out_.extension_straight[moves]
                                                             : out_.extension_between[moves];
            extension.add(hand.finger_extension[f] - truth.extension[f], false);
        }
        const std::size_t bin = bin_of(truth.aperture_mm, kApertures_mm);
        out_.aperture_known[bin].add(hand.pinch_aperture_mm >= 0.0F);
        if (hand.pinch_aperture_mm >= 0.0F) {
            out_.aperture[bin].add(hand.pinch_aperture_mm - truth.aperture_mm,
                                   follows_ && aperture_bin_ == bin);
        }
        aperture_bin_ = hand.pinch_aperture_mm >= 0.0F ? bin : kApertures_mm.size();
        (truth.grab <= 0.0F ? out_.grab_open : out_.grab_between)
            .add(hand.grab_value - truth.grab, follows_);
    }

    const Movement& motion_;
    Measured& out_;
    Stamp last_;
    bool follows_ = false;
    std::size_t aperture_bin_ = kApertures_mm.size();
    std::optional<Stamp> lost_since_;
};

Result<void> follow(const ImageRig& rig, std::uint64_t seed, Measured& out) {
    // Every shape of a hand that gestures have.
    GestureSettings settings;
    settings.pull = settings.grab = settings.tap = settings.circle = true;
    settings.open_palm = settings.fist = settings.point = settings.victory = true;
    const Sequence sequence =
        perform_all(names_of(settings), before_a_rig(draw_person(seed)), 1, {});
    Meter meter(sequence.hands.front(), out);
    const auto result = run_trial(
        trial_of(sequence, rig, settings), [&meter](Session& session, const SimulatedRig& /*sim*/) {
            session.subscribe_pipeline([&meter](const PipelineView& view) {
                if (view.depth != nullptr && view.camera_hands != nullptr) {
                    meter.see(*view.camera_hands);
                }
            });
        });
    return result ? Result<void>{} : result.error();
}

std::string text_of(const ImageRig& rig, const Measured& m) {
    std::string out = fmt::format("{} {}\n{:<34} {:>6} {:>8} {:>8} {:>8} {:>6}\n", rig.preset,
                                  *rig.method == '\0' ? "grey" : rig.method, "", "n", "median",
                                  "sigma", "95 %", "corr");
    const auto line = [&out](const std::string& name, const std::string& text) {
        out += fmt::format("{:<34} {}\n", name, text);
    };
    constexpr std::array<const char*, 2> kStates{"rests", "moves"};
    constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
    for (std::size_t s = 0; s < kStates.size(); ++s) {
        for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
            line(fmt::format("palm {}, mm, {}", kAxes[axis], kStates[s]), m.palm[s][axis].text());
        }
        line(fmt::format("palm along fingers/scale, {}", kStates[s]), m.palm_along[s].text());
        line(fmt::format("palm to thumb/scale, {}", kStates[s]), m.palm_to_thumb[s].text());
        line(fmt::format("palm, distance, mm, {}", kStates[s]), m.palm_norm[s].text());
        line(fmt::format("radius/scale, mm, {}", kStates[s]), m.radius[s].text());
        line(fmt::format("tip x, mm, {}", kStates[s]), m.tip[s].text());
        line(fmt::format("tip, distance, mm, {}", kStates[s]), m.tip_norm[s].text());
        line(fmt::format("extension of a straight one, {}", kStates[s]),
             m.extension_straight[s].text());
        line(fmt::format("extension of a bent one, {}", kStates[s]), m.extension_between[s].text());
        line(fmt::format("confidence, {}", kStates[s]), m.confidence[s].text());
        line(fmt::format("not seen, share, {}", kStates[s]), m.lost[s].text());
        line(fmt::format("elsewhere, share, {}", kStates[s]), m.elsewhere[s].text());
    }
    line("normal, degrees", m.normal_deg.text());
    line("grab, open hand", m.grab_open.text());
    line("grab, others", m.grab_between.text());
    for (std::size_t b = 0; b < kApertures_mm.size(); ++b) {
        const double least = b == 0 ? 0.0 : kApertures_mm[b - 1];
        line(fmt::format("aperture from {:.0f} mm, mm", least), m.aperture[b].text());
        line(fmt::format("aperture from {:.0f} mm, known", least), m.aperture_known[b].text());
    }
    for (std::size_t b = 0; b < kTipGaps_mm.size(); ++b) {
        line(fmt::format("tips with {:.0f} mm round, valid", b == 0 ? 0.0 : kTipGaps_mm[b - 1]),
             m.tip_valid[b].text());
    }
    line("tips before the palm, valid", m.hidden_tip_valid.text());
    line("chirality unknown, share", m.chirality_unknown.text());
    line("chirality wrong, share", m.chirality_wrong.text());
    if (!m.lost_ms.empty()) {
        line("not seen for, ms, p50 / p95",
             fmt::format("{:>6} {:>8.0f} {:>8.0f}", m.lost_ms.size(), percentile(m.lost_ms, 0.5),
                         percentile(m.lost_ms, 0.95)));
    }
    return out;
}

}  // namespace

Result<std::string> measure_noise(int people) {
    std::string out;
    for (const ImageRig& rig : kImageRigs) {
        Measured measured;
        for (int seed = 1; seed <= people; ++seed) {
            if (auto done = follow(rig, static_cast<std::uint64_t>(seed), measured); !done) {
                return done.error();
            }
        }
        out += (out.empty() ? "" : "\n") + text_of(rig, measured);
    }
    return out;
}

}  // namespace xtrack::tools::corpus
