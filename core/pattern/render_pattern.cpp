// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include <xtrack/pattern.hpp>

#include "core/pattern/response_curve.hpp"

namespace xtrack {

namespace {

constexpr double kFullLight = 255.0;  // grey levels of an 8-bit picture

double gray_code_bit(const Pattern& p, double x_px) noexcept {
    const double pixel = std::floor(x_px + 0.5);
    const double cell = std::max(0.0, std::floor((pixel + p.offset_px) / p.cell_px));
    const auto index = static_cast<std::uint32_t>(cell);
    const std::uint32_t code = index ^ (index >> 1U);
    const bool set = ((code >> static_cast<unsigned>(p.bits - 1 - p.bit)) & 1U) != 0U;
    return set != p.inverted ? 1.0 : 0.0;
}

// One value for each projector pixel of the coded axis and channel, in the order of the bytes.
std::vector<std::uint8_t> render_profile(const PatternSequence& s, const Pattern& p, int channels,
                                         const std::array<ResponseCurve, 3>& of_colour) {
    const int length = s.coded_length_px();
    std::vector<std::uint8_t> values;
    values.reserve(static_cast<std::size_t>(length) * static_cast<std::size_t>(channels));
    for (int x = 0; x < length; ++x) {
        for (int c = 0; c < channels; ++c) {
            const int colour = channels - 1 - c;  // bytes: blue, green, red
            const double value =
                of_colour[static_cast<std::size_t>(colour)].value(intensity(p, x, colour));
            values.push_back(static_cast<std::uint8_t>(std::lround(value * kFullLight)));
        }
    }
    return values;
}

}  // namespace

double intensity(const Pattern& p, double x_px, int channel) noexcept {
    switch (p.kind) {
        case PatternKind::sine:
        case PatternKind::rgb_sine: {
            const std::size_t i =
                p.kind == PatternKind::sine ? 0 : static_cast<std::size_t>(channel);
            return 0.5 +
                   0.5 * std::cos(2.0 * std::numbers::pi * x_px / p.period_px + p.phase_rad[i]);
        }
        case PatternKind::gray_code: return gray_code_bit(p, x_px);
        case PatternKind::ramp: return x_px / p.period_px - std::floor(x_px / p.period_px);
        case PatternKind::flat: break;
    }
    return p.level;
}

Result<PixelFormat> render_pattern(const PatternSequence& s, int index, Image<std::uint8_t>& out,
                                   GammaCompensation gamma) {
    if (auto ok = validate(s); !ok) {
        return ok.error();
    }
    if (index < 0 || index >= static_cast<int>(s.patterns.size())) {
        return Error{ErrorCode::invalid_argument, "pattern index is " + std::to_string(index) +
                                                      "; give 0 to " +
                                                      std::to_string(s.patterns.size() - 1)};
    }
    std::array<ResponseCurve, 3> of_colour;
    bool colours_differ = false;
    if (gamma == GammaCompensation::precompensate) {
        if (!s.gamma && !s.response) {
            return Error{ErrorCode::unsupported,
                         "gamma and response are unknown; measure the projector's response and set "
                         "it, or render without compensation"};
        }
        for (int c = 0; c < 3; ++c) {
            of_colour[static_cast<std::size_t>(c)] = colour_response(s, c);
        }
        colours_differ = s.response && (s.response->light[1] != s.response->light[0] ||
                                        s.response->light[2] != s.response->light[0]);
    }

    const Pattern& p = s.patterns[static_cast<std::size_t>(index)];
    const PixelFormat format =
        p.kind == PatternKind::rgb_sine || colours_differ ? PixelFormat::bgr8 : PixelFormat::grey8;
    const int channels = format == PixelFormat::bgr8 ? 3 : 1;
    const std::vector<std::uint8_t> profile = render_profile(s, p, channels, of_colour);

    const auto row_bytes = static_cast<std::size_t>(s.projector_size.width * channels);
    out.resize(s.projector_size.width * channels, s.projector_size.height);
    for (int y = 0; y < out.height(); ++y) {
        if (s.axis == Axis::x) {
            std::memcpy(out.row(y), profile.data(), row_bytes);
            continue;
        }
        const std::uint8_t* value = profile.data() + static_cast<std::ptrdiff_t>(y) * channels;
        for (int x = 0; x < out.width(); ++x) {
            out.row(y)[x] = value[x % channels];
        }
    }
    return format;
}

}  // namespace xtrack
