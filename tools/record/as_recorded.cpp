// SPDX-License-Identifier: Apache-2.0
#include "tools/record/as_recorded.hpp"

#include <algorithm>
#include <utility>

#include "core/decode/luma.hpp"

namespace xtrack::tools {

AsRecorded::AsRecorded(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

// As RecordingReader::read_frame().
bool AsRecorded::is_read_in_colour(int pattern) const {
    const auto& all = source_->patterns().patterns;
    const auto coloured = [](const Pattern& p) { return p.kind == PatternKind::rgb_sine; };
    return pattern == kUnknownPattern ? std::any_of(all.begin(), all.end(), coloured)
                                      : coloured(all[static_cast<std::size_t>(pattern)]);
}

FrameSource::Item AsRecorded::next(Duration timeout) {
    Item item = source_->next(timeout);
    if (item.frame == nullptr) {
        return item;
    }
    const Frame& given = *item.frame;
    auto frame = std::make_shared<Frame>();  // a published one stays as it is
    frame->status = given.status;
    frame->format = given.format;
    frame->stamp = Stamp::from_us(given.stamp.us());
    frame->sequence = given.sequence;
    frame->pattern = given.pattern;
    frame->clean_row_begin = given.clean_row_begin;
    frame->clean_row_end = given.clean_row_end;
    if (given.format == PixelFormat::bgr8 && !is_read_in_colour(given.pattern)) {
        frame->format = PixelFormat::grey8;
        frame->pixels.resize(given.width(), given.height());
        for (int y = 0; y < given.height(); ++y) {
            luma_row(given.pixels.row(y), given.width(), frame->pixels.row(y));
        }
    } else {
        frame->pixels = given.pixels;
    }
    item.frame = std::move(frame);
    return item;
}

}  // namespace xtrack::tools
