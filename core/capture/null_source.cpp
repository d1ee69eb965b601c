// SPDX-License-Identifier: Apache-2.0
#include <xtrack/null_source.hpp>

#include <utility>

namespace xtrack {

namespace {

class NullFrameSource final : public FrameSource {
 public:
    NullFrameSource(Rig rig, PatternSequence patterns)
        : rig_(std::move(rig)), patterns_(std::move(patterns)) {}
    [[nodiscard]] const Rig& rig() const override { return rig_; }
    [[nodiscard]] const PatternSequence& patterns() const override { return patterns_; }
    Item next(Duration /*timeout*/) override { return {SourceStatus::end, nullptr, {}}; }

 private:
    Rig rig_;
    PatternSequence patterns_;
};

class NullDepthSource final : public DepthSource {
 public:
    explicit NullDepthSource(Rig rig) : rig_(std::move(rig)) {}
    [[nodiscard]] const Rig& rig() const override { return rig_; }
    SourceStatus next(Duration /*timeout*/, DepthFrame& /*depth*/,
                      std::string& /*message*/) override {
        return SourceStatus::end;
    }

 private:
    Rig rig_;
};

}  // namespace

std::unique_ptr<FrameSource> null_frame_source(Rig rig, PatternSequence patterns) {
    return std::make_unique<NullFrameSource>(std::move(rig), std::move(patterns));
}

std::unique_ptr<DepthSource> null_depth_source(Rig rig) {
    return std::make_unique<NullDepthSource>(std::move(rig));
}

}  // namespace xtrack
