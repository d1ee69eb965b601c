// SPDX-License-Identifier: Apache-2.0
#include "tools/light_source.hpp"

#include <utility>

#include <xtrack/method.hpp>
#include <xtrack/recording.hpp>

#include "core/capture/in_recording.hpp"
#include "tools/progress.hpp"

namespace xtrack::tools {

Result<CalibratedLight> light_of_recording(const std::string& folder) {
    const auto recording = RecordingReader::open(folder);
    if (!recording) {
        return recording.error();
    }
    if (recording->kind() != RecordingKind::fringe) {
        return Error{ErrorCode::unsupported,
                     folder +
                         ": pattern.yaml is missing; light is calibrated from images of "
                         "patterns, which `xtrack calibrate patterns` writes"};
    }
    CalibratedLight found;
    found.patterns = recording->patterns();
    if (recording->has_rig()) {
        found.rig = recording->rig();
    }
    auto calibrator = LightCalibrator::create(found.patterns, recording->image_size(), found.rig);
    if (!calibrator) {
        return capture::in_recording(recording->folder(), calibrator.error());
    }
    Frame frame;
    Progress progress("calibrate", recording->entries().size());
    for (std::size_t i = 0; i < recording->entries().size(); ++i) {
        auto ok = recording->read_frame(i, frame, ColourReading::as_stored);
        if (ok) {
            ok = calibrator->add(frame);
        }
        if (!ok) {
            return ok.error();
        }
        progress.step();
    }
    auto light = calibrator->finish();
    if (!light) {
        return capture::in_recording(recording->folder(), light.error());
    }
    found.light = *std::move(light);
    return found;
}

Result<CalibratedLight> light_of_simulation(SimSettings settings) {
    settings.script.clear();
    settings.user.visible_body = false;
    settings.patterns = light_sequence(settings.patterns.axis, settings.patterns.projector_size);
    // What runs free is not seen whole each time: all of it is shown twice.
    const int shows = settings.clocks.locked ? 1 : 2 * settings.clocks.hold_frames;
    settings.duration_s =
        shows * static_cast<double>(settings.patterns.patterns.size()) / settings.camera.frame_hz;
    auto rig = SimulatedRig::create(settings);
    if (!rig) {
        return rig.error();
    }
    auto calibrator =
        LightCalibrator::create(settings.patterns, settings.rig.camera.size, settings.rig);
    if (!calibrator) {
        return calibrator.error();
    }
    for (FrameSource::Item item = (*rig)->next({}); item.status == SourceStatus::ok;
         item = (*rig)->next({})) {
        if (auto ok = calibrator->add(*item.frame); !ok) {
            return ok.error();
        }
    }
    auto light = calibrator->finish();
    if (!light) {
        return light.error();
    }
    return CalibratedLight{*std::move(light), settings.patterns, settings.rig};
}

}  // namespace xtrack::tools
