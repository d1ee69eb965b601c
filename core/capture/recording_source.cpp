// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <utility>

#include <xtrack/recording.hpp>

#include "core/base/frame_pool.hpp"
#include "core/base/setting_up.hpp"

namespace xtrack {

namespace {

// A decoder holds two cycles of six patterns, a pipeline a few frames on the way to it. Beyond this
// a frame of its own is made: a recording drops nothing.
constexpr std::size_t kPooledFrames = 16;
// The pool exists before the first image is read, at the size that rig.yaml or a header claims.
constexpr std::size_t kPooledBytes = std::size_t{256} << 20U;

std::size_t pooled_frames(Size size) {
    const std::size_t bytes =
        static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    return std::clamp(kPooledBytes / std::max<std::size_t>(bytes, 1), std::size_t{1},
                      kPooledFrames);
}

class RecordedFrames final : public FrameSource {
 public:
    explicit RecordedFrames(RecordingReader recording)
        : recording_(std::move(recording)),
          pool_(pooled_frames(recording_.image_size()), recording_.image_size(),
                PixelFormat::grey8) {
        if (recording_.has_rig()) {
            rig_ = recording_.rig();
        } else {
            rig_.camera.size = recording_.image_size();
        }
    }

    [[nodiscard]] const Rig& rig() const override { return rig_; }
    [[nodiscard]] const PatternSequence& patterns() const override { return recording_.patterns(); }

    Item next(Duration /*timeout*/) override {
        if (!failure_.empty()) {
            return {SourceStatus::failed, nullptr, failure_};
        }
        if (next_ == recording_.entries().size()) {
            return {SourceStatus::end, nullptr, {}};
        }
        std::shared_ptr<Frame> frame = pool_.acquire();
        if (!frame) {
            frame = std::make_shared<Frame>();
        }
        if (auto ok = recording_.read_frame(next_, *frame); !ok) {
            failure_ = ok.error().message;
            return {SourceStatus::failed, nullptr, failure_};
        }
        ++next_;
        return {SourceStatus::ok, std::move(frame), {}};
    }

 private:
    RecordingReader recording_;
    Rig rig_;
    base::FramePool pool_;
    std::size_t next_ = 0;
    std::string failure_;
};

class RecordedDepth final : public DepthSource {
 public:
    explicit RecordedDepth(RecordingReader recording) : recording_(std::move(recording)) {}

    [[nodiscard]] const Rig& rig() const override { return recording_.rig(); }

    SourceStatus next(Duration /*timeout*/, DepthFrame& depth, std::string& message) override {
        if (failure_.empty() && next_ == recording_.entries().size()) {
            return SourceStatus::end;
        }
        if (failure_.empty()) {
            if (auto ok = recording_.read_depth(next_, depth); !ok) {
                failure_ = ok.error().message;
            }
        }
        if (!failure_.empty()) {
            message = failure_;
            return SourceStatus::failed;
        }
        ++next_;
        return SourceStatus::ok;
    }

 private:
    RecordingReader recording_;
    std::size_t next_ = 0;
    std::string failure_;
};

Error unsupported(const RecordingReader& recording, const char* what) {
    return {ErrorCode::unsupported, recording.folder().string() + ": " + what};
}

}  // namespace

Result<std::unique_ptr<FrameSource>> frame_source(const RecordingReader& recording) {
    if (recording.kind() != RecordingKind::fringe) {
        return unsupported(recording, "holds no fringes; give a recording with a pattern.yaml");
    }
    return base::setting_up("frame_source", [&]() -> Result<std::unique_ptr<FrameSource>> {
        return std::unique_ptr<FrameSource>(std::make_unique<RecordedFrames>(recording));
    });
}

Result<std::unique_ptr<DepthSource>> depth_source(const RecordingReader& recording) {
    if (recording.kind() != RecordingKind::depth) {
        return unsupported(recording, "holds no depth; give a recording of 16-bit depth images");
    }
    return base::setting_up("depth_source", [&]() -> Result<std::unique_ptr<DepthSource>> {
        return std::unique_ptr<DepthSource>(std::make_unique<RecordedDepth>(recording));
    });
}

}  // namespace xtrack
