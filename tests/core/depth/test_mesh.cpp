// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <xtrack/mesh.hpp>

namespace xtrack {
namespace {

namespace fs = std::filesystem;
using Triangle = std::array<std::uint32_t, 3>;

Rig camera_of(Size size) {
    Rig rig;
    rig.camera.matrix << 100.0, 0.0, 0.0, 0.0, 100.0, 0.0, 0.0, 0.0, 1.0;
    rig.camera.size = size;
    return rig;
}

DepthFrame wall(Size size, std::uint16_t steps) {
    DepthFrame depth;
    depth.depth = Image<std::uint16_t>(size.width, size.height, steps);
    return depth;
}

Mesh mesh_of(const DepthFrame& depth, const MeshSettings& settings = {}) {
    auto mesh = make_mesh(depth, camera_of(depth.depth.size()), settings);
    EXPECT_TRUE(mesh) << mesh.error().message;
    return mesh ? *mesh : Mesh{};
}

double z_of(const Mesh& mesh, std::uint32_t vertex) {
    return static_cast<double>(mesh.vertices_mm[vertex].z());
}

TEST(Mesh, AWallIsTwoTrianglesBetweenFourPixels) {
    const Mesh mesh = mesh_of(wall({5, 4}, 8000));
    ASSERT_EQ(mesh.vertices_mm.size(), 20U);
    ASSERT_EQ(mesh.texture_uv.size(), 20U);
    EXPECT_EQ(mesh.triangles.size(), 2U * 4U * 3U);
    EXPECT_TRUE(mesh.metric);
    EXPECT_TRUE(mesh.vertices_mm[7].isApprox(Vec3f(16.0F, 8.0F, 800.0F)));  // pixel (2, 1)
    EXPECT_FLOAT_EQ(mesh.texture_uv[7][0], 0.5F);
    EXPECT_FLOAT_EQ(mesh.texture_uv[7][1], 0.625F);  // the second row of four, from below
    for (const Triangle& t : mesh.triangles) {
        const Vec3f normal = (mesh.vertices_mm[t[1]] - mesh.vertices_mm[t[0]])
                                 .cross(mesh.vertices_mm[t[2]] - mesh.vertices_mm[t[0]]);
        EXPECT_LT(normal.z(), 0.0F);  // to the camera
    }
}

TEST(Mesh, NoTriangleCrossesAStepInDepth) {
    DepthFrame depth = wall({6, 5}, 9000);
    for (int v = 0; v < 5; ++v) {
        for (int u = 3; u < 6; ++u) {
            depth.depth.at(u, v) = 6000;
        }
    }
    const Mesh mesh = mesh_of(depth);
    EXPECT_EQ(mesh.vertices_mm.size(), 30U);
    EXPECT_EQ(mesh.triangles.size(), 2U * 2U * 4U * 2U);  // the column between the two has none
    for (const Triangle& t : mesh.triangles) {
        EXPECT_EQ(z_of(mesh, t[0]), z_of(mesh, t[1]));
        EXPECT_EQ(z_of(mesh, t[0]), z_of(mesh, t[2]));
    }
    // What is a step is the caller's to say.
    EXPECT_EQ(mesh_of(depth, {.max_step = 0.5}).triangles.size(), 2U * 5U * 4U);
    EXPECT_EQ(mesh_of(depth, {.max_step = 0.49}).triangles.size(), 2U * 2U * 4U * 2U);
}

TEST(Mesh, ThreePixelsOfFourAreOneTriangleWhicheverIsMissing) {
    struct Case {
        int u, v;
        Triangle left;  // vertices are numbered without the missing one
    };
    for (const Case& c : {Case{0, 0, {0, 1, 2}}, Case{1, 0, {0, 1, 2}}, Case{0, 1, {0, 2, 1}},
                          Case{1, 1, {0, 2, 1}}}) {
        // Without depth, and behind a step.
        for (const std::uint16_t odd : {std::uint16_t{0}, std::uint16_t{9000}}) {
            DepthFrame depth = wall({2, 2}, 5000);
            depth.depth.at(c.u, c.v) = odd;
            const Mesh mesh = mesh_of(depth);
            ASSERT_EQ(mesh.triangles.size(), 1U) << c.u << ' ' << c.v;
            if (odd == 0) {
                ASSERT_EQ(mesh.vertices_mm.size(), 3U);
                Triangle turned = mesh.triangles[0];
                std::rotate(turned.begin(), std::min_element(turned.begin(), turned.end()),
                            turned.end());
                EXPECT_EQ(turned, c.left) << c.u << ' ' << c.v;
            }
        }
    }
}

TEST(Mesh, NothingGivesNothing) {
    const Mesh mesh = mesh_of(wall({4, 4}, 0));
    EXPECT_TRUE(mesh.vertices_mm.empty());
    EXPECT_TRUE(mesh.triangles.empty());
    EXPECT_TRUE(mesh_of(wall({7, 1}, 5000)).triangles.empty());
}

TEST(Mesh, RefusesWhatDoesNotFit) {
    EXPECT_FALSE(make_mesh(wall({4, 4}, 5000), camera_of({4, 5})));
    for (const double step : {0.0, -1.0, 1.5, std::nan("")}) {
        const auto mesh = make_mesh(wall({4, 4}, 5000), camera_of({4, 4}), {.max_step = step});
        ASSERT_FALSE(mesh);
        EXPECT_EQ(mesh.error().code, ErrorCode::invalid_argument);
        EXPECT_NE(mesh.error().message.find("max_step"), std::string::npos);
    }
}

class Obj : public testing::Test {
 protected:
    void SetUp() override { fs::create_directories(folder_); }
    void TearDown() override { fs::remove_all(folder_); }

    static std::string text_of(const fs::path& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    fs::path folder_ =
        fs::path(testing::TempDir()) /
        (std::string("xtrack_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::path file_ = folder_ / "mesh.obj";
};

TEST_F(Obj, IsWrittenWithItsMaterial) {
    ASSERT_TRUE(write_obj(mesh_of(wall({2, 2}, 8000)), file_, "mesh.png"));
    EXPECT_EQ(text_of(file_),
              "# camera frame (x right, y down, z forward), mm\nmtllib mesh.mtl\nusemtl scene\n"
              "v 0.000 0.000 800.000\nv 8.000 0.000 800.000\nv 0.000 8.000 800.000\n"
              "v 8.000 8.000 800.000\nvt 0.250000 0.750000\nvt 0.750000 0.750000\n"
              "vt 0.250000 0.250000\nvt 0.750000 0.250000\nf 1/1 3/3 4/4\nf 1/1 4/4 2/2\n");
    EXPECT_EQ(text_of(folder_ / "mesh.mtl"),
              "newmtl scene\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd mesh.png\n");
}

TEST_F(Obj, WithoutATextureHasNoMaterial) {
    ASSERT_TRUE(write_obj(mesh_of(wall({2, 2}, 8000)), file_));
    EXPECT_EQ(text_of(file_).find("mtl"), std::string::npos);
    EXPECT_FALSE(fs::exists(folder_ / "mesh.mtl"));
}

TEST_F(Obj, RefusesWhatWouldBeWrongAndWritesNothing) {
    const Mesh good = mesh_of(wall({2, 2}, 8000));
    for (const char* texture : {"../mesh.png", "a/b.png", "two words.png", "x\nKd 0 0 0"}) {
        EXPECT_EQ(write_obj(good, file_, texture).error().code, ErrorCode::invalid_argument);
    }
    Mesh torn = good;
    torn.texture_uv.pop_back();
    EXPECT_EQ(write_obj(torn, file_).error().code, ErrorCode::invalid_argument);
    torn = good;
    torn.triangles[0][2] = 4;
    EXPECT_EQ(write_obj(torn, file_).error().code, ErrorCode::invalid_argument);
    EXPECT_TRUE(fs::is_empty(folder_));
    const auto nowhere = write_obj(good, "/nowhere/at/all/mesh.obj");
    ASSERT_FALSE(nowhere);
    EXPECT_NE(nowhere.error().message.find("/nowhere/at/all/mesh.obj"), std::string::npos);
}

}  // namespace
}  // namespace xtrack
