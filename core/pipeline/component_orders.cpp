// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/component_orders.hpp"

#include <algorithm>
#include <cmath>

namespace xtrack {
namespace {

// Pixels are asked on the grid, of large components on every second or fourth line and column of
// it.
constexpr int kLargePixels = 15000;
constexpr int kHugePixels = 60000;
// The ends of the volume are this sharp: three sigma of the phase at weak modulation, turns.
constexpr float kVolumeSlack = 0.1F;
// An order is possible if so much of the component then lies in the volume.
constexpr double kPossibleShare = 0.9;
// Share of the pixels that must agree on where the component was a frame ago.
constexpr double kBeforeShare = 0.25;
// Less is the background itself, turns.
constexpr float kStandsOut = 0.1F;
constexpr int kLeastBridges = 6;
constexpr double kBridgeShare = 0.6;
constexpr int kSureBridges = 12;  // of what moves: fewer are seen at what comes into the light
// A border that motion blurs is off by more than that, but by less than half a fringe: then many
// lines must agree.
constexpr int kRoughBridges = 10;
constexpr double kRoughShare = 0.8;
constexpr int kStrongBridges = 12;
constexpr double kStrongShare = 0.9;
// A surface goes on where so much of the contact says it.
constexpr double kGoesOnShare = 0.7;
// What moves smears its shadow's border: so many images on end must say that a component lies
// elsewhere than it did.
constexpr int kDoubts = 12;
constexpr int kStrongDoubts = 2;  // where many lines say the same

}  // namespace

ComponentOrders::ComponentOrders(Size image, Axis axis, const Triangulation* geometry,
                                 double period_px, int coded_length_px, double most_height_px)
    : size_(image),
      along_x_(axis == Axis::x),
      metric_(geometry != nullptr),
      most_height_(static_cast<float>(most_height_px / period_px)) {
    const Size grid{(image.width + kGrid_px - 1) / kGrid_px,
                    (image.height + kGrid_px - 1) / kGrid_px};
    // Values of a component span at most the projector, and so do orders, both ways.
    const int reach = 2 * static_cast<int>(std::ceil(coded_length_px / period_px)) + 4;
    for (Votes* votes : {&home_, &possible_, &before_, &sure_before_, &bridged_, &sure_bridged_,
                         &behind_, &goes_on_, &rough_, &joined_, &heard_}) {
        votes->create(reach);
    }
    const auto samples =
        static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
    samples_.reserve(samples);
    bridges_.reserve(kMostBridges);
    const auto pixels =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    const auto most = std::min<std::size_t>(pixels, kMaxPhaseComponents);
    orders_.reserve(most);
    ambiguous_.reserve(most);
    ambiguous_before_.reserve(most);
    doubts_.reserve(most);
    doubts_before_.reserve(most);
    evidence_.reserve(most);
    evidence_before_.reserve(most);
    if (!metric_) {
        return;
    }
    low_turns_.resize(grid.width, grid.height);
    high_turns_.resize(grid.width, grid.height);
    const double first_px = -0.5;
    const double last_px = coded_length_px - 0.5;
    for (int j = 0; j < grid.height; ++j) {
        for (int i = 0; i < grid.width; ++i) {
            const auto reached =
                geometry->reach(std::min(i * kGrid_px + kGrid_px / 2, image.width - 1),
                                std::min(j * kGrid_px + kGrid_px / 2, image.height - 1));
            const VolumeReach ends = reached.value_or(VolumeReach{first_px, last_px});
            const double near_px = std::clamp(ends.near_px, first_px, last_px);
            const double far_px = std::clamp(ends.far_px, first_px, last_px);
            far_is_low_ = ends.far_px <= ends.near_px;
            low_turns_.at(i, j) = static_cast<float>(std::min(near_px, far_px) / period_px);
            high_turns_.at(i, j) = static_cast<float>(std::max(near_px, far_px) / period_px);
        }
    }
}

void ComponentOrders::forget() noexcept {
    orders_.clear();
    ambiguous_.clear();
    doubts_.clear();
    evidence_.clear();
    recent_.reset();
    backdrop_.reset();
    standing_out_ = 0.0;
    shadows_ = 0;
}

float ComponentOrders::value_at(const Input& input, int x, int y,
                                std::uint16_t& id) const noexcept {
    const PhasePlace place = input.unwrapper.place(x, y);
    id = place.component;
    return kPerTurn * input.phase_rad.at(x, y) + static_cast<float>(place.turns);
}

void ComponentOrders::sample(const Input& input, const PhaseComponent& component) noexcept {
    samples_.clear();
    const int step = kGrid_px * (component.pixels >= kHugePixels    ? 4
                                 : component.pixels >= kLargePixels ? 2
                                                                    : 1);
    const auto first = [&](int begin) { return (begin + step - 1) / step * step + kGrid_px / 2; };
    for (int y = first(component.top_px - kGrid_px / 2); y <= component.bottom_px; y += step) {
        for (int x = first(component.left_px - kGrid_px / 2); x <= component.right_px; x += step) {
            std::uint16_t id = 0;
            const float value = value_at(input, x, y, id);
            if (id == component.id) {
                samples_.push_back({x, y, value});
            }
        }
    }
    if (samples_.empty()) {
        std::uint16_t id = 0;
        samples_.push_back({component.seed_x_px, component.seed_y_px,
                            value_at(input, component.seed_x_px, component.seed_y_px, id)});
    }
    mean_ = 0.0F;
    for (const Sample& s : samples_) {
        mean_ += s.value / static_cast<float>(samples_.size());
    }
}

void ComponentOrders::vote(const Input& input, const Sample& s) noexcept {
    float home = 0.0F;
    if (metric_) {
        const float low = low_turns_.at(s.x / kGrid_px, s.y / kGrid_px);
        const float high = high_turns_.at(s.x / kGrid_px, s.y / kGrid_px);
        home = 0.5F * (low + high);
        const int first = static_cast<int>(std::ceil(low - kVolumeSlack - s.value));
        const int last = static_cast<int>(std::floor(high + kVolumeSlack - s.value));
        for (int order = first; order <= last; ++order) {
            possible_.add(order);
        }
    }
    home_.add(static_cast<int>(std::lround(home - s.value)));
    const float before = kPerTurn * input.before_rad.at(s.x, s.y);
    const std::uint16_t id = input.component_before.at(s.x, s.y);
    // What was background, or stood still, says nothing of what has come before it.
    if (id != 0 && id <= ambiguous_before_.size() && std::isfinite(before) &&
        (metric_ || std::fabs(before) > kStandsOut)) {
        const auto order = static_cast<int>(std::lround(before - s.value));
        before_.add(order);
        doubt_ = std::max<int>(doubt_, doubts_before_[id - 1U]);
        hear(id, order);
        if (ambiguous_before_[id - 1U] == 0) {
            sure_before_.add(order);
        }
    }
}

// Turns that a pixel shows of what is so far away: of depths a share of the volume, of heights
// turns.
float ComponentOrders::turns_at(const Sample& s, float distance) const noexcept {
    if (!metric_) {
        return distance;
    }
    const float low = low_turns_.at(s.x / kGrid_px, s.y / kGrid_px);
    const float high = high_turns_.at(s.x / kGrid_px, s.y / kGrid_px);
    return low + distance * (high - low);
}

// The inverse: of the component at hand with this order, its mean.
float ComponentOrders::distance_of(int order) const noexcept {
    float sum = 0.0F;
    for (const Sample& s : samples_) {
        const float zero = turns_at(s, 0.0F);
        sum += (s.value + static_cast<float>(order) - zero) / (turns_at(s, 1.0F) - zero);
    }
    return sum / static_cast<float>(samples_.size());
}

// What a pixel shows when nothing is before it, turns; NaN: nobody knows.
float ComponentOrders::known_behind(const Input& input, const Sample& s) const noexcept {
    const float known = kPerTurn * input.known_rad.at(s.x, s.y);
    if (std::isfinite(known)) {
        return known;
    }
    return backdrop_ ? turns_at(s, *backdrop_) : metric_ ? known : 0.0F;
}

void ComponentOrders::vote_behind(const Input& input, const Sample& s) noexcept {
    if (input.known_rad.empty() || front_ == 0.0) {
        return;
    }
    const float seen = kPerTurn * input.known_rad.at(s.x, s.y);
    if (std::isfinite(seen)) {
        known_off_ += seen - s.value;
        ++known_samples_;
    }
    const float known = known_behind(input, s);
    if (std::isfinite(known)) {
        const auto front = static_cast<float>(front_);
        behind_.add(static_cast<int>(std::ceil(front * (known - s.value) - kVolumeSlack)));
    }
}

bool ComponentOrders::in_front(int order) const noexcept {
    return behind_.total() == 0 || static_cast<int>(front_) * order >= nearest_known_;
}

// Of what has come to light. It lies where nothing is known, or behind what is.
bool ComponentOrders::uncovered(int order) const noexcept {
    const auto known = static_cast<float>(known_samples_);
    return !metric_ || 2 * known_samples_ < static_cast<int>(samples_.size()) ||
           static_cast<float>(front_) * (static_cast<float>(order) * known - known_off_) <=
               kStandsOut * known;
}

bool ComponentOrders::is_possible(int order) const noexcept {
    return in_front(order) &&
           (metric_ ? possible_.of(order) >= kPossibleShare * static_cast<double>(samples_.size())
                    : std::fabs(mean_ + static_cast<float>(order)) <= most_height_);
}

// Where the last thing was that moved; else the farthest place before what stands still.
int ComponentOrders::newcomer() const noexcept {
    if (recent_) {
        float off = 0.0F;
        for (const Sample& s : samples_) {
            off += turns_at(s, *recent_) - s.value;
        }
        const auto order = static_cast<int>(std::lround(off / static_cast<float>(samples_.size())));
        if (is_possible(order)) {
            return order;
        }
    }
    constexpr int kTried = 16;
    for (int n = 0; behind_.total() > 0 && n < kTried; ++n) {
        const int order = static_cast<int>(front_) * (nearest_known_ + n);
        if (is_possible(order)) {
            return order;
        }
    }
    return home_.best();
}

// The largest thing that moves is where others will be, or it itself if it is lost for a while.
void ComponentOrders::remember(const Input& input, std::size_t index) noexcept {
    if (index != 0 || input.components[0].pixels < kBridgeablePixels || (!moving_ && !metric_)) {
        return;
    }
    (moving_ ? recent_ : backdrop_) = distance_of(orders_[index]);
}

void ComponentOrders::vote_bridges(const Input& input, std::uint16_t id) noexcept {
    bridge_misses_ = 0;
    touch_misses_ = 0;
    joint_misses_ = 0;
    for (const Bridge& bridge : bridges_) {
        const auto is_known = [&](std::uint16_t other) { return other < id || other == kStill; };
        const bool forth = bridge.to == id && is_known(bridge.from);
        const bool back = bridge.from == id && is_known(bridge.to);
        if (!forth && !back) {
            continue;
        }
        const std::uint16_t other = forth ? bridge.from : bridge.to;
        const bool stands = other == kStill;
        const std::size_t known = other - 1U;
        if (!stands && input.components[known].pixels < kBridgeablePixels) {
            continue;
        }
        const int order = (stands ? 0 : orders_[known]) + (forth ? bridge.orders : -bridge.orders);
        if (bridge.touch) {
            goes_on_.add(order, bridge.fits ? 1 : 0);
            touch_misses_ += bridge.fits ? 0 : 1;
            continue;
        }
        if (bridge.joint) {
            joined_.add(order, bridge.fits ? 1 : 0);
            joint_misses_ += bridge.fits ? 0 : 1;
            continue;
        }
        // Nothing is behind the background: that gap is no shadow.
        const bool behind =
            !in_front(order) ||
            (!metric_ && input.front * static_cast<double>(mean_ + static_cast<float>(order)) <
                             -static_cast<double>(kStandsOut));
        rough_.add(order, behind ? 0 : 1);
        if (!bridge.fits || behind) {
            bridge_misses_ += behind ? 0 : 1;
            continue;
        }
        bridged_.add(order);
        if (stands || ambiguous_[known] == 0) {
            sure_bridged_.add(order);
        }
    }
}

// True of lesser things at the largest one that moves.
bool ComponentOrders::beside_largest(const Input& input, std::size_t index) const noexcept {
    constexpr int kBeside_px = 12;
    const PhaseComponent& a = input.components[0];
    const PhaseComponent& b = input.components[index];
    return moving_ && index > 0 && a.pixels >= kBridgeablePixels && 2 * b.pixels < a.pixels &&
           b.left_px <= a.right_px + kBeside_px && a.left_px <= b.right_px + kBeside_px &&
           b.top_px <= a.bottom_px + kBeside_px && a.top_px <= b.bottom_px + kBeside_px;
}

void ComponentOrders::decide(const Input& input, std::size_t index) noexcept {
    const double samples = static_cast<double>(samples_.size());
    int count = 0;
    int least = 0;
    int most = 0;
    for (int order = possible_.low(); order <= possible_.high(); ++order) {
        if (is_possible(order)) {
            least = count++ == 0 ? order : least;
            most = order;
        }
    }
    const int bridged = bridged_.best();
    const int before = before_.best();
    const bool shadow = bridged_.of(bridged) >= kLeastBridges && is_possible(bridged) &&
                        bridged_.of(bridged) >= kBridgeShare * (bridged_.total() + bridge_misses_);
    const bool tracked = before_.of(before) >= kBeforeShare * samples && is_possible(before);
    const bool sure_before = tracked && 2 * sure_before_.of(before) >= before_.of(before);
    const int rough = rough_.best();
    const bool roughly = rough_.of(rough) >= kRoughBridges && is_possible(rough) &&
                         rough_.of(rough) >= kRoughShare * rough_.total();
    const int joined = joined_.best();
    const bool joint = joined_.of(joined) >= kLeastBridges && is_possible(joined) &&
                       joined_.of(joined) >= kGoesOnShare * (joined_.total() + joint_misses_);
    const bool doubted = tracked && ((shadow && bridged != before) || (roughly && rough != before));
    const bool strongly = roughly && rough_.of(rough) >= kStrongBridges &&
                          rough_.of(rough) >= kStrongShare * rough_.total();
    const int enough = strongly ? kStrongDoubts : kDoubts;
    // Of depths all that was said is weighed, of heights the last word.
    const int told = best_told(least, most);
    const bool convinced = tracked && told != before && is_convincing(told, least, most);
    doubts_[index] = doubted && (metric_ || doubt_ < enough)
                         ? static_cast<std::uint8_t>(std::min(doubt_ + 1, kDoubts))
                         : 0;
    bool sure = false;
    const bool largest = index == 0 && !moving_;
    int order = largest ? home_.best() : newcomer();
    const int on = goes_on_.best();
    const bool goes_on = goes_on_.of(on) >= kLeastBridges && uncovered(on) &&
                         goes_on_.of(on) >= kGoesOnShare * (goes_on_.total() + touch_misses_);
    if (goes_on) {
        // What something that moved has uncovered; that lay before what is known.
        order = on;
        sure = true;
    } else if (metric_ && count <= 1) {
        // Where none is possible the most of it is kept, and the volume cuts off the rest.
        order = count == 1 ? least : possible_.best();
        sure = count == 1;
    } else if (!metric_ && largest) {
        sure = true;  // what most of the image is, is the background
    } else if (convinced) {
        order = told;
        sure = true;
    } else if (shadow && doubts_[index] == 0) {
        order = bridged;
        sure = 2 * sure_bridged_.of(bridged) >= bridged_.of(bridged) &&
               (!moving_ || bridged_.of(bridged) >= kSureBridges);
    } else if (joint && !tracked) {
        order = joined;
        sure = ambiguous_[0] == 0;
    } else if (beside_largest(input, index) && is_possible(newcomer())) {
        // A finger that was cut off: a fringe is longer than a hand.
        order = newcomer();
        sure = ambiguous_[0] == 0;
    } else if (roughly && (doubts_[index] == 0 || !sure_before)) {
        order = rough;
        sure = tracked && rough == before;
    } else if (tracked) {
        order = before;
        sure = sure_before;
    } else if (largest) {
        // The same: the farthest that it can be.
        order = far_is_low_ ? least : most;
    } else if (!is_possible(order)) {
        order = metric_ ? possible_.best() : home_.best();
    }
    orders_[index] = order;
    ambiguous_[index] = sure ? 0 : 1;
    keep_evidence(index);
}

void ComponentOrders::choose(const Input& input) noexcept {
    ambiguous_before_.swap(ambiguous_);
    doubts_before_.swap(doubts_);
    evidence_before_.swap(evidence_);
    evidence_.assign(input.components.size(), Evidence{});
    doubts_.assign(input.components.size(), 0);
    orders_.assign(input.components.size(), 0);
    ambiguous_.assign(input.components.size(), 1);
    standing_out_ = 0.0;
    front_ = metric_ ? (far_is_low_ ? 1.0 : -1.0) : input.front;
    moving_ = input.still_pixels > (input.components.empty() ? 0 : input.components[0].pixels);
    find_bridges(input);
    count_shadows(input);
    for (std::size_t i = 0; i < std::min(input.components.size(), kMostComponents); ++i) {
        doubt_ = 0;
        known_off_ = 0.0F;
        known_samples_ = 0;
        sample(input, input.components[i]);
        for (const Sample& s : samples_) {
            vote(input, s);
            if (i > 0 || moving_) {
                vote_behind(input, s);
            }
        }
        nearest_known_ = behind_.reached(kPossibleShare);
        vote_bridges(input, input.components[i].id);
        decide(input, i);
        remember(input, i);
        for (Votes* votes : {&home_, &possible_, &before_, &sure_before_, &bridged_, &sure_bridged_,
                             &behind_, &goes_on_, &rough_, &joined_, &heard_}) {
            votes->clear();
        }
        for (const Sample& s : samples_) {
            const float height = s.value + static_cast<float>(orders_[i]);
            standing_out_ += std::fabs(height) > kStandsOut && ambiguous_[i] == 0
                                 ? static_cast<double>(height)
                                 : 0.0;
        }
    }
    for (std::size_t i = kMostComponents; i < input.components.size(); ++i) {
        const PhaseComponent& c = input.components[i];
        std::uint16_t id = 0;
        const float value = value_at(input, c.seed_x_px, c.seed_y_px, id);
        const int gx = c.seed_x_px / kGrid_px;
        const int gy = c.seed_y_px / kGrid_px;
        const float home = metric_ ? 0.5F * (low_turns_.at(gx, gy) + high_turns_.at(gx, gy)) : 0.0F;
        orders_[i] = static_cast<std::int32_t>(std::lround(home - value));
    }
}

}  // namespace xtrack
