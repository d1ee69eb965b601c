// SPDX-License-Identifier: Apache-2.0
#include <xtrack/light_calibration.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/base/setting_up.hpp"
#include "core/light/colour_test.hpp"
#include "core/light/coordinates.hpp"
#include "core/light/light_samples.hpp"
#include "core/light/ramp.hpp"

namespace xtrack {
namespace {

constexpr std::size_t kLeastLevels = 9;  // of a ramp, black and white among them
// Grey levels that full light must add to a pixel: at half of it the decoder still takes fringes.
constexpr double kLeastRange = 12.0;
constexpr double kLeastShare = 0.01;  // of the image that must be fit to be measured

Error unsupported(const std::string& why) { return {ErrorCode::unsupported, "light: " + why}; }

std::string percent(std::size_t part, std::size_t whole) {
    return std::to_string(100 * part / std::max<std::size_t>(whole, 1)) + " %";
}

}  // namespace

class LightCalibrator::Impl {
 public:
    Impl(const PatternSequence& shown, Size image, const std::optional<Rig>& given)
        : sequence(shown),
          size(image),
          rig(given),
          samples(shown.patterns.size(), image),
          ramp(Ramp::of(shown)),
          colours(colour_patterns(shown)) {}

    [[nodiscard]] Result<void> prepare();
    [[nodiscard]] Result<LightCalibration> finish() const;

    PatternSequence sequence;
    Size size;
    std::optional<Rig> rig;
    LightSamples samples;
    Ramp ramp;
    std::vector<int> colours;
    std::optional<Triangulation> geometry;
    std::optional<GreyCoordinates> coordinates;  // where there are colours

 private:
    [[nodiscard]] bool has_ramp() const { return ramp.steps.size() >= kLeastLevels; }
    [[nodiscard]] bool in_colour(const std::vector<int>& patterns) const {
        return std::all_of(patterns.begin(), patterns.end(),
                           [&](int pattern) { return samples.in_colour(pattern); });
    }
    [[nodiscard]] LightRange range(std::size_t channel, std::size_t pixel) const;
    [[nodiscard]] Result<std::vector<std::size_t>> fit_pixels(std::vector<int> needed) const;
    [[nodiscard]] Result<void> measure_ramp(std::vector<std::size_t>& pixels,
                                            LightCalibration& result,
                                            std::array<std::vector<double>, 4>& shares) const;
    void measure_colours(std::span<const std::size_t> pixels,
                         const std::array<std::vector<double>, 4>& shares,
                         LightCalibration& result) const;
    [[nodiscard]] std::vector<int> flat_patterns() const;
};

Result<void> LightCalibrator::Impl::prepare() {
    const bool flats = !ramp.steps.empty();
    if (flats && !ramp.has_ends()) {
        return unsupported(
            "the flats of the sequence leave out black or white; show levels 0 and 1 "
            "too");
    }
    if (ramp.steps.size() > 2 && !has_ramp()) {
        return unsupported("the ramp is incomplete: it has " + std::to_string(ramp.steps.size()) +
                           " grey levels; show " + std::to_string(kLeastLevels) +
                           " at least, better 18");
    }
    if (!has_ramp() && colours.empty()) {
        return unsupported(
            "the sequence shows neither a ramp of grey levels nor colour fringes; "
            "show that of `xtrack calibrate patterns` (light_sequence())");
    }
    if (!has_ramp() && !sequence.gamma && !sequence.response) {
        return unsupported(
            "the projector's response is not known, and the sequence shows no ramp "
            "of grey levels; show one, or set gamma (1 = linear)");
    }
    if (!flats && (sequence.response || sequence.gamma != 1.0)) {
        return unsupported(
            "without flats of level 0 and 1 black and white are known of a linear "
            "projector (gamma 1) alone; show them");
    }
    if (rig) {
        auto made = Triangulation::create(*rig, sequence.axis, size);
        if (!made) {
            return made.error();
        }
        geometry.emplace(*std::move(made));
    }
    if (!colours.empty()) {
        auto made = GreyCoordinates::create(sequence, size, geometry ? &*geometry : nullptr);
        if (!made) {
            return made.error();
        }
        coordinates.emplace(*std::move(made));
    }
    return {};
}

std::vector<int> LightCalibrator::Impl::flat_patterns() const {
    std::vector<int> patterns;
    for (const Ramp::Step& step : ramp.steps) {
        patterns.push_back(step.pattern);
    }
    return patterns;
}

LightRange LightCalibrator::Impl::range(std::size_t channel, std::size_t pixel) const {
    if (ramp.steps.empty()) {
        return coordinates->range(samples, channel, pixel);
    }
    const double black = samples.level(ramp.black(), channel, pixel);
    return {black, samples.level(ramp.white(), channel, pixel) - black};
}

// What saw all of the patterns, and enough light and not too much of it.
Result<std::vector<std::size_t>> LightCalibrator::Impl::fit_pixels(std::vector<int> needed) const {
    std::vector<std::size_t> pixels;
    std::size_t seen = 0;
    std::size_t clipped = 0;
    for (const int pattern : needed) {
        bool any = false;
        for (std::size_t i = 0; i < samples.count() && !any; ++i) {
            any = samples.seen(pattern, i);
        }
        if (!any) {
            return unsupported("no image shows pattern " + std::to_string(pattern) +
                               " of the sequence; record all of them");
        }
    }
    for (std::size_t i = 0; i < samples.count(); ++i) {
        if (!std::all_of(needed.begin(), needed.end(),
                         [&](int pattern) { return samples.seen(pattern, i); })) {
            continue;
        }
        ++seen;
        if (samples.clipped(i)) {
            ++clipped;
        } else if (range(LightSamples::kLuma, i).range >= kLeastRange) {
            pixels.push_back(i);
        }
    }
    const auto least = static_cast<std::size_t>(kLeastShare * static_cast<double>(samples.count()));
    if (seen <= least) {
        return unsupported("only " + percent(seen, samples.count()) +
                           " of the image saw all of the patterns cleanly; hold each for longer");
    }
    // A bright spot may be left out, but not what most of the light falls on.
    if (clipped > 2 * pixels.size()) {
        return unsupported(percent(clipped, seen) +
                           " of the image is clipped (grey level 255); lower exposure or gain");
    }
    if (pixels.size() <= least) {
        return unsupported("the projector adds " + std::to_string(static_cast<int>(kLeastRange)) +
                           " grey levels to no more than " + percent(pixels.size(), seen) +
                           " of the image: too dark; raise the exposure, or come nearer");
    }
    return pixels;
}

Result<void> LightCalibrator::Impl::measure_ramp(std::vector<std::size_t>& pixels,
                                                 LightCalibration& result,
                                                 std::array<std::vector<double>, 4>& shares) const {
    MeasuredResponse& measured = result.response.emplace();
    std::vector<double>& luma = shares[LightSamples::kLuma];
    luma = ramp_shares(samples, ramp, LightSamples::kLuma, pixels);
    pixels = steady_pixels(samples, ramp, luma, pixels, measured.spread);
    for (std::size_t c = 0; c < shares.size(); ++c) {
        shares[c] = ramp_shares(samples, ramp, c, pixels);
        if (auto ok = check_rising(ramp, shares[c]); !ok) {
            return ok;
        }
        pool_falls(shares[c]);
    }
    measured.pixels = pixels.size();
    return {};
}

void LightCalibrator::Impl::measure_colours(std::span<const std::size_t> pixels,
                                            const std::array<std::vector<double>, 4>& shares,
                                            LightCalibration& result) const {
    const ResponseCurve grey = has_ramp()
                                   ? ResponseCurve(equal_steps(ramp, shares[LightSamples::kLuma]))
                                   : grey_response(sequence);
    const std::vector<float> coordinate_px = coordinates->of(samples, pixels, grey);
    const bool ranges_in_colour =
        in_colour(ramp.steps.empty() ? coordinates->patterns() : flat_patterns());
    ColourTestInput input{.samples = samples,
                          .sequence = sequence,
                          .pixels = pixels,
                          .coordinate_px = coordinate_px,
                          .ranges_in_colour = ranges_in_colour};
    for (const std::size_t pixel : pixels) {
        auto& ranges = input.ranges.emplace_back();
        for (std::size_t c = 0; c < ranges.size(); ++c) {
            ranges[c] = range(c, pixel);
        }
    }
    if (has_ramp()) {
        input.ramp = &ramp;
        std::copy_n(shares.begin(), input.ramp_shares.size(), input.ramp_shares.begin());
    }
    input.geometry = geometry ? &*geometry : nullptr;
    input.rig = rig ? &*rig : nullptr;
    ColourTestResult colour = test_colours(input);
    result.colour = std::move(colour.verdict);
    if (result.response) {
        for (std::size_t k = 0; k < colour.light.size(); ++k) {
            result.response->response.light[k] = equal_steps(ramp, colour.light[k]);
        }
    }
}

Result<LightCalibration> LightCalibrator::Impl::finish() const {
    const auto sees_colour = [&](const std::vector<int>& patterns) {
        return std::any_of(patterns.begin(), patterns.end(),
                           [&](int pattern) { return samples.in_colour(pattern); });
    };
    const bool with_colours =
        !colours.empty() && (sees_colour(colours) || sees_colour(flat_patterns()));
    std::vector<int> needed = flat_patterns();
    if (with_colours) {
        for (const std::vector<int>& more : {coordinates->patterns(), colours}) {
            needed.insert(needed.end(), more.begin(), more.end());
        }
    } else if (!has_ramp()) {
        return unsupported("the colour fringes were seen in grey; colours need a colour camera");
    }
    auto pixels = fit_pixels(std::move(needed));
    if (!pixels) {
        return pixels.error();
    }
    LightCalibration result;
    std::array<std::vector<double>, 4> shares;
    if (has_ramp()) {
        if (auto ok = measure_ramp(*pixels, result, shares); !ok) {
            return ok.error();
        }
        // A grey camera's channels are alike. A colour camera's crosstalk is as the rig knows it,
        // until colour fringes say more.
        std::array<std::vector<double>, 3> of_camera{shares[0], shares[1], shares[2]};
        std::array<std::vector<double>, 3> light = of_camera;
        if (rig && rig->camera_from_projector_rgb && in_colour(flat_patterns())) {
            separate_ramp(ramp, of_camera, *rig->camera_from_projector_rgb, light);
        }
        for (std::size_t k = 0; k < light.size(); ++k) {
            result.response->response.light[k] = equal_steps(ramp, light[k]);
        }
    }
    if (with_colours) {
        measure_colours(*pixels, shares, result);
    }
    if (result.response) {
        for (std::size_t k = 0; k < 3; ++k) {
            result.response->gamma[k] = nearest_gamma(result.response->response.light[k]);
        }
    }
    return result;
}

LightCalibrator::LightCalibrator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LightCalibrator::LightCalibrator(LightCalibrator&&) noexcept = default;
LightCalibrator& LightCalibrator::operator=(LightCalibrator&&) noexcept = default;
LightCalibrator::~LightCalibrator() = default;

Result<LightCalibrator> LightCalibrator::create(const PatternSequence& sequence, Size image,
                                                const std::optional<Rig>& rig) {
    return base::setting_up("LightCalibrator::create", [&]() -> Result<LightCalibrator> {
        if (auto ok = validate(sequence); !ok) {
            return Error{ErrorCode::invalid_argument, "pattern sequence: " + ok.error().message};
        }
        if (!is_image_size(image)) {
            return Error{ErrorCode::invalid_argument,
                         "light: images of " + std::to_string(image.width) + "x" +
                             std::to_string(image.height) + " pixels; give 1 to " +
                             std::to_string(kMaxImageSide_px) + " a side, and 64 million in all"};
        }
        auto impl = std::make_unique<Impl>(sequence, image, rig);
        if (auto ok = impl->prepare(); !ok) {
            return ok.error();
        }
        return LightCalibrator(std::move(impl));
    });
}

Result<void> LightCalibrator::add(const Frame& frame) {
    if (frame.status != FrameStatus::ok || frame.pattern == kUnknownPattern) {
        return {};
    }
    if (frame.size() != impl_->size || frame.pixels.width() != frame.width() * frame.channels()) {
        return Error{ErrorCode::invalid_argument,
                     "light: an image is " + std::to_string(frame.width()) + "x" +
                         std::to_string(frame.height()) + " pixels; give those of " +
                         std::to_string(impl_->size.width) + "x" +
                         std::to_string(impl_->size.height)};
    }
    if (frame.pattern < 0 || frame.pattern >= static_cast<int>(impl_->sequence.patterns.size())) {
        return Error{ErrorCode::invalid_argument,
                     "light: pattern " + std::to_string(frame.pattern) +
                         " is none of the sequence; give 0 to " +
                         std::to_string(impl_->sequence.patterns.size() - 1)};
    }
    return base::setting_up("LightCalibrator::add", [&]() -> Result<void> {
        impl_->samples.add(frame);
        return {};
    });
}

Result<LightCalibration> LightCalibrator::finish() const {
    return base::setting_up("LightCalibrator::finish", [&] { return impl_->finish(); });
}

}  // namespace xtrack
