// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <xtrack/null_source.hpp>
#include <xtrack/recording.hpp>

#include "tests/core/capture/small_recording.hpp"

namespace xtrack {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

template <typename T>
void expect_same_pixels(const Image<T>& a, const Image<T>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (int y = 0; y < a.height(); ++y) {
        for (int x = 0; x < a.width(); ++x) {
            ASSERT_EQ(a.at(x, y), b.at(x, y)) << x << " " << y;
        }
    }
}

using RoundTrip = RecordingTest;

TEST_F(RoundTrip, FringesComeBackBitForBit) {
    const auto patterns = dual_sequence(Axis::y, {1024, 768}, 320.0, 32.0);
    auto writer = RecordingWriter::create(folder_ / "rec", {small_rig(), patterns});
    ASSERT_TRUE(writer.ok()) << writer.error().message;
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(writer->add(small_frame(i, i % 7 == 6 ? kUnknownPattern : i % 6)).ok());
    }
    Image<std::uint16_t> truth(16, 12, 7721);
    Image<std::uint8_t> mask(16, 12, 1);
    ASSERT_TRUE(writer->add_truth(truth.view(), mask.view()).ok());
    ASSERT_TRUE(writer->add_text("labels.csv", "gesture,hand,start_us,end_us\n").ok());
    ASSERT_TRUE(writer->add_text("truth/hands.csv", "t_us\n").ok());
    EXPECT_FALSE(writer->add_text("../out.txt", "x").ok());
    EXPECT_FALSE(fs::exists(folder_ / "rec"));
    ASSERT_TRUE(writer->close().ok());

    const auto recording = RecordingReader::open(folder_ / "rec");
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    EXPECT_EQ(recording->kind(), RecordingKind::fringe);
    EXPECT_EQ(recording->patterns(), patterns);
    ASSERT_TRUE(recording->has_rig());
    const Rig rig = small_rig();
    EXPECT_EQ(recording->rig().camera.matrix, rig.camera.matrix);
    EXPECT_EQ(recording->rig().camera.distortion, rig.camera.distortion);
    EXPECT_EQ(recording->rig().projector->size, rig.projector->size);
    EXPECT_EQ(recording->rig().projector_from_camera_T, rig.projector_from_camera_T);
    EXPECT_EQ(*recording->rig().interaction_from_camera, *rig.interaction_from_camera);
    EXPECT_EQ(recording->rig().working_volume->far_mm, 2000.0);
    EXPECT_TRUE(recording->labels_file().has_value());
    EXPECT_TRUE(recording->truth_hands_file().has_value());
    EXPECT_FALSE(recording->joints_file().has_value());

    auto source = frame_source(*recording);
    ASSERT_TRUE(source.ok());
    std::vector<FramePtr> kept;  // more than the pool holds: none may be dropped or overwritten
    for (int i = 0; i < 20; ++i) {
        const auto item = (*source)->next(Duration::zero());
        ASSERT_EQ(item.status, SourceStatus::ok) << item.message;
        kept.push_back(item.frame);
    }
    EXPECT_EQ((*source)->next(Duration::zero()).status, SourceStatus::end);
    for (int i = 0; i < 20; ++i) {
        const FramePtr& frame = kept[static_cast<std::size_t>(i)];
        EXPECT_EQ(frame->pattern, i % 7 == 6 ? kUnknownPattern : i % 6);
        EXPECT_EQ(frame->stamp, Stamp::from_us(i * 16667));
        EXPECT_EQ(frame->sequence, static_cast<std::uint64_t>(i));
        EXPECT_EQ(frame->clean_row_end, 12);
        expect_same_pixels(frame->pixels, small_frame(i, 0).pixels);
    }

    // The only truth there is serves every frame: the scene does not move.
    DepthFrame depth;
    Image<std::uint8_t> parts;
    ASSERT_TRUE(recording->has_truth_depth(0));
    ASSERT_TRUE(recording->read_truth_depth(0, depth).ok());
    ASSERT_TRUE(recording->read_truth_mask(19, parts).ok());
    expect_same_pixels(depth.depth, truth);
    expect_same_pixels(parts, mask);
}

TEST_F(RoundTrip, ColourFringesComeBackBitForBit) {
    auto writer = RecordingWriter::create(folder_ / "rec",
                                          {{}, rgb_sequence(Axis::x, {1024, 768}, {768.0, 96.0})});
    ASSERT_TRUE(writer.ok());
    const Frame colour = small_frame(0, 1, PixelFormat::bgr8);
    ASSERT_TRUE(writer->add(colour).ok());
    ASSERT_TRUE(writer->close().ok());
    const auto recording = RecordingReader::open(folder_ / "rec");
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    EXPECT_FALSE(recording->has_rig());
    EXPECT_EQ(recording->image_size(), (Size{16, 12}));
    Frame back;
    ASSERT_TRUE(recording->read_frame(0, back).ok());
    EXPECT_EQ(back.format, PixelFormat::bgr8);
    expect_same_pixels(back.pixels, colour.pixels);
}

TEST_F(RoundTrip, GreyPatternsInColourImagesAreReadAsLuma) {
    auto writer = RecordingWriter::create(folder_ / "rec",
                                          {{}, three_step_sequence(Axis::x, {64, 48}, 16.0)});
    ASSERT_TRUE(writer.ok());
    Frame colour = small_frame(0, 0, PixelFormat::bgr8);
    for (int x = 0; x < 16; ++x) {
        colour.pixels.at(3 * x, 0) = 10;
        colour.pixels.at(3 * x + 1, 0) = 200;
        colour.pixels.at(3 * x + 2, 0) = 100;
    }
    ASSERT_TRUE(writer->add(colour).ok());
    ASSERT_TRUE(writer->close().ok());
    Frame back;
    ASSERT_TRUE(RecordingReader::open(folder_ / "rec")->read_frame(0, back).ok());
    EXPECT_EQ(back.format, PixelFormat::grey8);
    EXPECT_NEAR(back.pixels.at(5, 0), 0.114 * 10 + 0.587 * 200 + 0.299 * 100, 1.0);
    // A calibration of light wants their colours.
    ASSERT_TRUE(
        RecordingReader::open(folder_ / "rec")->read_frame(0, back, ColourReading::as_stored).ok());
    EXPECT_EQ(back.format, PixelFormat::bgr8);
    expect_same_pixels(back.pixels, colour.pixels);
}

TEST_F(RoundTrip, DepthComesBackBitForBit) {
    Rig rig = small_rig();
    rig.projector.reset();
    auto writer = RecordingWriter::create(folder_ / "rec", {rig, std::nullopt, 0.25});
    ASSERT_TRUE(writer.ok()) << writer.error().message;
    DepthFrame depth;
    depth.depth_unit_mm = 0.25;
    depth.stamp = Stamp::from_us(5);
    depth.sequence = 3;
    depth.depth.resize(16, 12);
    for (int y = 0; y < 12; ++y) {
        for (int x = 0; x < 16; ++x) {
            depth.depth.at(x, y) = static_cast<std::uint16_t>(x * 4001 + y * 13);
        }
    }
    ASSERT_TRUE(writer->add(depth).ok());
    ASSERT_TRUE(writer->close().ok());

    const auto recording = RecordingReader::open(folder_ / "rec");
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    EXPECT_EQ(recording->kind(), RecordingKind::depth);
    EXPECT_EQ(recording->depth_unit_mm(), 0.25);
    EXPECT_FALSE(frame_source(*recording).ok());
    auto source = depth_source(*recording);
    ASSERT_TRUE(source.ok());
    DepthFrame back;
    std::string message;
    ASSERT_EQ((*source)->next(Duration::zero(), back, message), SourceStatus::ok) << message;
    EXPECT_EQ(back.stamp, depth.stamp);
    EXPECT_EQ(back.sequence, 3U);
    EXPECT_EQ(back.depth_unit_mm, 0.25);
    EXPECT_TRUE(back.metric);
    expect_same_pixels(back.depth, depth.depth);
    EXPECT_EQ((*source)->next(Duration::zero(), back, message), SourceStatus::end);
}

TEST_F(RoundTrip, WriterLeavesNothingUnlessItIsClosed) {
    const auto patterns = three_step_sequence(Axis::x, {64, 48}, 16.0);
    {
        auto writer = RecordingWriter::create(folder_ / "rec", {{}, patterns});
        ASSERT_TRUE(writer.ok());
        ASSERT_TRUE(writer->add(small_frame(0, 0)).ok());
    }
    EXPECT_TRUE(fs::is_empty(folder_));
    auto empty = RecordingWriter::create(folder_ / "rec", {{}, patterns});
    ASSERT_TRUE(empty.ok());
    EXPECT_FALSE(empty->close().ok());
    EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(RoundTrip, RowsThatSawOnePatternComeBack) {
    const auto patterns = three_step_sequence(Axis::x, {64, 48}, 16.0);
    auto writer = RecordingWriter::create(folder_ / "rec", {{}, patterns});
    ASSERT_TRUE(writer.ok()) << writer.error().message;
    struct Rows {
        int begin, end;              // given
        int begin_again, end_again;  // read back; an image has twelve
    };
    const Rows all[] = {{3, 12, 3, 12}, {0, 7, 0, 7}, {0, 12, 0, 12}, {0, 0, 0, 12}};
    int number = 0;
    for (const Rows& rows : all) {
        Frame frame = small_frame(number++, 0);
        frame.clean_row_begin = rows.begin;
        frame.clean_row_end = rows.end;
        ASSERT_TRUE(writer->add(frame).ok());
    }
    ASSERT_TRUE(writer->close().ok());
    EXPECT_NE(text_of(folder_ / "rec" / "frames.csv").find("000000.png,0,0,0,3,12\n"),
              std::string::npos);
    const auto reader = RecordingReader::open(folder_ / "rec");
    ASSERT_TRUE(reader.ok()) << reader.error().message;
    Frame frame;
    for (std::size_t i = 0; i < std::size(all); ++i) {
        ASSERT_TRUE(reader->read_frame(i, frame).ok());
        EXPECT_EQ(frame.clean_row_begin, all[i].begin_again) << i;
        EXPECT_EQ(frame.clean_row_end, all[i].end_again) << i;
    }
}

// As a program that is killed leaves it.
TEST_F(RoundTrip, WhatIsNotClosedYetCanBeReadWhereItIs) {
    const auto patterns = three_step_sequence(Axis::x, {64, 48}, 16.0);
    auto writer = RecordingWriter::create(folder_ / "rec", {{}, patterns});
    ASSERT_TRUE(writer.ok()) << writer.error().message;
    for (int i = 0; i < 2; ++i) {
        ASSERT_TRUE(writer->add(small_frame(i, i)).ok());
        const auto reader = RecordingReader::open(writer->folder());
        ASSERT_TRUE(reader.ok()) << reader.error().message;
        EXPECT_EQ(reader->entries().size(), static_cast<std::size_t>(i + 1));
    }
    EXPECT_FALSE(fs::exists(folder_ / "rec"));
    ASSERT_TRUE(writer->close().ok());
    EXPECT_EQ(RecordingReader::open(folder_ / "rec")->entries().size(), 2U);
}

TEST_F(RoundTrip, WriterRefusesWhatWouldNotReadBack) {
    const auto patterns = three_step_sequence(Axis::x, {1024, 768}, 16.0);
    fs::create_directories(folder_ / "taken" / "by others");
    EXPECT_THAT(RecordingWriter::create(folder_ / "taken", {{}, patterns}).error().message,
                HasSubstr("exists already"));
    Rig singular = small_rig();
    singular.camera.matrix.setZero();
    EXPECT_FALSE(RecordingWriter::create(folder_ / "rec", {singular, patterns}).ok());
    auto writer = RecordingWriter::create(folder_ / "rec", {small_rig(), patterns});
    ASSERT_TRUE(writer.ok());
    EXPECT_THAT(writer->add(small_frame(0, 3)).error().message, HasSubstr("pattern of frame 0"));
    ASSERT_TRUE(writer->add(small_frame(5, 0)).ok());
    EXPECT_THAT(writer->add(small_frame(4, 0)).error().message, HasSubstr("backwards"));
    Frame large = small_frame(6, 0);
    large.pixels.resize(17, 12);
    EXPECT_THAT(writer->add(large).error().message, HasSubstr("17x12"));
    EXPECT_FALSE(writer->add(DepthFrame{}).ok());
    // The unit is kept in rig.yaml, and what is kept there must be read back.
    EXPECT_THAT(RecordingWriter::create(folder_ / "rec", {{}, {}, 1.0}).error().message,
                HasSubstr("kept in rig.yaml"));
    EXPECT_THAT(RecordingWriter::create(folder_ / "rec", {small_rig(), {}, 1001.0}).error().message,
                HasSubstr("from 0.001 to 1000"));
    EXPECT_TRUE(RecordingWriter::create(folder_ / "rec", {{}, {}}).ok());
    // Without a rig the bounds of images hold all the same.
    auto without_rig = RecordingWriter::create(folder_ / "rec", {{}, patterns});
    ASSERT_TRUE(without_rig.ok());
    Frame long_row = small_frame(0, 0);
    long_row.pixels.resize(kMaxImageSide_px + 1, 1);
    EXPECT_THAT(without_rig->add(long_row).error().message, HasSubstr("size of frame 0"));
    DepthFrame long_depth;
    long_depth.depth.resize(kMaxImageSide_px + 1, 1);
    auto of_depth = RecordingWriter::create(folder_ / "rec", {{}, {}});
    EXPECT_THAT(of_depth->add(long_depth).error().message, HasSubstr("size of frame 0"));
}

TEST_F(RoundTrip, WriterClosesNothingThatWouldNotReadBack) {
    Frame no_pattern_known = small_frame(0, kUnknownPattern);
    Frame large_sequence = small_frame(0, 0);
    large_sequence.sequence = std::uint64_t{1} << 60U;
    for (const auto& [frame, said] : {std::pair{no_pattern_known, "pattern is empty"},
                                      std::pair{large_sequence, "line 2: sequence"}}) {
        auto writer = RecordingWriter::create(
            folder_ / "rec", {{}, three_step_sequence(Axis::x, {1024, 768}, 16.0)});
        ASSERT_TRUE(writer.ok());
        ASSERT_TRUE(writer->add(frame).ok());
        const auto closed = writer->close();
        ASSERT_FALSE(closed.ok()) << said;
        EXPECT_EQ(closed.error().code, ErrorCode::invalid_argument);
        EXPECT_THAT(closed.error().message, HasSubstr(said));
        EXPECT_TRUE(fs::is_empty(folder_));
    }
}

// Cameras put previews and colour profiles before the header that says the size.
TEST_F(RoundTrip, ALongHeadBeforeTheSizeIsReadOver) {
    {
        auto writer = RecordingWriter::create(
            folder_ / "rec", {small_rig(), three_step_sequence(Axis::x, {1024, 768}, 16.0)});
        ASSERT_TRUE(writer.ok());
        ASSERT_TRUE(writer->add(small_frame(0, 0)).ok());
        ASSERT_TRUE(writer->close().ok());
    }
    const std::string segment = "\xFF\xE1\xFF\xFF" + std::string(65533, 'x');
    std::string jpeg = "\xFF\xD8";
    for (int i = 0; i < 5; ++i) {
        jpeg += segment;
    }
    const std::string header("\xFF\xC0\0\x0B\x08\0\x0C\0\x10\x01\x01\x11\0", 13);
    set_text(folder_ / "rec" / "frames" / "000000.png", jpeg + header + "\xFF\xD9");
    const auto recording = RecordingReader::open(folder_ / "rec");
    ASSERT_TRUE(recording.ok()) << recording.error().message;
    EXPECT_EQ(recording->image_size(), (Size{16, 12}));
    set_text(folder_ / "rec" / "frames" / "000000.png", jpeg + segment);
    EXPECT_THAT(RecordingReader::open(folder_ / "rec").error().message, HasSubstr("000000.png"));
}

TEST(NullSource, IsOverBeforeItBegins) {
    EXPECT_EQ(null_frame_source()->next(Duration::zero()).status, SourceStatus::end);
    DepthFrame depth;
    std::string message;
    EXPECT_EQ(null_depth_source(small_rig())->next(Duration::zero(), depth, message),
              SourceStatus::end);
    EXPECT_EQ(null_depth_source(small_rig())->rig().camera.size, (Size{16, 12}));
}

}  // namespace
}  // namespace xtrack
