// SPDX-License-Identifier: Apache-2.0
// Every way a recording can be wrong gives one line that names file, field and mend.
#include <ostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/capture/small_recording.hpp"

namespace xtrack {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class BadRecording : public RecordingTest {
 protected:
    BadRecording() : rec_(folder_ / "rec") {
        auto writer = RecordingWriter::create(
            rec_, {small_rig(), three_step_sequence(Axis::y, {1024, 768}, 32.0)});
        for (int i = 0; i < 3; ++i) {
            EXPECT_TRUE(writer->add(small_frame(i, i)).ok());
        }
        EXPECT_TRUE(writer->close().ok());
    }

    // What open() says, or the first frame's message if it opens.
    [[nodiscard]] std::string message() const {
        const auto recording = RecordingReader::open(rec_);
        if (!recording) {
            return recording.error().message;
        }
        auto source = frame_source(*recording);
        if (!source) {
            return source.error().message;
        }
        while (true) {
            const auto item = (*source)->next(Duration::zero());
            if (item.status != SourceStatus::ok) {
                return item.message;
            }
        }
    }
    void expect_message(const std::string& file, const std::string& field) const {
        const std::string said = message();
        EXPECT_THAT(said, HasSubstr(file));
        EXPECT_THAT(said, HasSubstr(field));
        EXPECT_THAT(said, HasSubstr(";"));
        EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    }
    void replace(const std::string& file, const std::string& from, const std::string& to) const {
        std::string text = text_of(rec_ / file);
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        set_text(rec_ / file, text.replace(at, from.size(), to));
    }

    fs::path rec_;
};

TEST_F(BadRecording, TheGoodOneIsRead) { EXPECT_EQ(message(), ""); }

TEST_F(BadRecording, NotThere) {
    rec_ = folder_ / "none";
    expect_message("none", "is no folder");
    fs::create_directory(rec_);
    expect_message("none", "neither frames.csv nor joints.csv");
}

TEST_F(BadRecording, WithoutItsFrameList) {
    fs::remove(rec_ / "frames.csv");
    expect_message("frames.csv", "is not there");
}

TEST_F(BadRecording, WithoutAnImage) {
    fs::remove(rec_ / "frames" / "000001.png");
    expect_message("frames.csv", "frames/000001.png is not there");
}

TEST_F(BadRecording, TruncatedImage) {
    fs::resize_file(rec_ / "frames" / "000001.png",
                    fs::file_size(rec_ / "frames" / "000001.png") - 20);
    expect_message("000001.png", "the PNG is damaged");
}

TEST_F(BadRecording, EmptyImage) {
    set_text(rec_ / "frames" / "000002.png", "");
    expect_message("000002.png", "neither PNG nor JPEG");
}

TEST_F(BadRecording, FlippedBits) {
    std::string bytes = text_of(rec_ / "frames" / "000000.png");
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
    set_text(rec_ / "frames" / "000000.png", bytes);
    expect_message("000000.png", "the PNG is damaged");
}

TEST_F(BadRecording, ImageOfAnotherSize) {
    auto other = RecordingWriter::create(folder_ / "other",
                                         {{}, three_step_sequence(Axis::y, {1024, 768}, 32.0)});
    Frame frame = small_frame(0, 0);
    frame.pixels = Image<std::uint8_t>(20, 10, 1);
    ASSERT_TRUE(other->add(frame).ok());
    ASSERT_TRUE(other->close().ok());
    fs::copy_file(folder_ / "other/frames/000000.png", rec_ / "frames/000001.png",
                  fs::copy_options::overwrite_existing);
    expect_message("000001.png", "is 20x10 pixels, the recording's images are 16x12");
}

TEST_F(BadRecording, GreyImagesOfColourFringes) {
    replace("pattern.yaml", "kind: sine", "kind: rgb_sine");
    const std::string text = text_of(rec_ / "pattern.yaml");
    const std::size_t from = text.find("phase_rad:");
    const std::size_t to = text.find('\n', from);
    set_text(rec_ / "pattern.yaml",
             text.substr(0, from) + "phase_rad: [ 0., -2.0943951, 2.0943951 ] }" + text.substr(to));
    expect_message("000000.png", "is grey, but its pattern is told by its colours");
}

TEST_F(BadRecording, PatternIndexOutOfRange) {
    replace("frames.csv", ",2,2", ",2,3");
    expect_message("frames.csv", "line 4: pattern is '3'");
}

TEST_F(BadRecording, RigWithoutProjector) {
    std::string text = text_of(rec_ / "rig.yaml");
    for (std::size_t at = text.find("projector_"); at != std::string::npos;
         at = text.find("projector_", at)) {
        text.replace(at, 10, "unknown___");
    }
    set_text(rec_ / "rig.yaml", text);
    expect_message("rig.yaml", "projector_matrix is missing");
}

TEST_F(BadRecording, CameraSizeThatIsNotThatOfTheImages) {
    replace("rig.yaml", "[ 16, 12 ]", "[ 8192, 8192 ]");
    expect_message("rig.yaml",
                   "camera_size is 8192x8192, frames/000000.png is 16x12 pixels; make them agree");
    replace("rig.yaml", "[ 8192, 8192 ]", "[ 16384, 16384 ]");
    expect_message("rig.yaml", "camera_size is over 64 million pixels");
}

TEST_F(BadRecording, UnreadableImage) {
    const fs::path file = rec_ / "frames" / "000000.png";
    fs::permissions(file, fs::perms::none);
    if (std::ifstream(file).is_open()) {
        GTEST_SKIP() << "this user may read everything";
    }
    expect_message("000000.png", "cannot be opened: ");
}

TEST_F(BadRecording, SingularMatrix) {
    replace("rig.yaml", "20.5", "0.0");
    expect_message("rig.yaml", "camera_matrix is singular");
}

TEST_F(BadRecording, NanInTheRig) {
    replace("rig.yaml", "20.25", ".nan");
    expect_message("rig.yaml", "camera_matrix holds NaN");
}

TEST_F(BadRecording, ProjectorSizesThatDisagree) {
    replace("pattern.yaml", "[ 1024, 768 ]", "[ 1920, 1080 ]");
    expect_message("pattern.yaml", "projector_size is not rig.yaml's");
}

TEST_F(BadRecording, HugeFile) {
    set_text(rec_ / "rig.yaml", "%YAML:1.0\n" + std::string(2U << 20U, '#'));
    expect_message("rig.yaml", "bytes long; at most");
}

TEST_F(BadRecording, FolderInPlaceOfAFile) {
    fs::remove(rec_ / "rig.yaml");
    fs::create_directory(rec_ / "rig.yaml");
    expect_message("rig.yaml", "is not a file");
}

struct BadList {
    const char* name;
    const char* text;
    const char* said;
};

// For the names that ctest shows.
void PrintTo(const BadList& list, std::ostream* out) { *out << list.name; }

class BadFrameList : public BadRecording, public testing::WithParamInterface<BadList> {};

TEST_P(BadFrameList, IsNamed) {
    set_text(rec_ / "frames.csv", GetParam().text);
    expect_message("frames.csv", GetParam().said);
}

constexpr BadList kBadLists[] = {
    {"Empty", "", "is empty"},
    {"NoFrame", "file,t_us,sequence,pattern\n", "lists no frame"},
    {"NoPatternColumn", "file,t_us,sequence\nframes/000000.png,0,0\n", "column 'pattern'"},
    {"NoTimeColumn", "file,sequence,pattern\nframes/000000.png,0,0\n", "column 't_us'"},
    {"PatternTooHigh", "file,t_us,sequence,pattern\nframes/000000.png,0,0,3\n",
     "line 2: pattern is '3'; give a whole number from 0 to 2"},
    {"PatternNegative", "file,t_us,sequence,pattern\nframes/000000.png,0,0,-2\n",
     "line 2: pattern"},
    {"Backwards", "file,t_us,sequence,pattern\nframes/000000.png,9,0,0\nframes/000001.png,8,1,1\n",
     "line 3: t_us is '8'; time goes backwards"},
    {"NanTime", "file,t_us,sequence,pattern\nframes/000000.png,nan,0,0\n", "line 2: t_us is 'nan'"},
    {"AbsurdTime", "file,t_us,sequence,pattern\nframes/000000.png,9223372036854775807,0,0\n",
     "line 2: t_us"},
    {"NegativeSequence", "file,t_us,sequence,pattern\nframes/000000.png,0,-1,0\n",
     "line 2: sequence"},
    {"EscapeUp", "file,t_us,sequence,pattern\n../../etc/passwd,0,0,0\n",
     "line 2: file is '../../etc/passwd'; name a file inside"},
    {"EscapeRoot", "file,t_us,sequence,pattern\n/etc/passwd.png,0,0,0\n",
     "line 2: file is '/etc/passwd.png'; name a file inside"},
    {"EscapeBackslash", "file,t_us,sequence,pattern\n..\\..\\a.png,0,0,0\n", "line 2: file"},
    {"NoImage", "file,t_us,sequence,pattern\nrig.yaml,0,0,0\n", "name a png or jpg"},
    {"ShortRow", "file,t_us,sequence,pattern\nframes/000000.png,0,0\n",
     "line 2: has 3 fields, the header has 4"},
    {"NoPatternNamed",
     "file,t_us,sequence,pattern\nframes/000000.png,0,0,\nframes/000001.png,1,1,\n",
     "pattern is empty in every row"},
    {"CleanRowsHalf", "file,t_us,sequence,pattern,clean_begin\nframes/000000.png,0,0,0,1\n",
     "column 'clean_end'"},
    {"CleanRowsSwapped",
     "file,t_us,sequence,pattern,clean_begin,clean_end\nframes/000000.png,0,0,0,5,4\n",
     "line 2: clean_end is '4'; give a whole number from 6 to"},
    {"CleanRowsOutside",
     "file,t_us,sequence,pattern,clean_begin,clean_end\nframes/000000.png,0,0,0,5,13\n",
     "clean_end of frames/000000.png is 13, the images have 12 rows"},
    {"NoFile", "file,t_us,sequence,pattern\n,0,0,0\n", "line 2: file is empty"},
};

INSTANTIATE_TEST_SUITE_P(Rows, BadFrameList, testing::ValuesIn(kBadLists),
                         [](const auto& list) { return list.param.name; });

TEST_F(BadRecording, LinesWithoutEnd) {
    set_text(rec_ / "frames.csv",
             "file,t_us,sequence,pattern\n" + std::string(100000, 'a') + ",0,0,0\n");
    expect_message("frames.csv", "line 2: is over 1024 bytes long");
}

}  // namespace
}  // namespace xtrack
