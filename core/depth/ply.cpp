// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include <xtrack/point_cloud.hpp>

namespace xtrack {
namespace {

void append_little_endian(std::vector<char>& out, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned shift = 0; shift < 32U; shift += 8U) {
        out.push_back(static_cast<char>((bits >> shift) & 0xFFU));
    }
}

Error cannot(const std::filesystem::path& file, const char* what) {
    return Error{ErrorCode::io, file.string() + ": " + what};
}

}  // namespace

Result<void> write_ply(const PointCloud& cloud, const std::filesystem::path& file) {
    const bool coloured = !cloud.colours_rgb.empty();
    if (coloured && cloud.colours_rgb.size() != cloud.points_mm.size()) {
        return Error{ErrorCode::invalid_argument,
                     "point cloud: colours_rgb must be empty or hold one colour a point"};
    }
    std::string header = "ply\nformat binary_little_endian 1.0\ncomment camera frame, ";
    header += cloud.metric ? "mm" : "relative, no scale";
    header += "\nelement vertex " + std::to_string(cloud.points_mm.size()) +
              "\nproperty float x\nproperty float y\nproperty float z\n";
    if (coloured) {
        header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    }
    header += "end_header\n";

    std::vector<char> body;
    body.reserve(cloud.points_mm.size() * (coloured ? 15U : 12U));
    for (std::size_t i = 0; i < cloud.points_mm.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            append_little_endian(body, cloud.points_mm[i](axis));
        }
        if (coloured) {
            for (const std::uint8_t channel : cloud.colours_rgb[i]) {
                body.push_back(static_cast<char>(channel));
            }
        }
    }

    std::filesystem::path partial = file;
    partial += ".part";
    std::error_code ignored;
    {
        std::ofstream out(partial, std::ios::binary | std::ios::trunc);
        if (!out) {
            return cannot(file,
                          "cannot be written; does its folder exist, and may you write there?");
        }
        out.write(header.data(), static_cast<std::streamsize>(header.size()));
        out.write(body.data(), static_cast<std::streamsize>(body.size()));
        out.close();
        if (!out) {
            std::filesystem::remove(partial, ignored);
            return cannot(file, "could not be written to the end; is the disk full?");
        }
    }
    std::error_code error;
    std::filesystem::rename(partial, file, error);
    if (error) {
        std::filesystem::remove(partial, ignored);
        return cannot(file, "cannot be replaced by the new file");
    }
    return {};
}

}  // namespace xtrack
