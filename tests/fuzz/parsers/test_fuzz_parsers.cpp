// SPDX-License-Identifier: Apache-2.0
// Drives the fuzz entry with random mutations of good texts: the same ones at every run.
#include "tests/fuzz/parsers/fuzz_parsers.hpp"

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <xtrack/joint_recording.hpp>
#include <xtrack/labels.hpp>

#include "core/capture/image_codec.hpp"
#include "core/capture/yaml_file.hpp"
#include "tests/core/capture/small_recording.hpp"

namespace xtrack {
namespace {

constexpr int kMutationsEach = 1500;

std::string seed_of(int parser) {
    switch (parser) {
        case 0: return "file,t_us,sequence,pattern\nframes/0.png,0,0,0\nframes/1.png,16667,1,\n";
        case 1:
            return "gesture,hand,start_us,end_us,commit_us\nswipe_left,right,1,20,9\nx_ok,left,"
                   "3,4,\n";
        case 2: {
            std::vector<HandFrame> frames(2);
            frames[1].stamp = Stamp::from_us(50000);
            frames[1].count = 1;
            frames[1].hands[0].joint(Joint::palm) = {{1.0F, 2.0F, 3.0F}, true};
            return joint_recording_text(frames);
        }
        case 3: return capture::rig_text({small_rig(), 0.1});
        case 4: {
            PatternSequence sequence = gray_code_sequence(Axis::y, {1024, 768}, 32.0);
            sequence.response.emplace().light.fill({0.0, 0.1, 0.3, 0.6, 1.0});
            return capture::patterns_text(sequence);
        }
        case 5: return "frame,pose,extended_fingers,hand_present\n0,open_palm,5,1\n1,,,0\n";
        case 6: return hand_truth_text(std::vector<HandTruth>(2));
        default: return *capture::encode_png(Image<std::uint16_t>(8, 8, 7).view());
    }
}

void mutate(std::string& text, std::mt19937& random) {
    static const std::vector<std::string> kWords = {"nan",
                                                    "-1",
                                                    "1e309",
                                                    "99999999999999999999",
                                                    ",",
                                                    "\n",
                                                    "..",
                                                    "[",
                                                    "]",
                                                    "{",
                                                    "}",
                                                    "- ",
                                                    ": ",
                                                    "!!opencv-matrix",
                                                    "&a",
                                                    "*a",
                                                    "\"",
                                                    "'",
                                                    "%YAML",
                                                    std::string(1, '\0'),
                                                    "   ",
                                                    "\t",
                                                    "#",
                                                    "~",
                                                    "|",
                                                    ">",
                                                    ".Inf",
                                                    std::string(40, '['),
                                                    std::string(300, '9')};
    const int edits = 1 + static_cast<int>(random() % 6U);
    for (int i = 0; i < edits && !text.empty(); ++i) {
        const std::size_t at = random() % text.size();
        const std::size_t length = 1 + random() % 12U;
        switch (random() % 5U) {
            case 0: text[at] = static_cast<char>(random() % 256U); break;
            case 1: text.erase(at, length); break;
            case 2: text.insert(at, text.substr(random() % text.size(), 4 * length)); break;
            case 3: text.insert(at, kWords[random() % kWords.size()]); break;
            case 4: text.replace(at, length, kWords[random() % kWords.size()]); break;
        }
    }
}

class FuzzParsers : public testing::TestWithParam<int> {};

TEST_P(FuzzParsers, NoTextBreaksThem) {
    std::mt19937 random(static_cast<unsigned>(20261 + GetParam()));
    const std::string seed = seed_of(GetParam());
    for (int i = 0; i < kMutationsEach; ++i) {
        std::string text = seed;
        if (i > 0) {
            mutate(text, random);
        }
        text.insert(text.begin(), static_cast<char>(GetParam()));
        EXPECT_EQ(
            LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()),
            0);
    }
}

INSTANTIATE_TEST_SUITE_P(Each, FuzzParsers, testing::Range(0, static_cast<int>(fuzz::kParsers)));

}  // namespace
}  // namespace xtrack
