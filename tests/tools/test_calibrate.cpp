// SPDX-License-Identifier: Apache-2.0
// `calibrate` as a user meets it: pictures out, a recording in, files updated.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <xtrack/method.hpp>
#include <xtrack/recording.hpp>
#include <xtrack/sim.hpp>

#include "tests/core/sim/small_rig.hpp"
#include "tests/tools/command.hpp"

namespace xtrack::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

// A small colour rig with crosstalk and a bent projector shows a calibration, and is recorded.
class CalibrateLight : public testing::Test {
 protected:
    void record(double light_grey = 115.0) {
        SimSettings s = small_settings();
        s.user.visible_body = false;
        s.script.clear();
        s.camera.colour = true;
        s.projector.gamma = 1.8;
        s.projector.light_grey = light_grey;
        Mat3d rgb;
        rgb << 0.86, 0.12, 0.02, 0.08, 0.84, 0.08, 0.01, 0.13, 0.86;
        s.rig.camera_from_projector_rgb = rgb;
        s.patterns = light_sequence(s.patterns.axis, s.patterns.projector_size);
        s.duration_s = static_cast<double>(s.patterns.patterns.size()) / s.camera.frame_hz;
        Rig unknown = s.rig;
        unknown.camera_from_projector_rgb.reset();
        auto writer = RecordingWriter::create(recording_, {unknown, s.patterns}).value();
        const auto rig = make_rig(s);
        for (auto item = rig->next({}); item.status == SourceStatus::ok; item = rig->next({})) {
            ASSERT_TRUE(writer.add(*item.frame));
        }
        ASSERT_TRUE(writer.close());
    }
    TemporaryFolder folder_;
    fs::path recording_ = folder_.path() / "shown";
};

TEST_F(CalibrateLight, FindsMatrixAndResponseOfARecording) {
    record();
    const Outcome outcome = xtrack_command({"calibrate", "light", recording_.string(), "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json found = json::parse(outcome.out);
    EXPECT_TRUE(found["colour"]["passed"]);
    EXPECT_NEAR(found["response"]["gamma"][1], 1.8, 0.02);
    EXPECT_EQ(found["response"]["green"].size(), 18U);
    EXPECT_NEAR(found["colour"]["camera_from_projector_rgb"][0][1], 0.12 * 1.03, 0.01);
    EXPECT_EQ(found["written"].size(), 0U);
    const Outcome words = xtrack_command({"calibrate", "light", recording_.string()});
    EXPECT_EQ(words.status, 0);
    EXPECT_THAT(words.out, HasSubstr("colours: passed, the colours can be told apart"));
    EXPECT_THAT(words.out, HasSubstr("projector: gamma 1.8"));
}

TEST_F(CalibrateLight, UpdatesTheFilesOfAFolder) {
    record();
    const fs::path rig = folder_.path() / "rig";
    fs::create_directory(rig);
    fs::copy(recording_ / "rig.yaml", rig / "rig.yaml");
    set_text(rig / "pattern.yaml",
             "%YAML:1.0\n---\naxis: y\nprojector_size: [ 1024, 768 ]\n"
             "sequence:\n   - { kind: flat, level: 0.25 }\n");
    const Outcome outcome =
        xtrack_command({"calibrate", "light", recording_.string(), "--out", rig.string()});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("written: " + (rig / "rig.yaml").string()));
    EXPECT_THAT(text_of(rig / "rig.yaml"), HasSubstr("camera_from_projector_rgb"));
    EXPECT_THAT(text_of(rig / "pattern.yaml"), HasSubstr("response_blue: [ 0.0, "));
    EXPECT_THAT(text_of(rig / "pattern.yaml"), HasSubstr("level: 0.25"));
    EXPECT_EQ(std::distance(fs::directory_iterator(rig), fs::directory_iterator()), 2);
    // The same of one file alone, and of what is none.
    fs::remove(rig / "pattern.yaml");
    EXPECT_EQ(xtrack_command(
                  {"calibrate", "light", recording_.string(), "--out", (rig / "rig.yaml").string()})
                  .status,
              0);
    set_text(rig / "notes.txt", "x");
    const Outcome wrong = xtrack_command(
        {"calibrate", "light", recording_.string(), "--out", (rig / "notes.txt").string()});
    EXPECT_EQ(wrong.status, 2);
    EXPECT_TRUE(is_one_line_message(wrong.err)) << wrong.err;
    EXPECT_EQ(text_of(rig / "notes.txt"), "x");
}

// Its own response is in pattern.yaml: the fringes in between are decoded with it.
TEST_F(CalibrateLight, IsUsedByDecode) {
    SimSettings s = small_settings();
    s.user.visible_body = false;
    s.script.clear();
    s.projector.gamma = 2.2;
    s.patterns = method_sequence(Method::dual, s.rig, s.patterns.axis).value();
    s.duration_s = 6.0 / s.camera.frame_hz;
    s.patterns.gamma.reset();
    PatternSequence known = s.patterns;
    ProjectorResponse& response = known.response.emplace();
    for (int i = 0; i <= 51; ++i) {
        for (auto& light : response.light) {
            light.push_back(std::pow(i / 51.0, 2.2));
        }
    }
    auto writer = RecordingWriter::create(recording_, {s.rig, known}).value();
    const auto rig = make_rig(s);
    for (auto item = rig->next({}); item.status == SourceStatus::ok; item = rig->next({})) {
        ASSERT_TRUE(writer.add(*item.frame));
    }
    ASSERT_TRUE(writer.close());
    const auto ripple = [&](const char* out, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"decode", recording_.string(), "--json", "--out",
                                           (folder_.path() / out).string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = xtrack_command(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return json::parse(outcome.out);
    };
    const json with = ripple("with", {});
    const json without = ripple("without", {"--gamma", "1"});
    EXPECT_THAT(with["method"].get<std::string>(), HasSubstr("measured response"));
    EXPECT_LT(4.0 * with["frames"][0]["ripple"]["gamma_rad"].get<double>(),
              without["frames"][0]["ripple"]["gamma_rad"].get<double>());
}

// Colours that are not measured well are not written.
TEST_F(CalibrateLight, WritesNothingWhereItFails) {
    record(14.0);
    const fs::path out = folder_.path() / "new";
    const Outcome outcome =
        xtrack_command({"calibrate", "light", recording_.string(), "--out", out.string()});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_TRUE(is_one_line_message(outcome.err)) << outcome.err;
    EXPECT_FALSE(fs::exists(out));
}

TEST_F(CalibrateLight, SaysWhatItCouldNotStore) {
    record();
    fs::remove(recording_ / "rig.yaml");
    const fs::path out = folder_.path() / "new";
    const Outcome outcome =
        xtrack_command({"calibrate", "light", recording_.string(), "--out", out.string()});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(fs::exists(out / "pattern.yaml"));
    EXPECT_THAT(outcome.err, HasSubstr("matrix of the colours was not stored"));
}

TEST_F(CalibrateLight, AFileThatIsNotThereIsNotMadeAFolder) {
    record();
    const fs::path file = recording_ / "other" / "rig.yaml";
    fs::create_directory(file.parent_path());
    const Outcome outcome =
        xtrack_command({"calibrate", "light", recording_.string(), "--out", file.string()});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr("is not there to be updated"));
    EXPECT_FALSE(fs::exists(file));
}

TEST_F(CalibrateLight, LeavesTheFilesOfAnotherProjectorAlone) {
    record();
    const fs::path other = folder_.path() / "other";
    const Outcome made =
        xtrack_command({"calibrate", "patterns", "--size", "800x600", "--out", other.string()});
    ASSERT_EQ(made.status, 0) << made.err;
    const Outcome outcome = xtrack_command(
        {"calibrate", "light", recording_.string(), "--out", (other / "pattern.yaml").string()});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.err, HasSubstr("projector_size is 800x600"));
}

TEST_F(CalibrateLight, NamesWhatARecordingLacks) {
    const Outcome none = xtrack_command({"calibrate", "light", (folder_.path() / "no").string()});
    EXPECT_EQ(none.status, 1);
    EXPECT_TRUE(is_one_line_message(none.err)) << none.err;
    const Outcome swipe = xtrack_command({"calibrate", "light", XTRACK_TEST_DATA "/sim-swipe"});
    EXPECT_EQ(swipe.status, 1);
    EXPECT_THAT(swipe.err, HasSubstr("neither a ramp of grey levels nor colour fringes"));
    EXPECT_EQ(xtrack_command({"calibrate", "light", "sim:nix"}).status, 2);
    EXPECT_EQ(xtrack_command({"calibrate"}).status, 2);
}

TEST_F(CalibrateLight, OfTheSimulatorMakesANewFolder) {
    const fs::path out = folder_.path() / "sim";
    const Outcome outcome = xtrack_command({"calibrate", "light", "sim", "--out", out.string()});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("colours: not measured"));
    EXPECT_THAT(text_of(out / "pattern.yaml"), HasSubstr("response_red: [ 0.0, "));
    EXPECT_THAT(text_of(out / "rig.yaml"), Not(HasSubstr("camera_from_projector_rgb")));
}

TEST_F(CalibrateLight, PatternsArePicturesAndTheirFile) {
    const fs::path out = folder_.path() / "show";
    const Outcome outcome = xtrack_command({"calibrate", "patterns", "--out", out.string(),
                                            "--size", "64x48", "--levels", "16", "--axis", "y"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(fs::exists(out / "023.png"));
    EXPECT_FALSE(fs::exists(out / "024.png"));
    EXPECT_THAT(text_of(out / "pattern.yaml"), HasSubstr("kind: rgb_sine"));
    // Compensated, they are pictures of a linear projector.
    std::string text = text_of(out / "pattern.yaml");
    text.replace(text.find("sequence:"), 0, "gamma: 2.0\n");
    set_text(folder_.path() / "bent.yaml", text);
    const fs::path straight = folder_.path() / "straight";
    const Outcome again = xtrack_command({"calibrate", "patterns", "--out", straight.string(),
                                          "--from", (folder_.path() / "bent.yaml").string()});
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_THAT(again.out, HasSubstr("compensated"));
    EXPECT_THAT(text_of(straight / "pattern.yaml"), HasSubstr("gamma: 1.0"));
    EXPECT_NE(text_of(straight / "005.png"), text_of(out / "005.png"));
    const Outcome wrong =
        xtrack_command({"calibrate", "patterns", "--out", out.string(), "--size", "big"});
    EXPECT_EQ(wrong.status, 2);
    EXPECT_TRUE(is_one_line_message(wrong.err)) << wrong.err;
}

// `auto` and `methods` go by a test of the camera's colours.
TEST(ColourSelfTestOfMethods, IsMadeWhereThereAreColours) {
    const Outcome webcam = xtrack_command({"methods", "sim:webcam-30", "--json"});
    const json found = json::parse(webcam.out);
    EXPECT_EQ(found["colour_works"], true);
    EXPECT_THAT(found["colour_self_test"].get<std::string>(), HasSubstr("passed, the colours"));
    const Outcome ideal = xtrack_command({"methods", "sim", "--json"});
    EXPECT_TRUE(json::parse(ideal.out)["colour_works"].is_null());
}

}  // namespace
}  // namespace xtrack::test
