// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include <gmock/gmock.h>
#include <xtrack/joint_recording.hpp>
#include <xtrack/recording.hpp>

#include "core/capture/image_codec.hpp"
#include "core/capture/yaml_file.hpp"
#include "tests/core/pipeline/plane_scene.hpp"
#include "tests/tools/command.hpp"

namespace xtrack::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int kFrames = 6;
constexpr double kWall_mm = 800.0;

PatternSequence patterns() { return three_step_sequence(Axis::x, {512, 384}, 512.0); }

// A wall under three fringe patterns, twice.
void write_fringes(const fs::path& folder) {
    const Rig rig = plane_rig();
    auto writer = RecordingWriter::create(folder, {rig, patterns(), kDepthUnitMm});
    ASSERT_TRUE(writer.ok()) << writer.error().message;
    for (int i = 0; i < kFrames; ++i) {
        const auto frame = plane_frame(rig, patterns(), i % 3, i, kWall_mm);
        ASSERT_TRUE(writer->add(*frame).ok());
    }
    ASSERT_TRUE(writer->close().ok());
}

void write_joints(const fs::path& folder) {
    std::vector<HandFrame> frames(kFrames);
    for (int i = 0; i < kFrames; ++i) {
        HandFrame& frame = frames[static_cast<std::size_t>(i)];
        frame.stamp = Stamp::from_us(20000 * i);
        frame.coordinates = CoordinateFrame::interaction;
        frame.count = 1;
        frame.hands[0].id = 1;
        frame.hands[0].confidence = 1.0F;
        frame.hands[0].joint(Joint::palm) = {{12.5F, 2.0F, 3.0F}, true};
    }
    fs::create_directories(folder);
    ASSERT_TRUE(write_joint_recording(folder / "joints.csv", frames).ok());
}

void replace_in(const fs::path& file, const std::string& old, const std::string& fresh) {
    std::string text = text_of(file);
    const std::size_t at = text.find(old);
    ASSERT_NE(at, std::string::npos) << old << " is not in " << text;
    set_text(file, text.replace(at, old.size(), fresh));
}

void set_rig(const fs::path& folder, const Rig& rig) {
    set_text(folder / "rig.yaml", capture::rig_text({rig, std::nullopt}));
}

fs::path frame_file(const fs::path& folder, int number) {
    return folder / RecordingReader::open(folder)->entries()[static_cast<std::size_t>(number)].file;
}

struct Damage {
    const char* name;
    std::function<void(const fs::path& folder)> make;
    const char* said;  // what the message must name
};

void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }

const std::vector<Damage> kFringeDamages = {
    {"missing", [](const fs::path& f) { fs::remove_all(f); }, "give the folder of a recording"},
    {"empty",
     [](const fs::path& f) {
         fs::remove_all(f);
         fs::create_directory(f);
     },
     "frames.csv"},
    {"missing_image", [](const fs::path& f) { fs::remove(frame_file(f, 1)); }, "000001.png"},
    {"folder_for_an_image",
     [](const fs::path& f) {
         const fs::path image = frame_file(f, 1);
         fs::remove(image);
         fs::create_directory(image);
     },
     "000001.png is no file; put the image there"},
    {"truncated_image",
     [](const fs::path& f) {
         const std::string all = text_of(frame_file(f, 1));
         set_text(frame_file(f, 1), all.substr(0, all.size() / 2));
     },
     "000001.png"},
    {"empty_image", [](const fs::path& f) { set_text(frame_file(f, 1), ""); }, "000001.png"},
    {"other_image_size",
     [](const fs::path& f) {
         const Image<std::uint8_t> other(8, 8, 128);
         set_text(frame_file(f, 1), *capture::encode_png(other.view(), PixelFormat::grey8));
     },
     "000001.png"},
    {"pattern_out_of_range",
     [](const fs::path& f) {
         replace_in(f / "frames.csv", "000001.png,10000,1,1", "000001.png,10000,1,3");
     },
     "frames.csv"},
    {"time_backwards",
     [](const fs::path& f) { replace_in(f / "frames.csv", ",20000,2,", ",9999,2,"); },
     "frames.csv"},
    {"one_pattern_missing",
     [](const fs::path& f) {
         replace_in(f / "frames.csv", ",10000,1,1", ",10000,1,0");
         replace_in(f / "frames.csv", ",40000,4,1", ",40000,4,0");
     },
     "no complete set of its 3 patterns"},
    {"no_frames",
     [](const fs::path& f) { set_text(f / "frames.csv", "file,t_us,sequence,pattern\n"); },
     "frames.csv"},
    {"other_columns", [](const fs::path& f) { replace_in(f / "frames.csv", "t_us", "time"); },
     "frames.csv"},
    {"image_outside",
     [](const fs::path& f) { replace_in(f / "frames.csv", "frames/", "../frames/"); },
     "frames.csv"},
    {"singular_camera",
     [](const fs::path& f) {
         Rig rig = plane_rig();
         rig.camera.matrix(0, 0) = 0.0;
         set_rig(f, rig);
     },
     "rig.yaml"},
    {"rig_cut_short",
     [](const fs::path& f) {
         const std::string all = text_of(f / "rig.yaml");
         set_text(f / "rig.yaml", all.substr(0, all.size() / 3));
     },
     "rig.yaml"},
    {"no_patterns",
     [](const fs::path& f) {
         const std::string all = text_of(f / "pattern.yaml");
         set_text(f / "pattern.yaml", all.substr(0, all.find("sequence")));
     },
     "pattern.yaml"},
};

const std::vector<Damage> kJointDamages = {
    {"not_a_number", [](const fs::path& f) { replace_in(f / "joints.csv", "12.5", "nan"); },
     "joints.csv"},
    {"no_number", [](const fs::path& f) { replace_in(f / "joints.csv", "12.5", "twelve"); },
     "joints.csv"},
    {"time_backwards",
     [](const fs::path& f) { replace_in(f / "joints.csv", "\n40000,", "\n4000,"); }, "joints.csv"},
    {"cut_short",  // in the middle of the word that says which hand
     [](const fs::path& f) {
         const std::string all = text_of(f / "joints.csv");
         set_text(f / "joints.csv", all.substr(0, all.rfind("\n100000,") + 10));
     },
     "joints.csv"},
};

// Exit status 1, nothing on stdout, one line on stderr which names the file.
void expect_refused(const Outcome& outcome, const char* said) {
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.out, "");
    EXPECT_TRUE(is_one_line_message(outcome.err)) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(said));
}

class BadRecording : public testing::TestWithParam<Damage> {
 protected:
    TemporaryFolder temporary_;
    fs::path recording_ = temporary_.path() / "recording";
};

class BadFringes : public BadRecording {
 protected:
    void SetUp() override {
        write_fringes(recording_);
        GetParam().make(recording_);
    }
};

TEST_P(BadFringes, AreRefusedByReplay) {
    expect_refused(xtrack_command({"replay", recording_.string()}), GetParam().said);
}

TEST_P(BadFringes, AreRefusedByDecodeWhichLeavesNothing) {
    const fs::path out = temporary_.path() / "results" / "out";
    expect_refused(xtrack_command({"decode", recording_.string(), "--all", "--out", out.string()}),
                   GetParam().said);
    EXPECT_FALSE(fs::exists(out));
    EXPECT_TRUE(!fs::exists(out.parent_path()) || fs::is_empty(out.parent_path()));
}

INSTANTIATE_TEST_SUITE_P(Each, BadFringes, testing::ValuesIn(kFringeDamages),
                         [](const auto& each) { return std::string(each.param.name); });

class BadJoints : public BadRecording {
 protected:
    void SetUp() override {
        write_joints(recording_);
        GetParam().make(recording_);
    }
};

TEST_P(BadJoints, AreRefusedByReplay) {
    expect_refused(xtrack_command({"replay", recording_.string()}), GetParam().said);
}

INSTANTIATE_TEST_SUITE_P(Each, BadJoints, testing::ValuesIn(kJointDamages),
                         [](const auto& each) { return std::string(each.param.name); });

class Recording : public testing::Test {
 protected:
    TemporaryFolder temporary_;
    fs::path recording_ = temporary_.path() / "recording";
    fs::path out_ = temporary_.path() / "out";
};

// The recordings that the tests above damage are good before they do.
TEST_F(Recording, WithoutDamageIsDecodedWhole) {
    write_fringes(recording_);
    const Outcome outcome = xtrack_command({"decode", recording_.string(), "--out", out_.string()});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    for (const char* file : {"wrapped.tiff", "coordinate.tiff", "modulation.png", "depth.png",
                             "cloud.ply", "preview.png"}) {
        EXPECT_TRUE(fs::exists(out_ / file)) << file;
    }
    Image<std::uint16_t> depth;
    ASSERT_TRUE(
        capture::decode_depth(text_of(out_ / "depth.png"), "depth.png", {96, 64}, depth).ok());
    EXPECT_NEAR(depth.at(48, 32) * kDepthUnitMm, kWall_mm, 5.0);  // from 8-bit images of one period
}

TEST_F(Recording, WithoutCountsKeepsEveryDepthApart) {
    write_fringes(recording_);
    const auto folders = [&] {
        fs::remove_all(out_);
        const Outcome outcome =
            xtrack_command({"decode", recording_.string(), "--all", "--out", out_.string()});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return std::distance(fs::directory_iterator(out_), fs::directory_iterator{});
    };
    const auto counted = folders();
    EXPECT_GT(counted, 1);
    std::string list = "file,t_us,sequence,pattern\n";
    const auto recording = RecordingReader::open(recording_);
    ASSERT_TRUE(recording.ok());
    for (const RecordingEntry& e : recording->entries()) {
        list +=
            e.file + "," + std::to_string(e.stamp.us()) + ",0," + std::to_string(e.pattern) + "\n";
    }
    set_text(recording_ / "frames.csv", list);
    EXPECT_EQ(folders(), counted);
}

// Two cameras' folders, or png beside jpg: what is in frames/ alone does not tell files apart.
TEST_F(Recording, WithFilesOfOneNameKeepsEveryDepthApart) {
    write_fringes(recording_);
    fs::create_directory(recording_ / "more");
    std::string list = "file,t_us,sequence,pattern\n";
    const auto recording = RecordingReader::open(recording_);
    ASSERT_TRUE(recording.ok());
    for (std::size_t i = 0; i < recording->entries().size(); ++i) {
        const RecordingEntry& e = recording->entries()[i];
        std::string file = e.file;
        if (i >= 3) {
            file = "more/" + fs::path(recording->entries()[i - 3].file).filename().string();
            fs::rename(recording_ / e.file, recording_ / file);
        }
        list += file + "," + std::to_string(e.stamp.us()) + "," + std::to_string(e.sequence) + "," +
                std::to_string(e.pattern) + "\n";
    }
    const std::vector<std::string> arguments = {"decode", recording_.string(), "--all", "--json",
                                                "--out",  out_.string()};
    set_text(recording_ / "frames.csv", list);
    const Outcome outcome = xtrack_command(arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(std::distance(fs::directory_iterator(out_), fs::directory_iterator{}), 4);
    EXPECT_THAT(outcome.out, HasSubstr("\"frame\":\"more/000000.png\""));
    EXPECT_THAT(outcome.out, HasSubstr("\"folder\":\"000003\""));
    EXPECT_TRUE(fs::exists(out_ / "000003" / "depth.png"));

    fs::create_directory(recording_ / "order");
    fs::copy_file(out_ / "000002" / "depth.png", recording_ / "order" / "000001.png");
    fs::copy_file(out_ / "000002" / "depth.png", recording_ / "order" / "000002.png");
    fs::remove_all(out_);
    expect_refused(xtrack_command({"decode", recording_.string(), "--order-from", "order", "--out",
                                   out_.string()}),
                   "same name");
}

// Without their extension these names are the folder itself and its parent.
TEST_F(Recording, WithNamesOfDotsIsDecodedInsideOut) {
    write_fringes(recording_);
    for (const auto& [number, name] :
         {std::pair{2, "frames/..png"}, std::pair{3, "frames/...png"}}) {
        const fs::path file = frame_file(recording_, number);
        replace_in(recording_ / "frames.csv", "frames/" + file.filename().string(), name);
        fs::rename(file, recording_ / name);
    }
    set_text(temporary_.path() / "depth.png", "mine");
    const Outcome outcome =
        xtrack_command({"decode", recording_.string(), "--all", "--out", out_.string()});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(text_of(temporary_.path() / "depth.png"), "mine");
    EXPECT_EQ(std::distance(fs::directory_iterator(temporary_.path()), fs::directory_iterator{}),
              3);  // the recording, out, and what was there before
    EXPECT_EQ(std::distance(fs::directory_iterator(out_), fs::directory_iterator{}), 4);
    EXPECT_TRUE(fs::exists(out_ / "000003" / "depth.png"));
}

TEST_F(Recording, WithoutDamageIsReplayed) {
    write_joints(recording_);
    EXPECT_EQ(xtrack_command({"replay", recording_.string()}).status, 0);
    fs::remove_all(recording_);
    write_fringes(recording_);
    EXPECT_EQ(xtrack_command({"replay", recording_.string()}).status, 0);
}

TEST_F(Recording, WithoutProjectorHasPhaseButNoGestures) {
    write_fringes(recording_);
    Rig rig = plane_rig();
    rig.projector.reset();
    set_rig(recording_, rig);
    expect_refused(xtrack_command({"replay", recording_.string()}), "projector");

    const Outcome outcome = xtrack_command({"decode", recording_.string(), "--out", out_.string()});
    if (outcome.status == 0) {
        EXPECT_THAT(outcome.out, HasSubstr("projector"));
        EXPECT_TRUE(fs::exists(out_ / "wrapped.tiff"));
        EXPECT_FALSE(fs::exists(out_ / "depth.png"));
    } else {
        expect_refused(outcome, "projector");
        EXPECT_FALSE(fs::exists(out_));
    }
}

TEST_F(Recording, WithoutRigGivesHeightsWithoutScale) {
    write_fringes(recording_);
    fs::remove(recording_ / "rig.yaml");
    const Outcome outcome = xtrack_command(
        {"decode", recording_.string(), "--out", out_.string(), "--json", "--export", "ply,obj"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("heights without scale"));
    EXPECT_THAT(outcome.out, HasSubstr("\"metric\":false"));
    for (const char* name : {"wrapped.tiff", "unwrapped.tiff", "height.tiff", "cloud.ply",
                             "mesh.obj", "preview.png"}) {
        EXPECT_GT(fs::file_size(out_ / name), 500U) << name;
    }
    EXPECT_FALSE(fs::exists(out_ / "depth.png"));
    EXPECT_FALSE(fs::exists(out_ / "coordinate.tiff"));
}

TEST_F(Recording, CanBeReplayedAsIfItHadNoRig) {
    write_fringes(recording_);
    const Outcome outcome = xtrack_command({"replay", recording_.string(), "--without-rig"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("depth is relative"));
    const Outcome pinch =
        xtrack_command({"replay", recording_.string(), "--without-rig", "--gestures", "pinch"});
    EXPECT_EQ(pinch.status, 2);
    EXPECT_THAT(pinch.err, HasSubstr("leave out --without-rig"));
    fs::remove_all(recording_);
    write_joints(recording_);
    const Outcome joints = xtrack_command({"replay", recording_.string(), "--without-rig"});
    EXPECT_EQ(joints.status, 2);
    EXPECT_THAT(joints.err, HasSubstr("the source has depth or joints"));
    EXPECT_EQ(joints.out, "");
}

TEST_F(Recording, OfFourStepsHasNoGammaToFind) {
    write_fringes(recording_);
    set_text(recording_ / "pattern.yaml",
             capture::patterns_text(n_step_sequence(Axis::x, {512, 384}, 512.0, 4)));
    expect_refused(
        xtrack_command({"decode", recording_.string(), "--out", out_.string(), "--gamma", "auto"}),
        "/pattern.yaml: --gamma auto: the shortest period has 4 grey images");
}

TEST_F(Recording, IsNotDecodedOverSomethingElse) {
    write_fringes(recording_);
    fs::create_directory(out_);
    set_text(out_ / "precious.txt", "mine");
    expect_refused(xtrack_command({"decode", recording_.string(), "--out", out_.string()}),
                   "exists already");
    EXPECT_EQ(text_of(out_ / "precious.txt"), "mine");
    EXPECT_FALSE(fs::exists(out_ / "depth.png"));
}

// Whoever finds these knows a rig and patterns and no files; `decode` may still give phase.
TEST_F(Recording, WhoseRigOrPatternsCannotGiveDepthNamesTheFile) {
    write_fringes(recording_);
    const std::string good = text_of(recording_ / "rig.yaml");
    Rig rig = plane_rig();
    rig.projector_from_camera_T << 0.0, 100.0, 0.0;  // along the stripes
    set_rig(recording_, rig);
    expect_refused(xtrack_command({"replay", recording_.string()}), "/rig.yaml: camera and");

    set_text(recording_ / "rig.yaml", good);
    set_text(recording_ / "pattern.yaml",
             capture::patterns_text(three_step_sequence(Axis::x, {512, 384}, 16.0)));
    expect_refused(xtrack_command({"replay", recording_.string()}),
                   "/pattern.yaml: its longest period of 16 px");
}

// A file that is not there may be left out; a link that leads nowhere is a mistake.
TEST(BadRecording, ALinkToNothingIsNotPassedOver) {
    const TemporaryFolder folder;
    const fs::path recording = folder.path() / "rec";
    write_fringes(recording);
    for (const char* name : {"labels.csv", "rig.yaml"}) {
        fs::remove(recording / name);
        fs::create_symlink("/nowhere/at/all", recording / name);
        const Outcome outcome = xtrack_command({"eval", recording.string()});
        EXPECT_EQ(outcome.status, 1) << name;
        EXPECT_TRUE(is_one_line_message(outcome.err)) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(name));
        fs::remove(recording / name);
    }
}

}  // namespace
}  // namespace xtrack::test
