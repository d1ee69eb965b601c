// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include <xtrack/session.hpp>
#include <xtrack/sim.hpp>
#ifdef XTRACK_HAS_RECORDINGS
#include <xtrack/joint_recording.hpp>
#include <xtrack/recording.hpp>

#include "core/capture/in_recording.hpp"
#endif

#include "core/base/setting_up.hpp"

namespace xtrack {

namespace {

constexpr std::string_view kSimulator = "sim";
constexpr std::string_view kSimulatorPreset = "sim:";
constexpr std::string_view kDefaultPreset = "ideal-60";

/// What somebody may have meant who named no folder.
Error no_source(const std::filesystem::path& given) {
    std::error_code unknown;
    const char* what = std::filesystem::is_character_file(given, unknown)
                           ? ": is a device, and live cameras are not part of this version"
                       : std::filesystem::exists(given, unknown) ? ": is no folder"
                                                                 : ": is not there";
    return {ErrorCode::io, given.string() + what +
                               "; give the folder of a recording, or sim, sim:ideal-60 or "
                               "sim:webcam-30 for the simulator"};
}

Result<Session> open_simulator(std::string_view preset, const SessionOptions& options) {
    auto settings = SimSettings::preset(preset);
    if (!settings) {
        return settings.error();
    }
    auto rig = SimulatedRig::create(*settings);
    if (!rig) {
        return rig.error();
    }
    return Session::create(std::unique_ptr<FrameSource>(std::move(*rig)), options);
}

#ifdef XTRACK_HAS_RECORDINGS

/// Depth images need their camera.
Error camera_missing(const RecordingReader& recording) {
    return {ErrorCode::unsupported,
            (recording.folder() / "rig.yaml").string() +
                ": missing; gestures need positions: add camera_matrix and camera_size of the "
                "depth camera"};
}

Result<Session> in_recording(const std::filesystem::path& folder, Result<Session> session) {
    return session ? std::move(session)
                   : Result<Session>(capture::in_recording(folder, session.error()));
}

Result<Session> open_recording(const std::filesystem::path& folder, const SessionOptions& options) {
    auto recording = RecordingReader::open(folder);
    if (!recording) {
        return recording.error();
    }
    switch (recording->kind()) {
        case RecordingKind::joints: {
            auto frames = read_joint_recording(*recording->joints_file());
            if (!frames) {
                return frames.error();
            }
            return Session::create(
                std::unique_ptr<HandSource>(new HandSequence(std::move(*frames))), options);
        }
        case RecordingKind::fringe: {
            auto source = frame_source(*recording);
            return source ? in_recording(folder, Session::create(std::move(*source), options))
                          : Result<Session>(source.error());
        }
        case RecordingKind::depth: break;
    }
    if (!recording->has_rig()) {
        return camera_missing(*recording);
    }
    auto source = depth_source(*recording);
    return source ? in_recording(folder, Session::create(std::move(*source), options))
                  : Result<Session>(source.error());
}

#else

Result<Session> open_recording(const std::filesystem::path& folder, const SessionOptions&) {
    return Error{ErrorCode::unsupported,
                 folder.string() +
                     ": this build reads no recordings (it was made without OpenCV); "
                     "use `sim` or a source of your own"};
}

#endif

}  // namespace

Result<Session> Session::open(std::string_view source, const SessionOptions& options) {
    return base::setting_up("Session::open", [&] {
        if (source == kSimulator) {
            return open_simulator(kDefaultPreset, options);
        }
        if (source.starts_with(kSimulatorPreset)) {
            return open_simulator(source.substr(kSimulatorPreset.size()), options);
        }
        const std::filesystem::path folder(source);
        std::error_code unknown;
        if (!std::filesystem::is_directory(folder, unknown)) {
            return Result<Session>(no_source(folder));
        }
        return open_recording(folder, options);
    });
}

}  // namespace xtrack
