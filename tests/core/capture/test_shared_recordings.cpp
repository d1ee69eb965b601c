// SPDX-License-Identifier: Apache-2.0
// Opens every outside recording (../shared/data beside the project) and reads all it holds.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <xtrack/joint_recording.hpp>
#include <xtrack/labels.hpp>
#include <xtrack/recording.hpp>

namespace xtrack {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> recordings_below(const std::string& part) {
    std::vector<fs::path> found;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(fs::path(XTRACK_SHARED_DATA) / part, error)) {
        if (entry.is_directory()) {
            found.push_back(entry.path());
        }
    }
    return found;
}

#define SKIP_WITHOUT(list)                                                              \
    if ((list).empty()) {                                                               \
        GTEST_SKIP() << "no recordings in " XTRACK_SHARED_DATA ": they are not in git"; \
    }

TEST(SharedRecordings, FringesAreRead) {
    auto folders = recordings_below("rendered");
    for (const auto& folder : recordings_below("fringe")) {
        folders.push_back(folder);
    }
    SKIP_WITHOUT(folders);
    for (const auto& folder : folders) {
        SCOPED_TRACE(folder.string());
        const auto recording = RecordingReader::open(folder);
        ASSERT_TRUE(recording.ok()) << recording.error().message;
        ASSERT_EQ(recording->kind(), RecordingKind::fringe);
        EXPECT_EQ(recording->has_rig(), fs::exists(folder / "rig.yaml"));
        const auto source = frame_source(*recording);
        ASSERT_TRUE(source.ok());
        // The first cycle is enough here; decoding reads the rest.
        for (std::size_t i = 0; i < recording->patterns().patterns.size(); ++i) {
            const auto item = (*source)->next(Duration::zero());
            ASSERT_EQ(item.status, SourceStatus::ok) << item.message;
            EXPECT_EQ(item.frame->size(), recording->image_size());
            EXPECT_EQ(item.frame->pattern, static_cast<int>(i));
        }
        if (fs::exists(folder / "truth")) {
            DepthFrame depth;
            Image<std::uint8_t> mask;
            ASSERT_TRUE(recording->read_truth_depth(0, depth).ok());
            ASSERT_TRUE(recording->read_truth_mask(0, mask).ok());
            EXPECT_EQ(depth.depth.size(), recording->image_size());
            std::size_t hand_pixels = 0;
            for (int y = 0; y < mask.height(); ++y) {
                for (int x = 0; x < mask.width(); ++x) {
                    hand_pixels += mask.at(x, y) == 1 ? 1U : 0U;
                }
            }
            EXPECT_GT(hand_pixels, 1000U);
            const auto hands = read_hand_truth(*recording->truth_hands_file());
            ASSERT_TRUE(hands.ok()) << hands.error().message;
            EXPECT_TRUE(hands->front().palm.valid);
            EXPECT_TRUE(hands->front().tips[4].valid);
        }
    }
}

TEST(SharedRecordings, DepthIsRead) {
    const auto folders = recordings_below("hands/depth");
    SKIP_WITHOUT(folders);
    for (const auto& folder : folders) {
        SCOPED_TRACE(folder.string());
        const auto recording = RecordingReader::open(folder);
        ASSERT_TRUE(recording.ok()) << recording.error().message;
        ASSERT_EQ(recording->kind(), RecordingKind::depth);
        const auto source = depth_source(*recording);
        ASSERT_TRUE(source.ok());
        DepthFrame depth;
        std::string message;
        for (int i = 0; i < 10; ++i) {
            ASSERT_EQ((*source)->next(Duration::zero(), depth, message), SourceStatus::ok)
                << message;
            EXPECT_EQ(depth.depth.size(), recording->image_size());
            EXPECT_TRUE(depth.metric);
        }
        if (const auto labels = recording->labels_file()) {
            const auto read = read_labels(*labels);
            ASSERT_TRUE(read.ok()) << read.error().message;
        }
        if (const auto poses = recording->poses_file()) {
            const auto read = read_poses(*poses);
            ASSERT_TRUE(read.ok()) << read.error().message;
            EXPECT_EQ(read->size(), recording->entries().size());
        }
    }
}

TEST(SharedRecordings, JointsAreRead) {
    const auto folders = recordings_below("hands/joints");
    SKIP_WITHOUT(folders);
    for (const auto& folder : folders) {
        SCOPED_TRACE(folder.string());
        const auto recording = RecordingReader::open(folder);
        ASSERT_TRUE(recording.ok()) << recording.error().message;
        ASSERT_EQ(recording->kind(), RecordingKind::joints);
        const auto frames = read_joint_recording(*recording->joints_file());
        ASSERT_TRUE(frames.ok()) << frames.error().message;
        EXPECT_GT(frames->size(), 10U);
        EXPECT_TRUE(frames->front().hands[0].joint(Joint::index_tip).valid);
        if (const auto labels = recording->labels_file()) {
            const auto read = read_labels(*labels);
            ASSERT_TRUE(read.ok()) << read.error().message;
        }
    }
}

}  // namespace
}  // namespace xtrack
