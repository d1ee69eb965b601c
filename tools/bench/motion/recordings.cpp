// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/motion/recordings.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include <Eigen/LU>

#include <xtrack/depth_decoder.hpp>
#include <xtrack/recording.hpp>

#include "tools/decode_report.hpp"

namespace xtrack::tools::bench {

namespace {

struct Truth {
    Image<std::uint16_t> depth;
    Image<std::uint8_t> mask;
    double move_mm = 0.0;  ///< of the middle of the hand's surface, since the frame before
};

const Vec3d kNowhere = Vec3d::Constant(std::numeric_limits<double>::quiet_NaN());

// kNowhere where no pixel is of a hand.
Vec3d middle_of_hand(const Truth& truth, const Pinhole& camera) {
    const Mat3d ray_from_pixel = camera.matrix.inverse();
    Vec3d sum = Vec3d::Zero();
    double count = 0.0;
    for (int y = 0; y < truth.mask.height(); ++y) {
        for (int x = 0; x < truth.mask.width(); ++x) {
            if (truth.mask.at(x, y) == static_cast<std::uint8_t>(SimPart::hand)) {
                sum += ray_from_pixel * Vec3d(x, y, 1.0) * (truth.depth.at(x, y) * kDepthUnitMm);
                count += 1.0;
            }
        }
    }
    return count > 0.0 ? Vec3d(sum / count) : kNowhere;
}

using Truths = std::map<std::uint64_t, Truth>;  // by the frame's sequence

Result<Truths> read_truths(const RecordingReader& recording) {
    Truths truths;
    Vec3d before = kNowhere;
    for (std::size_t i = 0; i < recording.entries().size(); ++i) {
        if (!recording.has_truth_depth(i) || !recording.has_truth_mask(i)) {
            before = kNowhere;
            continue;
        }
        DepthFrame depth;
        Truth truth;
        if (auto ok = recording.read_truth_depth(i, depth); !ok) {
            return ok.error();
        }
        if (auto ok = recording.read_truth_mask(i, truth.mask); !ok) {
            return ok.error();
        }
        truth.depth = std::move(depth.depth);
        const Vec3d middle = middle_of_hand(truth, recording.rig().camera);
        const double move_mm = (middle - before).norm();
        truth.move_mm = std::isnan(move_mm) ? 0.0 : move_mm;
        before = middle;
        truths.emplace(recording.entries()[i].sequence, std::move(truth));
    }
    return truths;
}

Result<HandAccuracy> decode(const RecordingReader& recording, const Truths& truths,
                            MotionHandling motion) {
    DecodeSettings settings;
    settings.motion = motion;
    auto decoder = DepthDecoder::create(recording.rig(), recording.patterns(),
                                        recording.image_size(), settings);
    if (!decoder) {
        return decoder.error();
    }
    HandAccuracy sum;
    for (std::size_t i = 0; i < recording.entries().size(); ++i) {
        auto frame = std::make_shared<Frame>();
        if (auto ok = recording.read_frame(i, *frame); !ok) {
            return ok.error();
        }
        if (decoder->push(std::move(frame)).state != DecodeState::depth_ready) {
            continue;
        }
        const auto truth = truths.find(decoder->depth().sequence);
        if (truth != truths.end()) {
            sum.add(measure_hand(decoder->depth(), truth->second.depth.view(),
                                 truth->second.mask.view(), kMotionLimit_mm));
        }
    }
    return sum;
}

}  // namespace

Result<RecordingReport> measure_recording(const std::filesystem::path& folder) {
    const auto recording = RecordingReader::open(folder);
    if (!recording) {
        return recording.error();
    }
    const auto lacks = [&](const char* what) {
        return Error{ErrorCode::unsupported, folder.string() + ": " + what +
                                                 "; give a recording of fringes with rig.yaml, "
                                                 "truth/depth and truth/mask"};
    };
    if (recording->kind() != RecordingKind::fringe || !recording->has_rig()) {
        return lacks("no fringes of a known rig");
    }
    auto truths = read_truths(*recording);
    if (!truths) {
        return truths.error();
    }
    if (truths->empty()) {
        return lacks("no truth");
    }
    RecordingReport report;
    // A folder may be given with a slash at its end.
    report.name = (folder.has_filename() ? folder : folder.parent_path()).filename().string();
    report.method = describe(recording->patterns());
    Truths moving;
    for (const auto& [sequence, truth] : *truths) {
        if (truth.move_mm >= kMoves_mm) {
            moving.emplace(sequence, truth);
            report.mean_move_mm += truth.move_mm;
        }
    }
    if (moving.empty()) {
        moving = std::move(*truths);
    }
    report.frames = moving.size();
    report.mean_move_mm /= static_cast<double>(moving.size());
    for (const bool follow : {false, true}) {
        const auto hand =
            decode(*recording, moving, follow ? MotionHandling::follow : MotionHandling::off);
        if (!hand && hand.error().code == ErrorCode::unsupported) {
            report.not_decoded = hand.error().message;
            return report;
        }
        if (!hand) {
            return hand.error();
        }
        (follow ? report.followed : report.as_it_comes) = *hand;
    }
    return report;
}

}  // namespace xtrack::tools::bench
