// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include <xtrack/point_cloud.hpp>

namespace xtrack {
namespace {

Rig camera_only() {
    Rig rig;
    rig.camera.matrix << 100.0, 0.0, 1.0, 0.0, 100.0, 0.0, 0.0, 0.0, 1.0;
    rig.camera.size = {3, 2};
    return rig;
}

DepthFrame two_points() {
    DepthFrame depth;
    depth.depth = Image<std::uint16_t>(3, 2, 0);
    depth.depth.at(2, 0) = 5000;
    depth.depth.at(0, 1) = 10000;
    return depth;
}

TEST(PointCloud, PutsEveryDepthOnItsRay) {
    Image<float> grey(3, 2, 10.0F);
    grey.at(0, 1) = 300.0F;
    const auto cloud = make_point_cloud(two_points(), camera_only(), grey.view());
    ASSERT_TRUE(cloud) << cloud.error().message;
    ASSERT_EQ(cloud->points_mm.size(), 2U);
    EXPECT_TRUE(cloud->points_mm[0].isApprox(Vec3f(5.0F, 0.0F, 500.0F)));
    EXPECT_TRUE(cloud->points_mm[1].isApprox(Vec3f(-10.0F, 10.0F, 1000.0F)));
    EXPECT_EQ(cloud->colours_rgb[0][0], 10);
    EXPECT_EQ(cloud->colours_rgb[1][2], 255);
    EXPECT_TRUE(make_point_cloud(two_points(), camera_only())->colours_rgb.empty());
}

TEST(PointCloud, RefusesSizesThatDisagree) {
    Rig rig = camera_only();
    rig.camera.size = {4, 2};
    EXPECT_FALSE(make_point_cloud(two_points(), rig));
    EXPECT_FALSE(make_point_cloud(two_points(), camera_only(), Image<float>(2, 2).view()));
    rig = camera_only();
    rig.camera.matrix(1, 1) = 0.0;
    EXPECT_FALSE(make_point_cloud(two_points(), rig));
}

TEST(PointCloud, WritesBinaryPly) {
    const auto file = std::filesystem::temp_directory_path() / "xtrack_test_cloud.ply";
    PointCloud cloud;
    cloud.points_mm = {Vec3f(1.0F, -2.0F, 400.5F), Vec3f(0.0F, 0.0F, 1.0F)};
    cloud.colours_rgb = {{1, 2, 3}, {4, 5, 255}};
    ASSERT_TRUE(write_ply(cloud, file));
    std::ifstream in(file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    const std::string end = "end_header\n";
    const std::size_t body = bytes.find(end) + end.size();
    EXPECT_EQ(bytes.rfind("ply\nformat binary_little_endian 1.0\n", 0), 0U);
    EXPECT_NE(bytes.find("element vertex 2\n"), std::string::npos);
    ASSERT_EQ(bytes.size(), body + 2U * 15U);
    // 400.5 = 0x43C84000, least byte first.
    EXPECT_EQ(bytes.substr(body + 8, 4), std::string("\x00\x40\xC8\x43", 4));
    EXPECT_EQ(bytes.back(), '\xFF');
    std::filesystem::remove(file);
}

TEST(PointCloud, WritesBinaryPcd) {
    const auto file = std::filesystem::path(testing::TempDir()) / "xtrack_test_cloud.pcd";
    PointCloud cloud;
    cloud.points_mm = {Vec3f(1.0F, -2.0F, 400.5F), Vec3f(0.0F, 0.0F, 1.0F)};
    cloud.colours_rgb = {{1, 2, 3}, {4, 5, 255}};
    ASSERT_TRUE(write_pcd(cloud, file));
    const auto read = [&] {
        std::ifstream in(file, std::ios::binary);
        return std::string((std::istreambuf_iterator<char>(in)), {});
    };
    std::string bytes = read();
    const std::string header =
        "# .PCD v0.7 - Point Cloud Data file format\n# camera frame, mm\nVERSION 0.7\n"
        "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
        "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA binary\n";
    ASSERT_EQ(bytes.substr(0, header.size()), header);
    ASSERT_EQ(bytes.size(), header.size() + 2U * 16U);
    // -2 = 0xC0000000, 400.5 = 0x43C84000, then blue, green, red, nothing.
    EXPECT_EQ(bytes.substr(header.size() + 4, 12),
              std::string("\x00\x00\x00\xC0\x00\x40\xC8\x43\x03\x02\x01\x00", 12));
    EXPECT_EQ(bytes.substr(bytes.size() - 4), std::string("\xFF\x05\x04\x00", 4));

    cloud.colours_rgb.clear();
    cloud.metric = false;
    ASSERT_TRUE(write_pcd(cloud, file));
    bytes = read();
    EXPECT_NE(bytes.find("# camera frame, relative, no scale\n"), std::string::npos);
    EXPECT_NE(bytes.find("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"), std::string::npos);
    const std::string data = "DATA binary\n";
    EXPECT_EQ(bytes.size(), bytes.find(data) + data.size() + 2U * 12U);
    std::filesystem::remove(file);
}

TEST(PointCloud, TouchesNoFileButItsOwn) {
    const std::filesystem::path file =
        std::filesystem::path(testing::TempDir()) / "xtrack_test_own.ply";
    std::ofstream(file.string() + ".part") << "mine";
    ASSERT_TRUE(write_ply(PointCloud{}, file));
    std::string kept;
    std::ifstream(file.string() + ".part") >> kept;
    EXPECT_EQ(kept, "mine");
    std::filesystem::remove(file);
    std::filesystem::remove(file.string() + ".part");
}

TEST(PointCloud, SaysWhichFileCannotBeWritten) {
    const auto result = write_ply(PointCloud{}, "/nowhere/at/all/cloud.ply");
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::io);
    EXPECT_NE(result.error().message.find("/nowhere/at/all/cloud.ply"), std::string::npos);
    PointCloud torn;
    torn.points_mm.resize(2, Vec3f::Zero());
    torn.colours_rgb.resize(1);
    EXPECT_EQ(write_ply(torn, "/tmp/x.ply").error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(write_pcd(torn, "/tmp/x.pcd").error().code, ErrorCode::invalid_argument);
    const auto pcd = write_pcd(PointCloud{}, "/nowhere/at/all/cloud.pcd");
    ASSERT_FALSE(pcd);
    EXPECT_NE(pcd.error().message.find("/nowhere/at/all/cloud.pcd"), std::string::npos);
}

}  // namespace
}  // namespace xtrack
