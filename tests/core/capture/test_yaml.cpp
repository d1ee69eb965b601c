// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/capture/yaml_file.hpp"
#include "tests/core/capture/small_recording.hpp"

namespace xtrack::capture {
namespace {

using testing::HasSubstr;

constexpr const char* kHead = "%YAML:1.0\n---\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

std::string rig_message(const std::string& text) {
    const auto rig = parse_rig(text, "rig.yaml");
    return rig ? "" : rig.error().message;
}

std::string pattern_message(const std::string& text) {
    const auto patterns = parse_patterns(text, "pattern.yaml");
    return patterns ? "" : patterns.error().message;
}

TEST(RigYaml, WhatIsWrittenReadsBack) {
    RigFile file{small_rig(), 0.5};
    file.rig.camera_from_projector_rgb = Mat3d::Identity() * 0.7;
    const auto back = parse_rig(rig_text(file), "rig.yaml");
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->rig.camera.matrix, file.rig.camera.matrix);
    EXPECT_EQ(back->rig.camera.distortion, file.rig.camera.distortion);
    EXPECT_EQ(back->rig.projector->matrix, file.rig.projector->matrix);
    EXPECT_EQ(back->rig.projector_from_camera_R, file.rig.projector_from_camera_R);
    EXPECT_EQ(back->rig.projector_from_camera_T, file.rig.projector_from_camera_T);
    EXPECT_EQ(*back->rig.camera_from_projector_rgb, *file.rig.camera_from_projector_rgb);
    EXPECT_EQ(back->depth_unit_mm, 0.5);
}

TEST(RigYaml, PlainListsWillDo) {
    const auto rig = parse_rig(std::string(kHead) +
                                   "camera_matrix: [ 860, 0, 320, 0, 860, 240, 0, 0, 1 ]\n"
                                   "camera_size: [ 640, 480 ]\n",
                               "rig.yaml");
    ASSERT_TRUE(rig.ok()) << rig.error().message;
    EXPECT_EQ(rig->rig.camera.matrix(1, 2), 240.0);
    EXPECT_FALSE(rig->rig.projector.has_value());
}

TEST(RigYaml, BadFieldsAreNamed) {
    const std::string good = rig_text({small_rig(), std::nullopt});
    ASSERT_EQ(rig_message(good), "");
    EXPECT_THAT(rig_message(replaced(good, "camera_matrix", "camera_matrice")),
                HasSubstr("rig.yaml: camera_matrix is missing; add it"));
    EXPECT_THAT(rig_message(replaced(good, "20.5", "0.0")),
                HasSubstr("rig.yaml: camera_matrix is singular"));
    EXPECT_THAT(rig_message(replaced(good, "20.5", ".nan")), HasSubstr("camera_matrix holds NaN"));
    EXPECT_THAT(rig_message(replaced(good, "20.5, ", "")),
                HasSubstr("camera_matrix has rows and cols that are not those"));
    EXPECT_THAT(rig_message(std::string(kHead) + "camera_matrix: [ 1, 2 ]\n"),
                HasSubstr("camera_matrix does not hold 9 numbers"));
    EXPECT_THAT(rig_message(replaced(good, "20.5", "wide")), HasSubstr("camera_matrix holds some"));
    EXPECT_THAT(rig_message(replaced(good, "[ 16, 12 ]", "[ 1000000000, 12 ]")),
                HasSubstr("camera_size is out of range"));
    EXPECT_THAT(rig_message(replaced(good, "[ 16, 12 ]", "[ 16.5, 12 ]")),
                HasSubstr("camera_size is out of range"));
    EXPECT_THAT(rig_message(replaced(good, "projector_size", "screen_size")),
                HasSubstr("projector_size is missing"));
    EXPECT_THAT(rig_message(replaced(good, "[ 600.0, 2000.0 ]", "[ 2000.0, 600.0 ]")),
                HasSubstr("working_volume_mm"));
    for (const char* unit : {"-1", "0", "0.0009", "1001", ".nan"}) {
        EXPECT_THAT(rig_message(good + "depth_unit_mm: " + unit + "\n"),
                    HasSubstr("rig.yaml: depth_unit_mm is"));
    }
    EXPECT_EQ(rig_message(good + "depth_unit_mm: 0.001\n"), "");
}

TEST(RigYaml, HeadsOfMatricesAgreeWithTheirData) {
    const std::string good = rig_text({small_rig(), std::nullopt});
    // rows and cols are compared with the numbers that are there, and nothing is reserved for them.
    for (const char* rows : {"rows: 1000000000", "rows: 2", "rows: -3", "rows: 0"}) {
        EXPECT_THAT(rig_message(replaced(good, "rows: 3", rows)),
                    HasSubstr("rig.yaml: camera_matrix has rows and cols that are not those"));
    }
    EXPECT_THAT(rig_message(replaced(good, "   rows: 3\n", "")),
                HasSubstr("camera_matrix has no rows; save it"));
    EXPECT_THAT(rig_message(replaced(replaced(good, "rows: 3", "rows: 1"), "cols: 3", "cols: 9")),
                HasSubstr("camera_matrix has 1 rows; give 3 of 3"));
    EXPECT_THAT(rig_message(replaced(good, "dt: d", "dt: \"3d\"")),
                HasSubstr("camera_matrix has a dt that is not one channel"));
    EXPECT_EQ(rig_message(replaced(good, "dt: d", "dt: f")), "");
    // A vector may lie down.
    const std::string upright = "projector_from_camera_T: !!opencv-matrix\n   rows: 3\n   cols: 1";
    const std::string lying = "projector_from_camera_T: !!opencv-matrix\n   rows: 1\n   cols: 3";
    EXPECT_EQ(rig_message(replaced(good, upright, lying)), "");
}

TEST(RigYaml, HostileTextsAreRefused) {
    for (const std::string& text :
         {std::string(), std::string("camera_matrix: 1\n"), std::string("%YAML:1.0\n---\n- 1\n"),
          std::string("{\"camera_matrix\": 1}"), kHead + std::string("a: [ 1, 2\n"),
          kHead + std::string("a: \"unfinished\n"), std::string("%YAML:1.0\n\0\n", 12)}) {
        EXPECT_THAT(rig_message(text), HasSubstr("rig.yaml")) << text;
    }
    EXPECT_THAT(rig_message(kHead + ("a: " + std::string(500000, '['))), HasSubstr("nested"));
    EXPECT_THAT(rig_message(kHead + ("a: " + std::string(500000, '{'))), HasSubstr("nested"));
    std::string dashes;
    for (int i = 0; i < 100000; ++i) {
        dashes += "- ";
    }
    EXPECT_THAT(rig_message(kHead + ("a:\n" + dashes)), HasSubstr("line 4"));
    EXPECT_THAT(rig_message(kHead + std::string(2U << 20U, ' ')), HasSubstr("bytes long"));
}

// Texts on which OpenCV's parser never ends.
TEST(RigYaml, OnlyOneDocumentIsTaken) {
    EXPECT_THAT(rig_message("%YAML:1.0\n   - { kind: flat }\n0\n---\naxis: y\n"),
                HasSubstr("line 2: begins with no key"));
    EXPECT_THAT(rig_message(kHead + std::string("a: 1\n---\n- 1\n")), HasSubstr("line 4"));
    EXPECT_THAT(rig_message(kHead + std::string("a: 1\n...\n- 1\n")), HasSubstr("line 4"));
    EXPECT_THAT(rig_message(kHead + std::string("a:\n- 1\n")), HasSubstr("line 4"));
}

TEST(PatternYaml, WhatIsWrittenReadsBack) {
    for (auto s : {dual_sequence(Axis::y, {1024, 768}, 320.0, 32.0),
                   gray_code_sequence(Axis::x, {1824, 1140}, 2.0),
                   rgb_sequence(Axis::y, {1024, 768}, {768.0, 96.0})}) {
        s.gamma = 1.645;
        s.patterns[1].inverted = s.patterns[1].kind == PatternKind::gray_code;
        const auto back = parse_patterns(patterns_text(s), "pattern.yaml");
        ASSERT_TRUE(back.ok()) << back.error().message;
        EXPECT_EQ(*back, s);
    }
}

TEST(PatternYaml, ResponsesReadBack) {
    PatternSequence s = dual_sequence(Axis::x, {1024, 768}, 320.0, 32.0);
    s.response = ProjectorResponse{{{{0.0, 0.1, 0.3, 0.6, 1.0},
                                     {0.0, 0.0, 0.123456789012345, 0.6, 1.0},
                                     {0.0, 0.2, 0.3, 1.0, 1.0}}}};
    const std::string text = patterns_text(s);
    const auto back = parse_patterns(text, "pattern.yaml");
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(*back, s);
    EXPECT_THAT(pattern_message(replaced(text, "response_green", "response_grin")),
                HasSubstr("pattern.yaml: response_green is missing"));
    EXPECT_THAT(pattern_message(replaced(text, "0.1, 0.3, 0.6", "0.5, 0.3, 0.6")),
                HasSubstr("response_red[2] is 0.3"));
    EXPECT_THAT(pattern_message(replaced(text, "0.1, 0.3, 0.6", "0.1, .nan, 0.6")),
                HasSubstr("response_red holds NaN"));
    EXPECT_THAT(pattern_message(replaced(text, "0.1, 0.3, 0.6", "0.1, 0.3")),
                HasSubstr("response_red does not hold 5 to 256 numbers"));
}

TEST(PatternYaml, RampsReadBack) {
    PatternSequence s = dual_sequence(Axis::x, {1024, 768}, 320.0, 32.0);
    s.patterns[0] = {};
    s.patterns[0].kind = PatternKind::ramp;
    s.patterns[0].period_px = 256.0;
    const auto back = parse_patterns(patterns_text(s), "pattern.yaml");
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(*back, s);
}

TEST(PatternYaml, BadFieldsAreNamed) {
    const std::string good = patterns_text(dual_sequence(Axis::y, {1024, 768}, 320.0, 32.0));
    EXPECT_THAT(pattern_message(replaced(good, "axis: y", "axis: z")),
                HasSubstr("pattern.yaml: axis is neither x nor y"));
    EXPECT_THAT(pattern_message(replaced(good, "period_px: 32.0", "period_px: -32.0")),
                HasSubstr("sequence[3].period_px is -32"));
    EXPECT_THAT(pattern_message(replaced(good, "period_px: 32.0", "period_px: .nan")),
                HasSubstr("sequence[3].period_px is NaN"));
    EXPECT_THAT(pattern_message(replaced(good, ", phase_rad: 0.0", "")),
                HasSubstr("sequence[0].phase_rad is missing"));
    EXPECT_THAT(pattern_message(replaced(good, "kind: sine", "kind: square")),
                HasSubstr("sequence[0].kind is none that is known"));
    EXPECT_THAT(pattern_message(replaced(good, "[ 1024, 768 ]", "[ 1e9, 768 ]")),
                HasSubstr("projector_size"));
    EXPECT_THAT(pattern_message(std::string(kHead) + "axis: x\nprojector_size: [ 4, 4 ]\n"),
                HasSubstr("sequence is missing"));
    EXPECT_THAT(pattern_message(std::string(kHead) +
                                "axis: x\nprojector_size: [ 4, 4 ]\nsequence: [ 1 ]\n"),
                HasSubstr("sequence[0]"));
}

}  // namespace
}  // namespace xtrack::capture
