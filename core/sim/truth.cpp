// SPDX-License-Identifier: Apache-2.0
#include "core/sim/truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <xtrack/depth.hpp>

namespace xtrack::sim {
namespace {

/// Squared distance transform of one line (Felzenszwalb, Huttenlocher 2012): the lower envelope of
/// parabolas.
void transform_line(float* values, int count, int stride, std::vector<float>& line,
                    std::vector<int>& apex, std::vector<float>& bound) {
    constexpr float kInfinite = std::numeric_limits<float>::max();
    for (int i = 0; i < count; ++i) {
        line[static_cast<std::size_t>(i)] = values[static_cast<std::ptrdiff_t>(i) * stride];
    }
    const auto value = [&](int i) { return line[static_cast<std::size_t>(i)]; };
    int last = 0;
    apex[0] = 0;
    bound[0] = -kInfinite;
    bound[1] = kInfinite;
    for (int q = 1; q < count; ++q) {
        float s = 0.0F;
        for (;; --last) {
            const int p = apex[static_cast<std::size_t>(last)];
            s = (value(q) + static_cast<float>(q * q) - value(p) - static_cast<float>(p * p)) /
                static_cast<float>(2 * (q - p));
            if (s > bound[static_cast<std::size_t>(last)] || last == 0) {
                break;
            }
        }
        if (s > bound[static_cast<std::size_t>(last)]) {
            ++last;
        }
        apex[static_cast<std::size_t>(last)] = q;
        bound[static_cast<std::size_t>(last)] = s;
        bound[static_cast<std::size_t>(last) + 1] = kInfinite;
    }
    int k = 0;
    for (int q = 0; q < count; ++q) {
        while (bound[static_cast<std::size_t>(k) + 1] < static_cast<float>(q)) {
            ++k;
        }
        const int p = apex[static_cast<std::size_t>(k)];
        values[static_cast<std::ptrdiff_t>(q) * stride] =
            static_cast<float>((q - p) * (q - p)) + value(p);
    }
}

bool is_hand(const Renderer& renderer, int x, int y, std::size_t hand) {
    const Surfel& s = renderer.surfels().at(x, y);
    return s.depth_mm < renderer.scene().depth_mm.at(x, y) && renderer.hand_of(s) == hand &&
           renderer.part_of(s) == SimPart::hand;
}

}  // namespace

TruthMaker::TruthMaker(const Renderer& renderer) {
    const Size size = renderer.camera().size();
    const auto longest = static_cast<std::size_t>(std::max(size.width, size.height)) + 2;
    distance2_.resize(longest * longest);
    line_.resize(longest);
    apex_.resize(longest);
    bound_.resize(longest + 1);
}

void TruthMaker::find_palm(const Renderer& renderer, std::size_t hand, const SimTruth& truth,
                           SimHandTruth& out) {
    const PixelRect& box = renderer.drawn();
    if (box.empty()) {
        return;
    }
    // One pixel of border all round: the image's edge cuts a hand as its outline does.
    const int width = box.x1 - box.x0 + 2;
    const int height = box.y1 - box.y0 + 2;
    constexpr float kInside = 1.0e9F;
    std::fill(distance2_.begin(), distance2_.begin() + static_cast<std::ptrdiff_t>(width) * height,
              0.0F);
    for (int y = box.y0; y < box.y1; ++y) {
        for (int x = box.x0; x < box.x1; ++x) {
            if (is_hand(renderer, x, y, hand)) {
                distance2_[static_cast<std::size_t>((y - box.y0 + 1) * width + x - box.x0 + 1)] =
                    kInside;
                out.in_view = true;
            }
        }
    }
    if (!out.in_view) {
        return;
    }
    for (int x = 0; x < width; ++x) {
        transform_line(distance2_.data() + x, height, width, line_, apex_, bound_);
    }
    for (int y = 0; y < height; ++y) {
        transform_line(distance2_.data() + static_cast<std::ptrdiff_t>(y) * width, width, 1, line_,
                       apex_, bound_);
    }
    const auto end = distance2_.begin() + static_cast<std::ptrdiff_t>(width) * height;
    const auto best = std::max_element(distance2_.begin(), end);
    const auto at = static_cast<int>(best - distance2_.begin());
    const int x = at % width - 1 + box.x0;
    const int y = at / width - 1 + box.y0;
    const float z = static_cast<float>(truth.depth.at(x, y) * kDepthUnitMm);
    out.palm_mm = Vec3f(renderer.scene().ray_x.at(x, y), renderer.scene().ray_y.at(x, y), 1.0F) * z;
    const Vec3f edge = out.palm_mm + Vec3f(1.0F, 0.0F, 0.0F);
    const float px_per_mm =
        renderer.camera().project(edge).x - renderer.camera().project(out.palm_mm).x;
    out.palm_radius_mm = std::sqrt(*best) / px_per_mm;
    out.palm_visible = true;
}

void TruthMaker::make(const Renderer& renderer, std::uint64_t frame, SimTruth& truth) {
    const Size size = renderer.camera().size();
    truth.stamp = renderer.timing().stamp(frame);
    truth.sequence = frame;
    truth.depth.resize(size.width, size.height);
    truth.mask.resize(size.width, size.height);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const Surfel& s = renderer.surfels().at(x, y);
            const float background = renderer.scene().depth_mm.at(x, y);
            const bool moving = s.depth_mm < background;
            const double z = moving ? s.depth_mm : background;
            const double steps = std::min(z / kDepthUnitMm + 0.5, 65535.0);
            truth.depth.at(x, y) = static_cast<std::uint16_t>(steps);
            truth.mask.at(x, y) = moving ? static_cast<std::uint8_t>(renderer.part_of(s))
                                         : renderer.scene().part.at(x, y);
        }
    }
    truth.hand_count = renderer.hands().size();
    const double stamp_s = static_cast<double>(truth.stamp.ns) * 1e-9;
    for (std::size_t h = 0; h < truth.hand_count; ++h) {
        const HandMotion& motion = renderer.hands()[h];
        const PosedBones bones =
            pose_bones(motion.at(stamp_s), motion.hand(), renderer.hand_scale());
        SimHandTruth& out = truth.hands[h];
        out = SimHandTruth{};
        out.hand = motion.hand();
        out.joints_mm = bones.joints_mm;
        out.aperture_mm = aperture_mm(renderer.model(), bones);
        find_palm(renderer, h, truth, out);
        for (std::size_t f = 0; f < kSimFingerCount; ++f) {
            const Vec3f tip =
                skin_point(renderer.model().vertices[renderer.model().tip_vertex[f]], bones);
            out.tips_mm[f] = tip;
            // A tip lies on the outline: look for its surface in the pixels around it.
            constexpr int kReachPx = 2;
            constexpr float kSameSurfaceMm = 8.0F;
            const ScreenPoint s = renderer.camera().project(tip);
            const int cx = static_cast<int>(std::lround(s.x));
            const int cy = static_cast<int>(std::lround(s.y));
            for (int y = cy - kReachPx; y <= cy + kReachPx; ++y) {
                for (int x = cx - kReachPx; x <= cx + kReachPx; ++x) {
                    if (x < 0 || y < 0 || x >= size.width || y >= size.height) {
                        continue;
                    }
                    const Surfel& near = renderer.surfels().at(x, y);
                    out.tip_visible[f] =
                        out.tip_visible[f] || (is_hand(renderer, x, y, h) &&
                                               std::abs(near.depth_mm - tip.z()) < kSameSurfaceMm);
                }
            }
        }
    }
}

}  // namespace xtrack::sim
