// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <xtrack/mesh.hpp>

#include "core/base/file.hpp"
#include "core/base/text.hpp"
#include "core/depth/cloud_bytes.hpp"

namespace xtrack {

namespace {

constexpr int kMmDigits = 3;
constexpr int kTextureDigits = 6;
constexpr const char* kMaterial = "scene";

bool is_file_name(const std::string& text) {
    return base::stays_inside(text) && text.find_first_of("/\\ ") == std::string::npos;
}

bool consistent(const Mesh& mesh) {
    return mesh.texture_uv.size() == mesh.vertices_mm.size() &&
           std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& corners) {
               return *std::max_element(corners.begin(), corners.end()) < mesh.vertices_mm.size();
           });
}

// The image as it is: light is in it already.
std::string material_text(const std::string& texture) {
    return std::string("newmtl ") + kMaterial + "\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd " +
           texture + "\n";
}

void append_numbers(std::string& text, const char* keyword, const float* values, int count,
                    int digits) {
    text += keyword;
    for (int i = 0; i < count; ++i) {
        text += ' ';
        base::append_fixed(text, values[i], digits);
    }
    text += '\n';
}

std::string mesh_text(const Mesh& mesh, const std::string& materials) {
    std::string text = "# camera frame (x right, y down, z forward), ";
    text += unit_of(mesh.metric);
    text += '\n';
    if (!materials.empty()) {
        text += "mtllib " + materials + "\nusemtl " + kMaterial + "\n";
    }
    for (const Vec3f& vertex : mesh.vertices_mm) {
        append_numbers(text, "v", vertex.data(), 3, kMmDigits);
    }
    for (const auto& uv : mesh.texture_uv) {
        append_numbers(text, "vt", uv.data(), 2, kTextureDigits);
    }
    for (const auto& corners : mesh.triangles) {
        text += 'f';
        for (const std::uint32_t corner : corners) {
            const std::string number = std::to_string(corner + 1U);  // OBJ counts from one
            text += ' ';
            text += number;
            text += '/';
            text += number;
        }
        text += '\n';
    }
    return text;
}

}  // namespace

Result<void> write_obj(const Mesh& mesh, const std::filesystem::path& file,
                       const std::string& texture) {
    if (!consistent(mesh)) {
        return Error{ErrorCode::invalid_argument,
                     "mesh: every vertex needs a texture_uv and every triangle three vertices"};
    }
    std::string materials;
    if (!texture.empty()) {
        if (!is_file_name(texture)) {
            return Error{ErrorCode::invalid_argument,
                         "mesh: the texture must be a plain file name without blanks"};
        }
        const std::filesystem::path beside = std::filesystem::path(file).replace_extension(".mtl");
        if (auto ok = base::write_file(beside, material_text(texture)); !ok) {
            return ok;
        }
        materials = beside.filename().string();
    }
    return base::write_file(file, mesh_text(mesh, materials));
}

}  // namespace xtrack
