// SPDX-License-Identifier: Apache-2.0
#include "core/sim/renderer.hpp"

#include <algorithm>
#include <cmath>

namespace xtrack::sim {
namespace {

// Movement within an exposure that one moment cannot stand for, camera pixels.
constexpr float kBlurStepPx = 1.5F;
// Hands nearer than this are not drawn: nothing would be left of the image.
constexpr float kNearestMm = 120.0F;

}  // namespace

Renderer::Renderer(const SimSettings& settings, std::size_t channels)
    : settings_(settings),
      channels_(channels),
      timing_(settings),
      camera_(settings.rig.camera),
      lamp_(settings.rig, settings.patterns.axis, settings.projector.light_grey),
      scene_(build_static_scene(settings, camera_, lamp_)),
      curves_(settings, channels),
      model_(hand_model()),
      hand_scale_(static_cast<float>(settings.user.hand_length_mm) / kModelHandLengthMm) {
    for (const SimPath& path : settings.paths) {
        hands_.emplace_back(settings, path);
    }
    for (const SimHand hand : {SimHand::left, SimHand::right}) {
        if (settings.paths.empty() &&
            std::any_of(settings.script.begin(), settings.script.end(),
                        [hand](const SimStep& s) { return s.hand == hand; })) {
            hands_.emplace_back(settings, hand, model_);
        }
    }
    for (std::size_t part = 0; part < tints_.size(); ++part) {
        tints_[part] = tint_of(static_cast<SimPart>(part), channels > 1);
    }
    for (auto& moment : skinned_mm_) {
        moment.resize(model_.vertices.size());
    }
    normals_.assign(hands_.size(), std::vector<Vec3f>(model_.vertices.size()));
    corners_.resize(model_.vertices.size());
    surfels_ = Image<Surfel>(camera_.size().width, camera_.size().height, Surfel{});
    shadow_mm_.assign(scene_.shadow_mm.size(), kFarAway);
    blended_.resize(curves_.stride() * channels_);
}

void Renderer::clear() {
    for (int y = drawn_.y0; y < drawn_.y1; ++y) {
        std::fill(surfels_.row(y) + drawn_.x0, surfels_.row(y) + drawn_.x1, Surfel{});
    }
    const int map_width = lamp_.map_size().width;
    for (int y = shadowed_.y0; y < shadowed_.y1; ++y) {
        float* row = shadow_mm_.data() + static_cast<std::ptrdiff_t>(y) * map_width;
        std::fill(row + shadowed_.x0, row + shadowed_.x1, kFarAway);
    }
    drawn_ = kNoPixels;
    shadowed_ = kNoPixels;
}

void Renderer::move_hand(std::size_t hand, double middle_s) {
    const HandMotion& motion = hands_[hand];
    const auto skin_at = [&](std::size_t moment, double t_s) {
        skin(model_, pose_bones(motion.at(t_s), motion.hand(), hand_scale_), skinned_mm_[moment],
             normals_[hand]);
    };
    const double half = 0.5 * timing_.readout_s();
    if (half > 0.0) {
        skin_at(0, middle_s - half);
        skin_at(2, middle_s + half);
    }
    skin_at(1, middle_s);
    const float rows = static_cast<float>(camera_.size().height);
    for (std::size_t v = 0; v < corners_.size(); ++v) {
        Vec3f& p = skinned_mm_[1][v];
        Vertex& corner = corners_[v];
        if (half > 0.0 && p.z() > kNearestMm) {
            // Each point is where it is when its own row is open. Three moments give its path.
            constexpr float kOutOfFrame = 1.2F;
            const Vec3f speed = (skinned_mm_[2][v] - skinned_mm_[0][v]) * 0.5F;
            const Vec3f bend = (skinned_mm_[2][v] + skinned_mm_[0][v]) * 0.5F - p;
            const Vec3f middle = p;
            for (int step = 0; step < 2; ++step) {
                const float row = camera_.project(p).y;
                const float u =
                    std::clamp((row + 0.5F) / rows * 2.0F - 1.0F, -kOutOfFrame, kOutOfFrame);
                p = middle + speed * u + bend * (u * u);
            }
        }
        if (p.z() <= kNearestMm) {
            corner.inverse_z = -1.0F;
            continue;
        }
        corner.camera = snap(camera_.project(p));
        corner.inverse_z = 1.0F / p.z();
        corner.lamp = snap(lamp_.project_to_map(p, corner.lamp_depth_mm));
    }
}

void Renderer::draw_hand(std::size_t hand) {
    const bool mirrored = hands_[hand].hand() == SimHand::left;
    const PixelRect map{0, 0, lamp_.map_size().width, lamp_.map_size().height};
    auto number = static_cast<std::uint32_t>(hand * model_.triangles.size());
    for (const auto& triangle : model_.triangles) {
        const Vertex& a = corners_[triangle[0]];
        const Vertex& b = corners_[triangle[1]];
        const Vertex& c = corners_[triangle[2]];
        const std::uint32_t id = number++;
        if (a.inverse_z < 0.0F || b.inverse_z < 0.0F || c.inverse_z < 0.0F) {
            continue;
        }
        const auto see = [&](int x, int y, float w0, float w1, float w2) {
            const float z = 1.0F / (w0 * a.inverse_z + w1 * b.inverse_z + w2 * c.inverse_z);
            Surfel& s = surfels_.row(y)[x];
            if (z < s.depth_mm) {
                s = {z, id, w0, w1};
            }
        };
        const auto block = [&](int x, int y, float w0, float w1, float w2) {
            const float z = w0 * a.lamp_depth_mm + w1 * b.lamp_depth_mm + w2 * c.lamp_depth_mm;
            float& nearest = shadow_mm_[static_cast<std::size_t>(y * map.x1 + x)];
            nearest = std::min(nearest, z);
        };
        if (!mirrored) {
            raster_triangle(a.camera, b.camera, c.camera, camera_.frame(), drawn_, see);
            raster_triangle(a.lamp, b.lamp, c.lamp, map, shadowed_, block);
            continue;
        }
        // In a mirror the corners go round the other way.
        raster_triangle(a.camera, c.camera, b.camera, camera_.frame(), drawn_,
                        [&](int x, int y, float w0, float w2, float w1) { see(x, y, w0, w1, w2); });
        raster_triangle(
            a.lamp, c.lamp, b.lamp, map, shadowed_,
            [&](int x, int y, float w0, float w2, float w1) { block(x, y, w0, w1, w2); });
    }
}

void Renderer::draw_all(double middle_s) {
    clear();
    for (std::size_t hand = 0; hand < hands_.size(); ++hand) {
        move_hand(hand, middle_s);
        draw_hand(hand);
    }
}

void Renderer::draw_geometry(std::uint64_t frame) {
    draw_all(static_cast<double>(timing_.stamp(frame).ns) * 1e-9);
}

int Renderer::motion_samples(double stamp_s) const {
    float furthest = 0.0F;
    const double half = 0.5 * timing_.exposure_s();
    for (const HandMotion& motion : hands_) {
        const PosedBones before = pose_bones(motion.at(stamp_s - half), motion.hand(), hand_scale_);
        const PosedBones after = pose_bones(motion.at(stamp_s + half), motion.hand(), hand_scale_);
        for (std::size_t j = 0; j < kSimJointCount; ++j) {
            if (before.joints_mm[j].z() < kNearestMm || after.joints_mm[j].z() < kNearestMm) {
                continue;
            }
            const ScreenPoint a = camera_.project(before.joints_mm[j]);
            const ScreenPoint b = camera_.project(after.joints_mm[j]);
            furthest = std::max({furthest, std::abs(a.x - b.x), std::abs(a.y - b.y)});
        }
    }
    return std::clamp(static_cast<int>(std::ceil(furthest / kBlurStepPx)), 1,
                      settings_.camera.motion_samples);
}

Renderer::Curves Renderer::curves_for(const PatternMix& mix) {
    Curves curves;
    if (mix.count == 1) {
        for (std::size_t c = 0; c < channels_; ++c) {
            curves.of_channel[c] = curves_.curve(mix.shares[0].pattern, c);
        }
        return curves;
    }
    for (std::size_t c = 0; c < channels_; ++c) {
        float* out = blended_.data() + c * curves_.stride();
        curves.of_channel[c] = out;
        if (mix == blended_mix_) {
            continue;
        }
        std::fill(out, out + curves_.stride(), 0.0F);
        for (std::size_t i = 0; i < mix.count; ++i) {
            const float* in = curves_.curve(mix.shares[i].pattern, c);
            for (std::size_t x = 0; x < curves_.stride(); ++x) {
                out[x] += mix.shares[i].weight * in[x];
            }
        }
    }
    blended_mix_ = mix;
    return curves;
}

void Renderer::light_surfel(int x, int y, const Surfel& s, const Curves& curves, float share,
                            float* pixel) const {
    const auto& t = model_.triangles[s.triangle % model_.triangles.size()];
    const auto& normals = normals_[hand_of(s)];
    const auto& v = model_.vertices;
    const float w2 = 1.0F - s.w0 - s.w1;
    const Vec3f normal =
        (normals[t[0]] * s.w0 + normals[t[1]] * s.w1 + normals[t[2]] * w2).normalized();
    const SimPart part = v[t[0]].part;
    const float albedo = (v[t[0]].albedo * s.w0 + v[t[1]].albedo * s.w1 + v[t[2]].albedo * w2) *
                         static_cast<float>(part == SimPart::body ? settings_.user.clothing_albedo
                                                                  : settings_.user.skin_albedo);
    const Vec3f ray(scene_.ray_x.row(y)[x], scene_.ray_y.row(y)[x], 1.0F);
    Lit lit = lamp_.at(ray * s.depth_mm, normal, albedo);
    if (lit.cell != kUnlit) {
        // A slanted surface covers more depth within one cell of the map.
        constexpr float kMostSlant = 0.15F;
        const float slant = ray.norm() / std::max(kMostSlant, -normal.dot(ray));
        const float limit = lit.depth_mm - kShadowSlackMm - slant;
        if (shadow_mm_[lit.cell] < limit || scene_.shadow_mm[lit.cell] < limit) {
            lit.light = 0.0F;
        }
    }
    const auto cell = static_cast<std::ptrdiff_t>(lit.coordinate_px);
    const float f = lit.coordinate_px - static_cast<float>(cell);
    const float ambient =
        static_cast<float>(settings_.room.ambient_grey) * albedo * ambient_share(normal);
    const Tint& tint = tints_[static_cast<std::size_t>(part)];
    for (std::size_t c = 0; c < channels_; ++c) {
        const float* curve = curves.of_channel[c] + cell;
        pixel[c] +=
            share * tint[c] * (ambient + lit.light * (curve[0] + f * (curve[1] - curve[0])));
    }
}

void Renderer::add_background(int x, int y, const Curves& curves, float share, float* pixel) const {
    const float coordinate = scene_.coordinate_px.row(y)[x];
    const float lit = scene_.light.row(y)[x];
    const float ambient = scene_.ambient.row(y)[x];
    const auto cell = static_cast<std::ptrdiff_t>(coordinate);
    const float f = coordinate - static_cast<float>(cell);
    const Tint& tint = tints_[scene_.part.row(y)[x]];
    for (std::size_t c = 0; c < channels_; ++c) {
        const float* curve = curves.of_channel[c] + cell;
        pixel[c] += share * tint[c] * (ambient + lit * (curve[0] + f * (curve[1] - curve[0])));
    }
}

void Renderer::light_background(int y, const Curves& curves, float* row) const {
    const int width = camera_.size().width;
    if (channels_ > 1) {
        for (int x = 0; x < width; ++x) {
            add_background(x, y, curves, 1.0F, row + static_cast<std::size_t>(x) * channels_);
        }
        return;
    }
    const float* curve = curves.of_channel[0];
    const float* coordinate = scene_.coordinate_px.row(y);
    const float* light = scene_.light.row(y);
    const float* ambient = scene_.ambient.row(y);
    for (int x = 0; x < width; ++x) {
        const auto cell = static_cast<std::int32_t>(coordinate[x]);
        const float f = coordinate[x] - static_cast<float>(cell);
        row[x] = ambient[x] + light[x] * (curve[cell] + f * (curve[cell + 1] - curve[cell]));
    }
}

void Renderer::cast_shadow(int y, const Curves& curves, float share, float* row) const {
    const int width = camera_.size().width;
    const std::uint32_t* cells = scene_.cell.row(y);
    const float* coordinate = scene_.coordinate_px.row(y);
    const float* light = scene_.light.row(y);
    const float* depth = scene_.projector_depth_mm.row(y);
    const std::uint8_t* parts = scene_.part.row(y);
    const auto map_width = static_cast<std::uint32_t>(lamp_.map_size().width);
    const std::uint32_t first = static_cast<std::uint32_t>(shadowed_.y0) * map_width;
    const std::uint32_t cells_in_reach =
        static_cast<std::uint32_t>(shadowed_.y1 - shadowed_.y0) * map_width;
    for (int x = 0; x < width; ++x) {
        // One comparison: what is below `first` wraps round, as kUnlit is beyond.
        if (cells[x] - first >= cells_in_reach ||
            shadow_mm_[cells[x]] >= depth[x] - kShadowSlackMm) {
            continue;
        }
        const auto cell = static_cast<std::ptrdiff_t>(coordinate[x]);
        const float f = coordinate[x] - static_cast<float>(cell);
        const Tint& tint = tints_[parts[x]];
        float* pixel = row + static_cast<std::size_t>(x) * channels_;
        for (std::size_t c = 0; c < channels_; ++c) {
            const float* curve = curves.of_channel[c] + cell;
            pixel[c] -= share * tint[c] * light[x] * (curve[0] + f * (curve[1] - curve[0]));
        }
    }
}

/// Puts the hands where the row shows the background, shadowed or not.
void Renderer::light_hands(int y, const Curves& curves, float share, float* row) const {
    const Surfel* surfels = surfels_.row(y);
    const float* background_mm = scene_.depth_mm.row(y);
    for (int x = drawn_.x0; x < drawn_.x1; ++x) {
        if (surfels[x].depth_mm >= background_mm[x]) {
            continue;
        }
        float* pixel = row + static_cast<std::size_t>(x) * channels_;
        light_surfel(x, y, surfels[x], curves, share, pixel);
        // The background behind is taken away: all of it, or in shadow only its ambient light.
        const std::uint32_t cell = scene_.cell.row(y)[x];
        if (cell != kUnlit &&
            shadow_mm_[cell] < scene_.projector_depth_mm.row(y)[x] - kShadowSlackMm) {
            const Tint& tint = tints_[scene_.part.row(y)[x]];
            for (std::size_t c = 0; c < channels_; ++c) {
                pixel[c] -= share * tint[c] * scene_.ambient.row(y)[x];
            }
        } else {
            add_background(x, y, curves, -share, pixel);
        }
    }
}

void Renderer::expose(std::uint64_t frame, ImageView<float> light) {
    const double stamp_s = static_cast<double>(timing_.stamp(frame).ns) * 1e-9;
    const double exposure_s = timing_.exposure_s();
    for (int y = 0; y < light.height; ++y) {
        float* row = light.row(y);
        std::fill(row, row + light.width, 0.0F);
        const double begin_s = stamp_s + timing_.row_offset_s(y) - 0.5 * exposure_s;
        light_background(y, curves_for(timing_.shown(begin_s, begin_s + exposure_s)), row);
    }
    if (hands_.empty()) {
        return;
    }
    // What moves is seen at several moments of the exposure, each a share of the light.
    const int samples = motion_samples(stamp_s);
    const double slice_s = exposure_s / samples;
    const float share = 1.0F / static_cast<float>(samples);
    for (int sample = 0; sample < samples; ++sample) {
        const double begin_s = stamp_s - 0.5 * exposure_s + sample * slice_s;
        draw_all(begin_s + 0.5 * slice_s);
        for (int y = 0; y < light.height; ++y) {
            const double open_s = begin_s + timing_.row_offset_s(y);
            const Curves curves = curves_for(timing_.shown(open_s, open_s + slice_s));
            if (!shadowed_.empty()) {
                cast_shadow(y, curves, share, light.row(y));
            }
            if (y >= drawn_.y0 && y < drawn_.y1) {
                light_hands(y, curves, share, light.row(y));
            }
        }
    }
}

}  // namespace xtrack::sim
