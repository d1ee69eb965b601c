// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>

#include <gmock/gmock.h>

#include "core/capture/image_codec.hpp"
#include "tests/tools/command.hpp"

namespace xtrack::test {
namespace {

namespace fs = std::filesystem;

const std::string kSwipe = XTRACK_TEST_DATA "/sim-swipe";
constexpr Size kSize{320, 240};

class DecodeExport : public testing::Test {
 protected:
    void decode(const char* list) {
        std::vector<std::string> arguments = {"decode", kSwipe, "--out", out_.string()};
        if (list != nullptr) {
            arguments.insert(arguments.end(), {"--export", list});
        }
        const Outcome outcome = xtrack_command(arguments);
        ASSERT_EQ(outcome.status, 0) << outcome.err;
    }
    [[nodiscard]] std::vector<std::string> written() const {
        std::vector<std::string> names;
        for (const char* name : {"cloud.ply", "cloud.pcd", "mesh.obj", "mesh.mtl", "mesh.png"}) {
            if (fs::exists(out_ / name)) {
                names.emplace_back(name);
            }
        }
        return names;
    }
    // What follows the line that ends a header.
    [[nodiscard]] std::string body(const char* file, const std::string& last_line) const {
        const std::string text = text_of(out_ / file);
        return text.substr(text.find(last_line) + last_line.size());
    }

    TemporaryFolder temporary_;
    fs::path out_ = temporary_.path() / "out";
};

TEST_F(DecodeExport, IsPlyWhereNothingIsSaid) {
    decode(nullptr);
    EXPECT_THAT(written(), testing::ElementsAre("cloud.ply"));
}

TEST_F(DecodeExport, IsWhatIsAskedFor) {
    decode("pcd");
    EXPECT_THAT(written(), testing::ElementsAre("cloud.pcd"));
}

TEST_F(DecodeExport, GivesTheSamePointsInEveryForm) {
    decode("obj,ply,pcd");
    ASSERT_EQ(written().size(), 5U);
    Image<std::uint16_t> depth;
    ASSERT_TRUE(capture::decode_depth(text_of(out_ / "depth.png"), "depth.png", kSize, depth));
    std::size_t points = 0;
    for (int v = 0; v < kSize.height; ++v) {
        points += static_cast<std::size_t>(
            kSize.width - std::count(depth.row(v), depth.row(v) + kSize.width, std::uint16_t{0}));
    }
    ASSERT_GT(points, 1000U);

    const std::string ply = body("cloud.ply", "end_header\n");
    const std::string pcd = body("cloud.pcd", "DATA binary\n");
    ASSERT_EQ(ply.size(), 15 * points);
    ASSERT_EQ(pcd.size(), 16 * points);
    std::istringstream obj(text_of(out_ / "mesh.obj"));
    std::string word;
    std::size_t vertices = 0;
    std::size_t faces = 0;
    std::vector<float> z_mm;
    for (std::string line; std::getline(obj, line);) {
        std::istringstream words(line);
        words >> word;
        if (word == "v") {
            ASSERT_LT(vertices, points);
            float xyz_mm[3];
            std::memcpy(xyz_mm, ply.data() + 15 * vertices, sizeof(xyz_mm));
            ASSERT_EQ(std::memcmp(xyz_mm, pcd.data() + 16 * vertices, sizeof(xyz_mm)), 0);
            for (const float expected_mm : xyz_mm) {
                float value_mm = 0.0F;
                words >> value_mm;
                ASSERT_NEAR(value_mm, expected_mm, 1e-3);
            }
            z_mm.push_back(xyz_mm[2]);
            ++vertices;
        } else if (word == "f") {
            std::vector<float> corners_mm;
            while (words >> word) {
                corners_mm.push_back(z_mm.at(std::stoul(word) - 1));
            }
            ASSERT_EQ(corners_mm.size(), 3U);
            const auto [near, far] = std::minmax_element(corners_mm.begin(), corners_mm.end());
            ASSERT_LE(*far - *near, 0.0151F * *near);
            ++faces;
        }
    }
    EXPECT_EQ(vertices, points);
    EXPECT_GT(faces, points);
    EXPECT_LT(faces, 2 * points);

    Image<std::uint8_t> texture;
    EXPECT_TRUE(capture::decode_image(text_of(out_ / "mesh.png"), "mesh.png", kSize,
                                      PixelFormat::grey8, texture));
    EXPECT_THAT(text_of(out_ / "mesh.mtl"), testing::HasSubstr("map_Kd mesh.png\n"));
}

}  // namespace
}  // namespace xtrack::test
