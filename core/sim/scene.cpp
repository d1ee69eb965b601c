// SPDX-License-Identifier: Apache-2.0
#include "core/sim/scene.hpp"

#include <algorithm>
#include <cmath>

#include "core/pattern/response_curve.hpp"
#include "core/sim/mesh.hpp"
#include "core/sim/random.hpp"

namespace xtrack::sim {
namespace {

/// A standing person's upper body. Its own axes are the camera's, origin in the middle of the
/// chest.
float body_distance(const Vec3f& p) {
    constexpr float kFilletMm = 60.0F;
    constexpr float kFlat = 1.65F;  // a chest is wider than it is deep
    const Vec3f q{p.x(), p.y(), p.z() * kFlat};
    const TaperedCapsule chest{{0.0F, 60.0F, 0.0F}, {0.0F, 560.0F, 0.0F}, 165.0F, 150.0F};
    const TaperedCapsule shoulders{{-125.0F, -25.0F, 15.0F}, {125.0F, -25.0F, 15.0F}, 68.0F, 68.0F};
    const TaperedCapsule neck{{0.0F, -90.0F, 20.0F}, {0.0F, -190.0F, 5.0F}, 58.0F, 55.0F};
    const TaperedCapsule head{{0.0F, -215.0F, -15.0F}, {0.0F, -290.0F, 0.0F}, 68.0F, 84.0F};
    float d = distance(chest, q) / kFlat;
    d = smooth_union(d, distance(shoulders, p), kFilletMm);
    d = smooth_union(d, distance(neck, p), kFilletMm * 0.5F);
    return smooth_union(d, distance(head, p), kFilletMm * 0.4F);
}

constexpr float kChestHalfDepthMm = 100.0F;
constexpr float kCollarMm = -120.0F;  // skin above, clothing below

struct Body {
    Mesh mesh;
    std::vector<float> albedo;
};

Body build_body(const SimSettings& settings) {
    constexpr float kStepMm = 11.0F;
    Body body;
    body.mesh =
        polygonise(body_distance, grid_planes(-240.0F, 240.0F, kStepMm),
                   grid_planes(-400.0F, 740.0F, kStepMm), grid_planes(-140.0F, 140.0F, kStepMm));
    const auto z = static_cast<float>(settings.user.chest_distance_mm) + kChestHalfDepthMm;
    for (Vec3f& p : body.mesh.positions_mm) {
        const double albedo =
            p.y() < kCollarMm ? settings.user.skin_albedo : settings.user.clothing_albedo;
        const float cloth = 1.0F + 0.12F * value_noise(p / 45.0F, settings.seed) +
                            0.08F * value_noise(p / 16.0F, settings.seed + 1);
        body.albedo.push_back(static_cast<float>(albedo) * cloth);
        p.z() += z;
    }
    return body;
}

void cast_body(const Body& body, const Lamp& lamp, std::vector<float>& shadow_mm) {
    const PixelRect clip{0, 0, lamp.map_size().width, lamp.map_size().height};
    PixelRect touched = kNoPixels;
    std::vector<Corner> corners;
    std::vector<float> depth_mm;
    for (const Vec3f& p : body.mesh.positions_mm) {
        depth_mm.push_back(0.0F);
        corners.push_back(snap(lamp.project_to_map(p, depth_mm.back())));
    }
    for (const auto& t : body.mesh.triangles) {
        raster_triangle(corners[t[0]], corners[t[1]], corners[t[2]], clip, touched,
                        [&](int x, int y, float w0, float w1, float w2) {
                            float& nearest = shadow_mm[static_cast<std::size_t>(y * clip.x1 + x)];
                            nearest = std::min(nearest, w0 * depth_mm[t[0]] + w1 * depth_mm[t[1]] +
                                                            w2 * depth_mm[t[2]]);
                        });
    }
}

/// What the camera sees at one pixel.
struct Seen {
    Vec3f normal = Vec3f::Zero();
    float albedo = 0.0F;
};

void see_wall(const SimSettings& settings, StaticScene& scene, std::vector<Seen>& seen) {
    const auto yaw = static_cast<float>(settings.room.wall_yaw_rad);
    const Vec3f normal{std::sin(yaw), 0.0F, -std::cos(yaw)};
    const auto distance_mm = static_cast<float>(settings.room.wall_distance_mm);
    const auto albedo = static_cast<float>(settings.room.wall_albedo);
    for (int y = 0; y < scene.depth_mm.height(); ++y) {
        for (int x = 0; x < scene.depth_mm.width(); ++x) {
            const float along = std::cos(yaw) - scene.ray_x.at(x, y) * std::sin(yaw);
            const float z = distance_mm * std::cos(yaw) / along;
            const Vec3f p = Vec3f(scene.ray_x.at(x, y), scene.ray_y.at(x, y), 1.0F) * z;
            scene.depth_mm.at(x, y) = z;
            scene.part.at(x, y) = static_cast<std::uint8_t>(SimPart::wall);
            const float paint = 1.0F + 0.04F * value_noise(p / 90.0F, settings.seed + 2) +
                                0.03F * value_noise(p / 12.0F, settings.seed + 3);
            seen[static_cast<std::size_t>(y * scene.depth_mm.width() + x)] = {normal,
                                                                              albedo * paint};
        }
    }
}

void see_body(const Body& body, const Lens& camera, StaticScene& scene, std::vector<Seen>& seen) {
    const Mesh& mesh = body.mesh;
    PixelRect touched = kNoPixels;
    std::vector<Corner> corner;
    for (const Vec3f& p : mesh.positions_mm) {
        corner.push_back(snap(camera.project(p)));
    }
    for (const auto& t : mesh.triangles) {
        const float za = 1.0F / mesh.positions_mm[t[0]].z();
        const float zb = 1.0F / mesh.positions_mm[t[1]].z();
        const float zc = 1.0F / mesh.positions_mm[t[2]].z();
        raster_triangle(
            corner[t[0]], corner[t[1]], corner[t[2]], camera.frame(), touched,
            [&](int x, int y, float w0, float w1, float w2) {
                const float z = 1.0F / (w0 * za + w1 * zb + w2 * zc);
                if (z >= scene.depth_mm.at(x, y)) {
                    return;
                }
                scene.depth_mm.at(x, y) = z;
                scene.part.at(x, y) = static_cast<std::uint8_t>(SimPart::body);
                Seen& s = seen[static_cast<std::size_t>(y * scene.depth_mm.width() + x)];
                s.normal =
                    (mesh.normals[t[0]] * w0 + mesh.normals[t[1]] * w1 + mesh.normals[t[2]] * w2)
                        .normalized();
                s.albedo = body.albedo[t[0]] * w0 + body.albedo[t[1]] * w1 + body.albedo[t[2]] * w2;
            });
    }
}

}  // namespace

Tint tint_of(SimPart part, bool colour) {
    if (!colour) {
        return {1.0F, 1.0F, 1.0F};
    }
    switch (part) {
        case SimPart::hand:
        case SimPart::forearm: return {0.66F, 0.84F, 1.22F};
        case SimPart::body: return {1.20F, 1.00F, 0.85F};
        case SimPart::wall:
        case SimPart::none: break;
    }
    return {0.95F, 1.00F, 1.03F};
}

Lamp::Lamp(const Rig& rig, Axis axis, double light_grey)
    : lens_(*rig.projector),
      rotation_(rig.projector_from_camera_R.cast<float>()),
      offset_mm_(rig.projector_from_camera_T.cast<float>()),
      centre_mm_(-(rotation_.transpose() * offset_mm_)),
      axis_(axis),
      light_grey_(static_cast<float>(light_grey)) {}

Lit Lamp::at(const Vec3f& point_mm, const Vec3f& normal, float albedo) const {
    constexpr float kReferenceMm2 = 1.0e6F;  // light_grey holds 1 m away
    Lit lit;
    const Vec3f to_lamp = centre_mm_ - point_mm;
    const float d2 = to_lamp.squaredNorm();
    const float facing = to_lamp.dot(normal);
    if (facing <= 0.0F) {
        return lit;
    }
    const ScreenPoint s = project(point_mm, lit.depth_mm);
    const int x = static_cast<int>(std::floor(s.x + 0.5F));
    const int y = static_cast<int>(std::floor(s.y + 0.5F));
    if (x < 0 || y < 0 || x >= lens_.size().width || y >= lens_.size().height) {
        return lit;
    }
    lit.light = light_grey_ * albedo * facing * kReferenceMm2 / (d2 * std::sqrt(d2));
    const float coded = axis_ == Axis::x ? s.x : s.y;
    const int last = (axis_ == Axis::x ? lens_.size().width : lens_.size().height) - 1;
    lit.coordinate_px = std::clamp(coded, 0.0F, static_cast<float>(last));
    lit.cell = static_cast<std::uint32_t>(y / kShadowCellPx * map_size().width + x / kShadowCellPx);
    return lit;
}

StaticScene build_static_scene(const SimSettings& settings, const Lens& camera, const Lamp& lamp) {
    const int width = camera.size().width;
    const int height = camera.size().height;
    StaticScene scene;
    for (Image<float>* image : {&scene.ray_x, &scene.ray_y, &scene.depth_mm, &scene.light,
                                &scene.coordinate_px, &scene.projector_depth_mm, &scene.ambient}) {
        image->resize(width, height);
        image->fill(0.0F);
    }
    scene.part.resize(width, height);
    scene.cell.resize(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Vec2f ray = camera.ray(static_cast<float>(x), static_cast<float>(y));
            scene.ray_x.at(x, y) = ray.x();
            scene.ray_y.at(x, y) = ray.y();
        }
    }
    scene.shadow_mm.assign(static_cast<std::size_t>(lamp.map_size().width) *
                               static_cast<std::size_t>(lamp.map_size().height),
                           kFarAway);
    std::vector<Seen> seen(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    see_wall(settings, scene, seen);
    if (settings.user.visible_body) {
        const Body body = build_body(settings);
        cast_body(body, lamp, scene.shadow_mm);
        see_body(body, camera, scene, seen);
    }
    const auto ambient = static_cast<float>(settings.room.ambient_grey);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Seen& s = seen[static_cast<std::size_t>(y * width + x)];
            const float z = scene.depth_mm.at(x, y);
            const Vec3f p = Vec3f(scene.ray_x.at(x, y), scene.ray_y.at(x, y), 1.0F) * z;
            Lit lit = lamp.at(p, s.normal, s.albedo);
            if (lit.cell != kUnlit) {
                constexpr float kBodySlackMm = 3.0F * kShadowSlackMm;  // coarser facets
                if (scene.shadow_mm[lit.cell] < lit.depth_mm - kBodySlackMm) {
                    lit.light = 0.0F;
                    lit.cell = kUnlit;
                }
            }
            scene.light.at(x, y) = lit.light;
            scene.coordinate_px.at(x, y) = lit.coordinate_px;
            scene.cell.at(x, y) = lit.cell;
            scene.projector_depth_mm.at(x, y) = lit.depth_mm;
            scene.ambient.at(x, y) = ambient * s.albedo * ambient_share(s.normal);
        }
    }
    return scene;
}

PatternCurves::PatternCurves(const SimSettings& settings, std::size_t channels)
    : length_(static_cast<std::size_t>(settings.patterns.coded_length_px())), channels_(channels) {
    const std::size_t patterns = settings.patterns.patterns.size();
    values_.resize(patterns * channels * stride());
    // Rows: camera blue, green, red (or grey); columns: projector red, green, blue.
    std::array<std::array<double, 3>, kMaxChannels> mix_rgb{};
    if (channels == 1) {
        mix_rgb[0] = {0.299, 0.587, 0.114};  // a grey sensor, as BT.601 luma
    } else {
        const Mat3d rgb = settings.rig.camera_from_projector_rgb.value_or(Mat3d::Identity());
        for (std::size_t c = 0; c < kMaxChannels; ++c) {
            for (std::size_t k = 0; k < 3; ++k) {
                mix_rgb[c][k] = rgb(2 - static_cast<int>(c), static_cast<int>(k));
            }
        }
    }
    constexpr double kLevels = 255.0;
    const double black = 1.0 / settings.projector.contrast;
    const double sigma = settings.projector.blur_px;
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    const int last = static_cast<int>(length_) - 1;
    std::vector<double> sharp(length_);
    std::vector<double> blurred(length_);
    std::vector<double> kernel;
    double sum = 0.0;
    for (int i = -radius; i <= radius; ++i) {
        kernel.push_back(sigma > 0.0 ? std::exp(-0.5 * i * i / (sigma * sigma)) : 1.0);
        sum += kernel.back();
    }
    for (std::size_t p = 0; p < patterns; ++p) {
        for (int colour = 0; colour < 3; ++colour) {
            const auto& believed = settings.projector.compensation;
            const ResponseCurve driver =
                believed ? ResponseCurve(believed->light[static_cast<std::size_t>(colour)])
                         : ResponseCurve();
            for (std::size_t x = 0; x < length_; ++x) {
                const double shown = driver.value(
                    intensity(settings.patterns.patterns[p], static_cast<double>(x), colour));
                const double level = std::round(shown * kLevels) / kLevels;
                const double bent = settings.projector.s_curve[static_cast<std::size_t>(colour)];
                const double light = (1.0 - bent) * std::pow(level, settings.projector.gamma) +
                                     bent * level * level * (3.0 - 2.0 * level);
                sharp[x] = black + (1.0 - black) * light;
            }
            for (int x = 0; x <= last; ++x) {
                double v = 0.0;
                for (int i = -radius; i <= radius; ++i) {
                    v += kernel[static_cast<std::size_t>(i + radius)] *
                         sharp[static_cast<std::size_t>(std::clamp(x + i, 0, last))];
                }
                blurred[static_cast<std::size_t>(x)] = v / sum;
            }
            for (std::size_t c = 0; c < channels; ++c) {
                float* curve = values_.data() + (p * channels + c) * stride();
                const auto share = static_cast<float>(mix_rgb[c][static_cast<std::size_t>(colour)]);
                for (std::size_t x = 0; x < length_; ++x) {
                    curve[x] += share * static_cast<float>(blurred[x]);
                }
                curve[length_] = curve[length_ - 1];
            }
        }
    }
}

}  // namespace xtrack::sim
