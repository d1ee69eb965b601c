// SPDX-License-Identifier: Apache-2.0
#include <xtrack/hand_tracker.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/setting_up.hpp"
#include "gestures/segment/segmenter.hpp"
#include "gestures/track/fingers.hpp"
#include "gestures/track/hand_track.hpp"
#include "gestures/track/palm.hpp"

namespace xtrack {

namespace {

constexpr Size kSizeMin{80, 60};
constexpr Size kSizeMax{1920, 1200};
/// A hand is looked for near its prediction while it has been away no longer than this: then only
/// its looks count.
constexpr Duration kPriorAge = std::chrono::milliseconds{120};
/// How far a palm may be from its prediction: what it jumps over at once, and by how much more a
/// second unseen. What is farther is another hand, or the hand of what was taken for one.
constexpr float kJumpMm = 70.0F;
constexpr float kJumpMmps = 600.0F;

struct Number {
    const char* name;
    double TrackerSettings::*value;
};

using S = TrackerSettings;
constexpr std::array kNumbers{
    Number{"near_mm", &S::near_mm},
    Number{"far_mm", &S::far_mm},
    Number{"palm_radius_min_mm", &S::palm_radius_min_mm},
    Number{"palm_radius_max_mm", &S::palm_radius_max_mm},
    Number{"hand_length_max_mm", &S::hand_length_max_mm},
    Number{"hand_area_min_mm2", &S::hand_area_min_mm2},
    Number{"ahead_of_body_mm", &S::ahead_of_body_mm},
    Number{"background_margin_mm", &S::background_margin_mm},
    Number{"reacquire_distance_mm", &S::reacquire_distance_mm},
    Number{"tip_prominence_mm", &S::tip_prominence_mm},
};

Error bad(std::string message) { return {ErrorCode::invalid_argument, std::move(message)}; }

}  // namespace

struct HandTracker::State {
    TrackerSettings settings;
    Size size;
    segment::Segmenter segmenter;
    track::FingerReader reader;
    track::FingerReading reading;
    std::array<track::HandTrack, kMaxHands + 2> tracks;  // seen ones and ones that may come back
    HandFrame frame;
    TrackStatus status = TrackStatus::ok;
    bool started = false;
    Stamp last;
    int next_id = 1;

    /// Gives every region its track: the nearest pairs first, then new ones.
    void match(Stamp stamp, std::span<const HandRegion> regions,
               std::array<track::HandTrack*, kMaxHands>& of_region);
    /// One that no region of this frame has: an ended one, else the one that was away longest.
    track::HandTrack& free_track(const std::array<track::HandTrack*, kMaxHands>& of_region);
};

void HandTracker::State::match(Stamp stamp, std::span<const HandRegion> regions,
                               std::array<track::HandTrack*, kMaxHands>& of_region) {
    of_region.fill(nullptr);
    const auto farthest = static_cast<float>(settings.reacquire_distance_mm);
    for (std::size_t round = 0; round < regions.size(); ++round) {
        float best = 1.0F;  // share of what is allowed
        track::HandTrack* track = nullptr;
        std::size_t region = 0;
        for (track::HandTrack& t : tracks) {
            if (!t.active() ||
                std::find(of_region.begin(), of_region.end(), &t) != of_region.end()) {
                continue;
            }
            const auto unseen_s = static_cast<float>(to_seconds(stamp - t.last_seen()));
            const float limit = std::min(farthest, kJumpMm + kJumpMmps * unseen_s);
            for (std::size_t k = 0; k < regions.size(); ++k) {
                const float d = (t.predict(stamp) - regions[k].palm_mm).norm() / limit;
                if (of_region[k] == nullptr && d <= best) {
                    best = d;
                    track = &t;
                    region = k;
                }
            }
        }
        if (track == nullptr) {
            break;
        }
        of_region[region] = track;
    }
    for (std::size_t k = 0; k < regions.size(); ++k) {
        if (of_region[k] == nullptr) {
            of_region[k] = &free_track(of_region);
            of_region[k]->begin(next_id++);
        }
    }
}

track::HandTrack& HandTracker::State::free_track(
    const std::array<track::HandTrack*, kMaxHands>& of_region) {
    track::HandTrack* oldest = nullptr;
    for (track::HandTrack& t : tracks) {
        if (std::find(of_region.begin(), of_region.end(), &t) != of_region.end()) {
            continue;
        }
        if (!t.active()) {
            return t;
        }
        oldest = oldest == nullptr || t.last_seen() < oldest->last_seen() ? &t : oldest;
    }
    return *oldest;  // there are more tracks than regions
}

const char* to_string(TrackStatus s) noexcept {
    switch (s) {
        case TrackStatus::ok: return "ok";
        case TrackStatus::repeated_stamp: return "repeated stamp";
        case TrackStatus::decreasing_stamp: return "decreasing stamp";
        case TrackStatus::wrong_size: return "wrong size";
        case TrackStatus::not_metric: return "not metric";
    }
    return "unknown";
}

HandTracker::HandTracker(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
HandTracker::HandTracker(HandTracker&&) noexcept = default;
HandTracker& HandTracker::operator=(HandTracker&&) noexcept = default;
HandTracker::~HandTracker() = default;

Result<HandTracker> HandTracker::create(const Rig& rig, Size size,
                                        const TrackerSettings& settings) {
    if (size.width < kSizeMin.width || size.height < kSizeMin.height ||
        size.width > kSizeMax.width || size.height > kSizeMax.height) {
        return bad("hand tracker: depth images of " + std::to_string(size.width) + "x" +
                   std::to_string(size.height) + "; 80x60 to 1920x1200 are possible");
    }
    Rig checked = rig;
    if (checked.camera.size == Size{}) {
        checked.camera.size = size;  // not set: that of the images
    }
    if (auto valid = validate(checked); !valid) {
        return bad("hand tracker: " + valid.error().message);
    }
    if (!(rig.camera.matrix(0, 0) > 1.0) || !(rig.camera.matrix(1, 1) > 1.0)) {
        return bad("hand tracker: camera_matrix: the focal length must be above 1 px; calibrate");
    }
    for (const Number& number : kNumbers) {
        if (!std::isfinite(settings.*number.value)) {
            return bad(std::string("hand tracker: ") + number.name +
                       " is NaN or infinite; give a finite number");
        }
    }
    if (settings.max_hands < 1 || settings.max_hands > static_cast<int>(kMaxHands)) {
        return bad("hand tracker: max_hands must be 1 to " + std::to_string(kMaxHands));
    }
    if (!(settings.palm_radius_min_mm > 0.0) ||
        !(settings.palm_radius_max_mm > settings.palm_radius_min_mm)) {
        return bad("hand tracker: palm radii must satisfy 0 < min < max");
    }
    if (settings.near_mm < 0.0 || settings.far_mm < 0.0 ||
        (settings.far_mm > 0.0 && settings.far_mm <= settings.near_mm)) {
        return bad("hand tracker: near_mm and far_mm must satisfy 0 <= near < far");
    }
    return base::setting_up("HandTracker::create", [&]() -> Result<HandTracker> {
        auto state = std::make_unique<State>();
        state->settings = settings;
        state->size = size;
        state->segmenter.create(rig, size, settings);
        state->reader.create(state->segmenter.grid());
        return HandTracker(std::move(state));
    });
}

const HandFrame& HandTracker::track(const DepthFrame& depth) {
    State& s = *state_;
    if (depth.depth.size() != s.size || !(depth.depth_unit_mm > 0.0)) {
        s.status = TrackStatus::wrong_size;
        return s.frame;
    }
    if (!depth.metric) {
        s.status = TrackStatus::not_metric;
        return s.frame;
    }
    if (s.started && depth.stamp <= s.last) {
        s.status =
            depth.stamp == s.last ? TrackStatus::repeated_stamp : TrackStatus::decreasing_stamp;
        return s.frame;
    }
    s.status = TrackStatus::ok;
    const std::int64_t elapsed_ms =
        s.started ? (depth.stamp - s.last) / std::chrono::milliseconds{1} : 0;
    s.started = true;
    s.last = depth.stamp;

    std::array<segment::PalmPrior, kMaxHands> priors;
    std::size_t prior_count = 0;
    for (track::HandTrack& t : s.tracks) {
        if (t.active() && depth.stamp - t.last_seen() > s.settings.reacquire_time) {
            t.end();
        }
        if (t.active() && depth.stamp - t.last_seen() <= kPriorAge && prior_count < kMaxHands) {
            priors[prior_count++] = {t.predict(depth.stamp), t.arm_direction(), t.palm_radius_mm()};
        }
    }
    s.segmenter.segment(depth, elapsed_ms, {priors.data(), prior_count});

    const auto regions = s.segmenter.regions();
    std::array<track::HandTrack*, kMaxHands> of_region{};
    s.match(depth.stamp, regions, of_region);
    s.frame.stamp = depth.stamp;
    s.frame.span = depth.span;
    s.frame.coordinates = CoordinateFrame::camera;
    s.frame.count = regions.size();
    for (std::size_t k = 0; k < regions.size(); ++k) {
        const segment::Grid& grid = s.segmenter.grid();
        const Vec3f normal = track::fit_palm_normal(grid, s.segmenter.labels(), regions[k]);
        s.reader.read(grid, s.segmenter.labels(), regions[k], normal, of_region[k]->thumb_side(),
                      static_cast<float>(s.settings.tip_prominence_mm), s.reading);
        of_region[k]->update(depth.stamp, regions[k], normal, s.reading, s.settings,
                             s.frame.hands[k]);
    }
    return s.frame;
}

TrackStatus HandTracker::status() const noexcept { return state_->status; }

const HandFrame& HandTracker::hands() const noexcept { return state_->frame; }

HandSegmentation HandTracker::segmentation() const noexcept { return state_->segmenter.view(); }

void HandTracker::reset() noexcept {
    State& s = *state_;
    s.segmenter.reset();
    for (track::HandTrack& t : s.tracks) {
        t.end();
    }
    s.frame = {};
    s.status = TrackStatus::ok;
    s.started = false;
}

}  // namespace xtrack
