// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <xtrack/source.hpp>

namespace xtrack::tools {

/// A source as its recording will give it again, so that the live run and the replay say the same
/// to the bit: stamps are whole microseconds, and grey patterns that a colour camera sees are the
/// grey that decoding makes of them. Motion is judged by small differences between images, where
/// less than that lets two runs come apart by millimetres.
/// @thread one thread at a time
class AsRecorded final : public FrameSource {
 public:
    explicit AsRecorded(std::unique_ptr<FrameSource> source);

    [[nodiscard]] const Rig& rig() const override { return source_->rig(); }
    [[nodiscard]] const PatternSequence& patterns() const override { return source_->patterns(); }
    Item next(Duration timeout) override;
    [[nodiscard]] Duration delivery_delay() const override { return source_->delivery_delay(); }

 private:
    [[nodiscard]] bool is_read_in_colour(int pattern) const;

    std::unique_ptr<FrameSource> source_;
};

}  // namespace xtrack::tools
