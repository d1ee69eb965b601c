// SPDX-License-Identifier: Apache-2.0
#include "tools/decode_gamma.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/format.h>
#include <xtrack/depth_decoder.hpp>
#include <xtrack/phase_ripple.hpp>

#include "core/capture/in_recording.hpp"
#include "tools/stream.hpp"

namespace xtrack::tools {

namespace {

constexpr double kLeastGamma = 0.3;
constexpr double kMostGamma = 4.0;

Result<double> number(const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value >= kLeastGamma) ||
        !(value <= kMostGamma)) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("--gamma: '{}' is neither auto nor a number from {} to {}", text,
                                 kLeastGamma, kMostGamma)};
    }
    return value;
}

// Phase of the first complete set, as the camera saw it.
Result<PhaseMap> first_phase(const RecordingReader& recording, const PatternSequence& patterns) {
    DecodeSettings settings;
    settings.keep_maps = true;
    settings.order = OrderSource::none;
    settings.taps = PhaseTaps::least_squares;
    settings.motion = MotionHandling::off;
    auto decoder =
        DepthDecoder::create(recording.rig(), patterns, recording.image_size(), settings);
    if (!decoder) {
        return capture::in_recording(recording.folder(), decoder.error());
    }
    auto source = frame_source(recording);
    if (!source) {
        return source.error();
    }
    for (std::size_t i = 0; i < recording.entries().size(); ++i) {
        const FrameSource::Item item = (*source)->next(Duration::zero());
        if (item.status != SourceStatus::ok) {
            return Error{ErrorCode::malformed, item.message};
        }
        if (decoder->push(item.frame).state == DecodeState::depth_ready) {
            return decoder->phase();
        }
    }
    return no_complete_set(recording);
}

}  // namespace

std::vector<double> shortest_phases(const PatternSequence& patterns) {
    double shortest_px = 0.0;
    std::vector<double> phases;
    for (const Pattern& pattern : patterns.patterns) {
        if (pattern.kind != PatternKind::sine) {
            continue;
        }
        if (phases.empty() || pattern.period_px < shortest_px) {
            shortest_px = pattern.period_px;
            phases.clear();
        }
        if (pattern.period_px == shortest_px) {
            phases.push_back(pattern.phase_rad[0]);
        }
    }
    return phases;
}

std::string gamma_complaint(const std::optional<std::string>& wanted) {
    if (!wanted || *wanted == "auto") {
        return {};
    }
    const auto value = number(*wanted);
    return value ? std::string() : value.error().message;
}

Result<PatternSequence> with_gamma(const RecordingReader& recording,
                                   const std::optional<std::string>& wanted) {
    PatternSequence patterns = recording.patterns();
    if (!wanted) {
        return patterns;
    }
    patterns.response.reset();  // it would go before the gamma
    if (*wanted != "auto") {
        const auto value = number(*wanted);
        if (!value) {
            return value.error();
        }
        patterns.gamma = *value;
        return patterns;
    }
    const std::vector<double> phases_rad = shortest_phases(patterns);
    if (phases_rad.size() != 3) {
        return Error{
            ErrorCode::unsupported,
            fmt::format("{}: --gamma auto: the shortest period has {} grey images, three "
                        "tell the gamma; give a number, or leave it out",
                        (recording.folder() / "pattern.yaml").string(), phases_rad.size())};
    }
    patterns.gamma.reset();
    const auto phase = first_phase(recording, patterns);
    if (!phase) {
        return phase.error();
    }
    const auto gamma = estimate_gamma(*phase, phases_rad);
    if (!gamma) {
        return Error{gamma.error().code,
                     fmt::format("{}: --gamma auto: {}", recording.folder().string(),
                                 gamma.error().message)};
    }
    patterns.gamma = *gamma;
    return patterns;
}

}  // namespace xtrack::tools
