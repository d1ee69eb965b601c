// SPDX-License-Identifier: Apache-2.0
#include <xtrack/relative_depth.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/setting_up.hpp"
#include "core/unwrap/reference_plane.hpp"
#include "core/unwrap/spatial.hpp"

namespace xtrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr auto kTurn = static_cast<float>(2.0 * std::numbers::pi);
// Heights beyond this stand out from the background.
constexpr float kStandsOutRad = 0.5F;

Error wrong_size(const char* call) {
    return {ErrorCode::invalid_argument,
            std::string(call) + ": the phase is not of the size given to create()"};
}

}  // namespace

struct RelativeDepth::Impl {
    Impl(Size image, SpatialUnwrapper made)
        : size(image),
          unwrapper(std::move(made)),
          unwrapped(image.width, image.height, kNone),
          height(image.width, image.height, kNone),
          component(image.width, image.height, 0) {}

    [[nodiscard]] bool fits(const PhaseMap& map) const {
        return map.phase_rad.size() == size && map.modulation.size() == size;
    }
    void subtract_background(const PhaseMap& map);
    bool subtract_plane(std::span<const PhaseComponent> components);
    void level(std::span<const PhaseComponent> components);
    void turn_up();

    Size size;
    Stamp stamp;
    SpatialUnwrapper unwrapper;
    Image<float> unwrapped;
    Image<float> height;
    Image<std::uint16_t> component;
    Image<float> background;  // wrapped; empty: none was learnt
};

void RelativeDepth::Impl::subtract_background(const PhaseMap& map) {
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            unwrapped.at(x, y) =
                std::remainder(map.phase_rad.at(x, y) - background.at(x, y), kTurn);
        }
    }
}

bool RelativeDepth::Impl::subtract_plane(std::span<const PhaseComponent> components) {
    if (components.empty()) {
        return false;
    }
    const auto plane =
        ReferencePlane::fit(unwrapped.view(), component.view(), components.front().id);
    if (!plane) {
        return false;
    }
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            height.at(x, y) = unwrapped.at(x, y) - static_cast<float>(plane->at(x, y));
        }
    }
    return true;
}

// Whole turns that put each component nearest to the background.
void RelativeDepth::Impl::level(std::span<const PhaseComponent> components) {
    std::vector<float> heights;
    for (const PhaseComponent& of : components) {
        heights.clear();
        for (int y = of.top_px; y <= of.bottom_px; ++y) {
            for (int x = of.left_px; x <= of.right_px; ++x) {
                if (component.at(x, y) == of.id && std::isfinite(height.at(x, y))) {
                    heights.push_back(height.at(x, y));
                }
            }
        }
        if (heights.empty()) {
            continue;
        }
        const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
        std::nth_element(heights.begin(), middle, heights.end());
        const float turns = kTurn * std::nearbyint(*middle / kTurn);
        for (int y = of.top_px; turns != 0.0F && y <= of.bottom_px; ++y) {
            for (int x = of.left_px; x <= of.right_px; ++x) {
                if (component.at(x, y) == of.id) {
                    height.at(x, y) -= turns;
                }
            }
        }
    }
}

// Whether more phase is nearer depends on which side the projector stands.
void RelativeDepth::Impl::turn_up() {
    double sum = 0.0;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const float h = height.at(x, y);
            sum += std::fabs(h) > kStandsOutRad ? static_cast<double>(h) : 0.0;  // NaN: no
        }
    }
    for (int y = 0; sum < 0.0 && y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            height.at(x, y) = -height.at(x, y);
        }
    }
}

Result<RelativeDepth> RelativeDepth::create(Size image) {
    return base::setting_up("RelativeDepth::create", [&]() -> Result<RelativeDepth> {
        auto unwrapper = SpatialUnwrapper::create(image, {});
        if (!unwrapper) {
            return unwrapper.error();
        }
        return RelativeDepth(std::make_unique<Impl>(image, std::move(*unwrapper)));
    });
}

RelativeDepth::RelativeDepth(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
RelativeDepth::RelativeDepth(RelativeDepth&&) noexcept = default;
RelativeDepth& RelativeDepth::operator=(RelativeDepth&&) noexcept = default;
RelativeDepth::~RelativeDepth() = default;

Result<void> RelativeDepth::learn_background(const PhaseMap& map) {
    if (!impl_->fits(map)) {
        return wrong_size("RelativeDepth::learn_background");
    }
    return base::setting_up("RelativeDepth::learn_background", [&]() -> Result<void> {
        impl_->background = map.phase_rad;
        return {};
    });
}

Result<void> RelativeDepth::measure(const PhaseMap& map) {
    if (!impl_->fits(map)) {
        return wrong_size("RelativeDepth::measure");
    }
    return base::setting_up("RelativeDepth::measure", [&]() -> Result<void> {
        Impl& impl = *impl_;
        impl.stamp = map.stamp;
        const bool learnt = !impl.background.empty();
        if (learnt) {
            impl.subtract_background(map);
        } else {
            impl.unwrapped = map.phase_rad;
        }
        const auto components = impl.unwrapper.unwrap(impl.unwrapped.view(), map.modulation.view(),
                                                      impl.unwrapped.view(), impl.component.view());
        if (learnt) {
            impl.height = impl.unwrapped;
        } else if (!impl.subtract_plane(components)) {
            impl.height.fill(kNone);
            return Error{ErrorCode::unsupported,
                         "relative depth: too little of the image is one surface; show the empty "
                         "scene first, or more of the wall"};
        }
        impl.level(components);
        impl.turn_up();
        return {};
    });
}

const Image<float>& RelativeDepth::unwrapped_rad() const noexcept { return impl_->unwrapped; }
const Image<float>& RelativeDepth::height_rad() const noexcept { return impl_->height; }
const Image<std::uint16_t>& RelativeDepth::component() const noexcept { return impl_->component; }

DepthFrame RelativeDepth::depth() const {
    const Impl& impl = *impl_;
    DepthFrame frame;
    frame.stamp = impl.stamp;
    frame.metric = false;
    frame.depth = Image<std::uint16_t>(impl.size.width, impl.size.height, 0);
    constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
    for (int y = 0; y < impl.size.height; ++y) {
        for (int x = 0; x < impl.size.width; ++x) {
            const auto h = static_cast<double>(impl.height.at(x, y));
            if (std::isfinite(h)) {
                const double steps = (kBackground_mm - kPerRadian_mm * h) / frame.depth_unit_mm;
                frame.depth.at(x, y) =
                    static_cast<std::uint16_t>(std::lround(std::clamp(steps, 1.0, kMost)));
            }
        }
    }
    return frame;
}

}  // namespace xtrack
