// SPDX-License-Identifier: Apache-2.0
#include "tools/decode_choice.hpp"

#include <utility>

#include "core/capture/in_recording.hpp"
#include "tools/settings_option.hpp"

namespace xtrack::tools {

Result<ChosenDecoder> choose_decoder(const RecordingReader& recording,
                                     const PatternSequence& patterns,
                                     const DecodeOptions& options) {
    DecodeSettings settings;
    settings.min_modulation = options.min_modulation;
    // One set of patterns is all there is to the first depth; a stream has more to average over.
    settings.taps = options.all ? PhaseTaps::automatic : PhaseTaps::least_squares;
    settings.motion = options.all ? MotionHandling::follow : MotionHandling::off;
    if (const auto set = apply_settings(options.changes, settings); !set) {
        return set.error();
    }
    settings.keep_maps = true;  // what the files are written from
    const auto create = [&](OrderSource order) {
        settings.order = order;
        return DepthDecoder::create(recording.rig(), patterns, recording.image_size(), settings);
    };
    Error refusal{
        ErrorCode::unsupported,
        "no rig.yaml: no millimetres, heights have no scale, and what stands out most is taken to "
        "be nearer; add the calibration"};
    if (recording.has_rig()) {
        const OrderSource wanted =
            options.order_from.empty() ? OrderSource::automatic : OrderSource::depth_image;
        auto decoder = create(wanted);
        if (decoder) {
            return ChosenDecoder{
                std::move(*decoder),
                true,
                options.order_from.empty() ? "order from the patterns" : "order from a depth image",
                {}};
        }
        refusal = decoder.error();
        if (refusal.code != ErrorCode::unsupported || !options.order_from.empty()) {
            return capture::in_recording(recording.folder(), refusal);
        }
    }
    auto decoder = create(OrderSource::none);
    if (!decoder) {
        return capture::in_recording(recording.folder(),
                                     recording.has_rig() ? refusal : decoder.error());
    }
    return ChosenDecoder{std::move(*decoder), false, "phase alone", refusal.message};
}

}  // namespace xtrack::tools
