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

PixelRect around(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c,
                 const PixelRect& clip) {
    const auto low = [](float v) { return static_cast<int>(std::floor(v)); };
    const auto high = [](float v) { return static_cast<int>(std::ceil(v)) + 1; };
    return {std::max(clip.x0, low(std::min({a.x, b.x, c.x}))),
            std::max(clip.y0, low(std::min({a.y, b.y, c.y}))),
            std::min(clip.x1, high(std::max({a.x, b.x, c.x}))),
            std::min(clip.y1, high(std::max({a.y, b.y, c.y})))};
}

}  // namespace

Renderer::Renderer(const SimSettings& settings, std::size_t channels)
    : settings_(settings),
      channels_(channels),
      timing_(settings),
      camera_(settings.rig.camera),
      lamp_(settings.rig, settings.patterns.axis, settings.projector.light_grey),
      scene_(build_static_scene(settings, camera_, lamp_)),
      curves_(settings, channels),
      model_(build_hand_model()),
      hand_scale_(static_cast<float>(settings.user.hand_length_mm) / kModelHandLengthMm) {
    for (const SimHand hand : {SimHand::left, SimHand::right}) {
        if (std::any_of(settings.script.begin(), settings.script.end(),
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
    normals_.resize(model_.vertices.size());
    corners_.resize(model_.vertices.size());
    surfels_ = Image<Surfel>(camera_.size().width, camera_.size().height, Surfel{});
    shadow_mm_ = Image<float>(lamp_.size().width, lamp_.size().height, kFarAway);
    blended_.resize(curves_.stride() * channels_);
}

void Renderer::clear() {
    for (int y = drawn_.y0; y < drawn_.y1; ++y) {
        std::fill(surfels_.row(y) + drawn_.x0, surfels_.row(y) + drawn_.x1, Surfel{});
    }
    for (int y = shadowed_.y0; y < shadowed_.y1; ++y) {
        std::fill(shadow_mm_.row(y) + shadowed_.x0, shadow_mm_.row(y) + shadowed_.x1, kFarAway);
    }
    drawn_ = {};
    shadowed_ = {};
}

void Renderer::move_hand(std::size_t hand, double middle_s) {
    const HandMotion& motion = hands_[hand];
    const auto skin_at = [&](std::size_t moment, double t_s) {
        skin(model_, pose_bones(motion.at(t_s), motion.hand(), hand_scale_), skinned_mm_[moment],
             normals_);
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
        Corner& corner = corners_[v];
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
        corner.camera = camera_.project(p);
        corner.inverse_z = 1.0F / p.z();
        corner.lamp = lamp_.project(p, corner.lamp_depth_mm);
    }
}

void Renderer::draw_camera(std::size_t hand, const std::array<std::uint32_t, 3>& t) {
    const Corner& a = corners_[t[0]];
    const Corner& b = corners_[t[1]];
    const Corner& c = corners_[t[2]];
    const PixelRect box = around(a.camera, b.camera, c.camera, camera_.frame());
    if (box.empty()) {
        return;
    }
    drawn_ = unite(drawn_, box);
    const auto skin_albedo = static_cast<float>(settings_.user.skin_albedo);
    const auto cloth_albedo = static_cast<float>(settings_.user.clothing_albedo);
    raster_triangle(
        a.camera, b.camera, c.camera, box, [&](int x, int y, float w0, float w1, float w2) {
            const float z = 1.0F / (w0 * a.inverse_z + w1 * b.inverse_z + w2 * c.inverse_z);
            Surfel& s = surfels_.at(x, y);
            if (z >= s.depth_mm) {
                return;
            }
            s.depth_mm = z;
            const Vec3f n = normals_[t[0]] * w0 + normals_[t[1]] * w1 + normals_[t[2]] * w2;
            s.normal = {n.x(), n.y(), n.z()};
            const auto& v = model_.vertices;
            s.part = v[t[0]].part;
            s.hand = static_cast<std::uint8_t>(hand);
            s.albedo = (v[t[0]].albedo * w0 + v[t[1]].albedo * w1 + v[t[2]].albedo * w2) *
                       (s.part == SimPart::body ? cloth_albedo : skin_albedo);
        });
}

void Renderer::draw_shadow(const std::array<std::uint32_t, 3>& t) {
    const Corner& a = corners_[t[0]];
    const Corner& b = corners_[t[1]];
    const Corner& c = corners_[t[2]];
    const PixelRect box =
        around(a.lamp, b.lamp, c.lamp, {0, 0, shadow_mm_.width(), shadow_mm_.height()});
    if (box.empty()) {
        return;
    }
    shadowed_ = unite(shadowed_, box);
    raster_triangle(a.lamp, b.lamp, c.lamp, box, [&](int x, int y, float w0, float w1, float w2) {
        const float z = w0 * a.lamp_depth_mm + w1 * b.lamp_depth_mm + w2 * c.lamp_depth_mm;
        float& nearest = shadow_mm_.at(x, y);
        nearest = std::min(nearest, z);
    });
}

void Renderer::draw_hand(std::size_t hand) {
    const bool mirrored = hands_[hand].hand() == SimHand::left;
    for (const auto& triangle : model_.triangles) {
        std::array<std::uint32_t, 3> t = triangle;
        if (mirrored) {
            std::swap(t[1], t[2]);
        }
        if (corners_[t[0]].inverse_z < 0.0F || corners_[t[1]].inverse_z < 0.0F ||
            corners_[t[2]].inverse_z < 0.0F) {
            continue;
        }
        draw_camera(hand, t);
        draw_shadow(t);
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
    const Vec3f p = Vec3f(scene_.ray_x.at(x, y), scene_.ray_y.at(x, y), 1.0F) * s.depth_mm;
    const Vec3f normal = Vec3f(s.normal[0], s.normal[1], s.normal[2]).normalized();
    Lit lit = lamp_.at(p, normal, s.albedo);
    if (lit.cell != kUnlit) {
        // A slanted surface covers more depth within one cell of the map.
        const Vec3f view = -p.normalized();
        const float slant = 1.0F / std::max(0.15F, normal.dot(view));
        const int shadow_x = static_cast<int>(lit.cell) % shadow_mm_.width();
        const int shadow_y = static_cast<int>(lit.cell) / shadow_mm_.width();
        const float limit = lit.depth_mm - kShadowSlackMm - slant;
        if (shadow_mm_.at(shadow_x, shadow_y) < limit ||
            scene_.shadow_mm.at(shadow_x, shadow_y) < limit) {
            lit.light = 0.0F;
        }
    }
    const auto cell = static_cast<std::ptrdiff_t>(lit.coordinate_px);
    const float t = lit.coordinate_px - static_cast<float>(cell);
    const float ambient =
        static_cast<float>(settings_.room.ambient_grey) * s.albedo * ambient_share(normal);
    const Tint& tint = tints_[static_cast<std::size_t>(s.part)];
    for (std::size_t c = 0; c < channels_; ++c) {
        const float* curve = curves.of_channel[c] + cell;
        pixel[c] +=
            share * tint[c] * (ambient + lit.light * (curve[0] + t * (curve[1] - curve[0])));
    }
}

void Renderer::light_row(int y, const Curves& curves, float share, float* row) const {
    const int width = camera_.size().width;
    const float* light = scene_.light.row(y);
    const float* coordinate = scene_.coordinate_px.row(y);
    const float* ambient = scene_.ambient.row(y);
    const float* depth = scene_.projector_depth_mm.row(y);
    const std::uint32_t* cells = scene_.cell.row(y);
    const std::uint8_t* parts = scene_.part.row(y);
    const Surfel* surfels = surfels_.row(y);
    const float* shadow = shadow_mm_.row(0);
    const auto shadow_width = static_cast<std::uint32_t>(shadow_mm_.width());
    const auto shadow_stride = static_cast<std::uint32_t>(shadow_mm_.stride());
    const bool hand_row = y >= drawn_.y0 && y < drawn_.y1;
    const auto cell_low = static_cast<std::uint32_t>(shadowed_.y0) * shadow_width;
    const auto cell_high = static_cast<std::uint32_t>(shadowed_.y1) * shadow_width;
    for (int x = 0; x < width; ++x) {
        float* pixel = row + static_cast<std::size_t>(x) * channels_;
        if (hand_row && x >= drawn_.x0 && x < drawn_.x1 &&
            surfels[x].depth_mm < scene_.depth_mm.row(y)[x]) {
            light_surfel(x, y, surfels[x], curves, share, pixel);
            continue;
        }
        float lit = light[x];
        const std::uint32_t cell = cells[x];
        if (cell >= cell_low && cell < cell_high) {
            const std::uint32_t at = cell / shadow_width * shadow_stride + cell % shadow_width;
            lit = shadow[at] < depth[x] - kShadowSlackMm ? 0.0F : lit;
        }
        const auto i = static_cast<std::ptrdiff_t>(coordinate[x]);
        const float t = coordinate[x] - static_cast<float>(i);
        const Tint& tint = tints_[parts[x]];
        for (std::size_t c = 0; c < channels_; ++c) {
            const float* curve = curves.of_channel[c] + i;
            pixel[c] +=
                share * tint[c] * (ambient[x] + lit * (curve[0] + t * (curve[1] - curve[0])));
        }
    }
}

void Renderer::expose(std::uint64_t frame, ImageView<float> light) {
    const double stamp_s = static_cast<double>(timing_.stamp(frame).ns) * 1e-9;
    const int samples = motion_samples(stamp_s);
    const double slice_s = timing_.exposure_s() / samples;
    const float share = 1.0F / static_cast<float>(samples);
    for (int sample = 0; sample < samples; ++sample) {
        const double middle_s = stamp_s - 0.5 * timing_.exposure_s() + (sample + 0.5) * slice_s;
        draw_all(middle_s);
        for (int y = 0; y < light.height; ++y) {
            float* row = light.row(y);
            if (sample == 0) {
                std::fill(row, row + light.width, 0.0F);
            }
            const double open_s = middle_s + timing_.row_offset_s(y);
            const PatternMix mix = timing_.shown(open_s - 0.5 * slice_s, open_s + 0.5 * slice_s);
            light_row(y, curves_for(mix), share, row);
        }
    }
}

}  // namespace xtrack::sim
