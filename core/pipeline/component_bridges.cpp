// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/pipeline/component_orders.hpp"

namespace xtrack {
namespace {

// Shadows: their width, how far from their border the phase is not mixed, and how far from there
// its slope is measured, px.
constexpr int kLeastShadow_px = 2;
constexpr int kShadowsOfImage = 3;  // a third of the image at most
constexpr int kClear_px = 2;
constexpr int kMostClear_px = 5;
constexpr int kSlope_px = 4;
// The fringe goes on across a shadow if it is off by no more, turns; a gap that is no shadow fits
// by chance in a quarter of its lines.
constexpr float kBridgeFit = 0.12F;
// A surface goes on where it touches another without a shadow if its fringe does, and its light is
// the same but for this factor.
constexpr float kAlike = 1.2F;
// What was cut in two, where its light changes or where it happens to look as what stands still
// behind it did: how wide the cut is at most, px, and of how many pixels the smaller part is.
constexpr int kMostCut_px = 40;
constexpr float kUneven = 0.1F;  // turns
constexpr int kLeastPart = 200;

}  // namespace

bool ComponentOrders::Line::stands(int i) const noexcept {
    return still_rad != nullptr && std::isfinite(still_rad[i * next_still]);
}

bool ComponentOrders::Line::seen(int i) const noexcept {
    return std::isfinite(phase_rad[i * next]);
}

ComponentOrders::Line ComponentOrders::line_of(const Input& input, int number,
                                               bool along_x) const noexcept {
    const auto begin = [&](const ImageView<const float>& image) {
        return image.empty() ? nullptr : along_x ? image.row(number) : image.data + number;
    };
    const auto step = [&](const ImageView<const float>& image) {
        return along_x ? std::ptrdiff_t{1} : image.stride;
    };
    const ImageView<const float>& all = input.all_rad.empty() ? input.phase_rad : input.all_rad;
    return {begin(all),
            begin(input.still_rad),
            begin(input.modulation),
            step(all),
            step(input.still_rad),
            step(input.modulation),
            number,
            along_x ? size_.width : size_.height,
            along_x};
}

float ComponentOrders::edge(const Input& input, const Line& line, int border, int away,
                            std::uint16_t& id) const noexcept {
    const auto raw_at = [&](int i, std::uint16_t& of) {
        const int x = line.x(i);
        const int y = line.y(i);
        const float taken_off =
            input.reference_rad.empty() ? 0.0F : kPerTurn * input.reference_rad.at(x, y);
        if (line.stands(i)) {
            of = kStill;
            return kPerTurn * line.still_rad[i * line.next_still] + taken_off;
        }
        return value_at(input, x, y, of) + taken_off;
    };
    // Some pixels of the border may have been taken out.
    int clear_px = kClear_px;
    float clear = raw_at(border + away * clear_px, id);
    while (id == 0 && clear_px < kMostClear_px) {
        ++clear_px;
        clear = raw_at(border + away * clear_px, id);
    }
    std::uint16_t beyond = 0;
    const float far = raw_at(border + away * (clear_px + kSlope_px), beyond);
    id = id == beyond ? id : std::uint16_t{0};
    return clear + static_cast<float>(clear_px) / kSlope_px * (clear - far);
}

// Where a projector's shadow lies between two surfaces, the ray that grazes one of them arrives at
// the other: the projector's phase goes on across it, turns and all. Where there is no shadow it
// goes on within one surface alone, and so does the light.
void ComponentOrders::add_bridge(const Input& input, const Line& line, int from, int to) noexcept {
    Bridge bridge;
    bridge.touch = to == from + 1;
    const float left = edge(input, line, from, -1, bridge.from);
    const float right = edge(input, line, to, 1, bridge.to);
    if (bridge.from == bridge.to || bridge.from == 0 || bridge.to == 0 ||
        !std::isfinite(left - right)) {
        return;
    }
    const float orders = std::nearbyint(left - right);
    bridge.orders = static_cast<std::int32_t>(orders);
    bridge.fits = std::fabs(left - right - orders) <= kBridgeFit;
    if (bridge.touch) {
        const float a = line.modulation[(from - kClear_px) * line.next_modulation];
        const float b = line.modulation[(to + kClear_px) * line.next_modulation];
        bridge.fits = bridge.fits && a < kAlike * b && b < kAlike * a;
    }
    if (!input.reference_rad.empty()) {
        const auto taken_off = [&](int i) { return input.reference_rad.at(line.x(i), line.y(i)); };
        bridge.rise = kPerTurn * (taken_off(to) - taken_off(from));
    }
    bridges_.push_back(bridge);
}

void ComponentOrders::bridge_line(const Input& input, int number) noexcept {
    const Line line = line_of(input, number, along_x_);
    constexpr int kMargin = kMostClear_px + kSlope_px;
    int last_seen = -1;
    for (int i = 0; i < line.length; ++i) {
        if (!line.seen(i)) {
            continue;
        }
        const int gap = i - last_seen - 1;
        const int from = last_seen;
        last_seen = i;
        const bool touch = gap == 0 && line.modulation != nullptr && from >= 0 &&
                           line.stands(from) != line.stands(i);  // or an outline, which is of none
        if (!(touch || (gap >= kLeastShadow_px && gap <= line.length / kShadowsOfImage)) ||
            from < kMargin || i + kMargin >= line.length || bridges_.size() >= kMostBridges) {
            continue;
        }
        add_bridge(input, line, from, i);
    }
}

// Parts of one thing: from one to the other the phase goes on evenly. Between two things, or a
// thing and what is seen beside it, there are steps.
void ComponentOrders::add_joint(const Input& input, const Line& line, int from, int to) noexcept {
    Bridge bridge;
    bridge.joint = true;
    const float begin = value_at(input, line.x(from), line.y(from), bridge.from);
    const float end = value_at(input, line.x(to), line.y(to), bridge.to);
    const auto step = [&](int i) {
        const float turns =
            kPerTurn * (line.phase_rad[(i + 1) * line.next] - line.phase_rad[i * line.next]);
        return turns - std::nearbyint(turns);
    };
    float rise = 0.0F;
    for (int i = from; i < to; ++i) {
        rise += step(i);
    }
    if (!std::isfinite(rise)) {
        return;  // a shadow
    }
    bridge.orders = static_cast<std::int32_t>(std::nearbyint(begin + rise - end));
    bridge.fits = true;
    float risen = 0.0F;
    for (int i = from; i < to && bridge.fits; ++i) {
        risen += step(i);
        const float even = rise * static_cast<float>(i + 1 - from) / static_cast<float>(to - from);
        bridge.fits = std::fabs(risen - even) <= kUneven;
    }
    bridges_.push_back(bridge);
}

void ComponentOrders::join_line(const Input& input, int number, bool along_x) noexcept {
    const Line line = line_of(input, number, along_x);
    constexpr int kMargin = kMostClear_px + kSlope_px;
    int last = -1;
    std::uint16_t last_id = 0;
    for (int i = kMargin; i + kMargin < line.length && bridges_.size() < kMostBridges; ++i) {
        if (!line.seen(i) || line.stands(i)) {
            continue;
        }
        const std::uint16_t id = input.unwrapper.place(line.x(i), line.y(i)).component;
        if (id == 0 || input.components[id - 1U].pixels < kLeastPart) {
            continue;
        }
        const int cut_px = i - last - 1;
        if (last_id != 0 && id != last_id && cut_px <= kMostCut_px) {
            add_joint(input, line, last, i);
        }
        last = i;
        last_id = id;
    }
}

void ComponentOrders::find_bridges(const Input& input) noexcept {
    bridges_.clear();
    if (input.components.size() + (input.still_pixels > 0 ? 1 : 0) < 2) {
        return;
    }
    const int lines = along_x_ ? size_.height : size_.width;
    for (int line = kGrid_px / 2; line < lines; line += kGrid_px) {
        bridge_line(input, line);
    }
    if (!metric_ || !moving_) {
        return;
    }
    for (int y = kGrid_px / 2; y < size_.height; y += kGrid_px) {
        join_line(input, y, true);
    }
    for (int x = kGrid_px / 2; x < size_.width; x += kGrid_px) {
        join_line(input, x, false);
    }
}

// A thing casts its shadow to one side. As the phase goes on across it, the thing's height is what
// the background rises by between the two: which says whether more phase is nearer.
void ComponentOrders::count_shadows(const Input& input) noexcept {
    shadows_ = 0;
    const std::uint16_t background = moving_ ? kStill : std::uint16_t{1};
    const auto is_thing = [&](std::uint16_t id) {
        return id != background && id != kStill &&
               input.components[id - 1U].pixels >= kBridgeablePixels;
    };
    for (const Bridge& bridge : bridges_) {
        if (!bridge.fits || bridge.touch || bridge.joint || bridge.rise == 0.0F) {
            continue;
        }
        const int way = bridge.rise > 0.0F ? 1 : -1;
        if (bridge.to == background && is_thing(bridge.from)) {
            shadows_ += way;
        } else if (bridge.from == background && is_thing(bridge.to)) {
            shadows_ -= way;
        }
    }
}

}  // namespace xtrack
