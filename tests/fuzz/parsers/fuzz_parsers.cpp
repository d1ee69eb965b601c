// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/parsers/fuzz_parsers.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include <xtrack/joint_recording.hpp>
#include <xtrack/labels.hpp>

#include "core/capture/frame_list.hpp"
#include "core/capture/image_codec.hpp"
#include "core/capture/image_header.hpp"
#include "core/capture/yaml_file.hpp"

namespace {

void check(bool holds) {
    if (!holds) {
        std::abort();
    }
}

template <typename T>
void check_message(const xtrack::Result<T>& result) {
    if (!result) {
        const std::string& message = result.error().message;
        check(!message.empty() && message.size() < 1000);
        check(message.find('\n') == std::string::npos);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace xtrack;
    if (size == 0) {
        return 0;
    }
    const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
    static_assert(fuzz::kParsers == 8);
    switch (data[0] % fuzz::kParsers) {
        case 0: {
            const auto entries = capture::parse_frame_list(text, "f", 6);
            check_message(entries);
            if (entries) {
                check(capture::parse_frame_list(capture::frame_list_text(*entries), "f", 6).ok());
            }
            break;
        }
        case 1: {
            const auto labels = parse_labels(text, "f");
            check_message(labels);
            if (labels) {
                const auto again = parse_labels(labels_text(*labels), "f");
                check(again.ok() && *again == *labels);
            }
            break;
        }
        case 2: {
            const auto frames = parse_joint_recording(text, "f");
            check_message(frames);
            if (frames) {
                const auto again = parse_joint_recording(joint_recording_text(*frames), "f");
                check(again.ok() && again->size() == frames->size());
            }
            break;
        }
        case 3: {
            const auto rig = capture::parse_rig(text, "f");
            check_message(rig);
            if (rig) {
                check(capture::parse_rig(capture::rig_text(*rig), "f").ok());
            }
            break;
        }
        case 4: {
            const auto patterns = capture::parse_patterns(text, "f");
            check_message(patterns);
            if (patterns) {
                const auto again = capture::parse_patterns(capture::patterns_text(*patterns), "f");
                check(again.ok() && *again == *patterns);
            }
            break;
        }
        case 5: check_message(parse_poses(text, "f")); break;
        case 6: check_message(parse_hand_truth(text, "f")); break;
        case 7: {
            const auto info = capture::peek_image(text, "f");
            check_message(info);
            if (info && std::max(info->size.width, info->size.height) <= 256) {
                Image<std::uint8_t> image;
                check_message(
                    capture::decode_image(text, "f", info->size, PixelFormat::bgr8, image));
            }
            break;
        }
    }
    return 0;
}
