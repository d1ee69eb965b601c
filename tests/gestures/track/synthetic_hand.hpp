// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <xtrack/depth.hpp>
#include <xtrack/hand.hpp>
#include <xtrack/rig.hpp>

namespace xtrack::test {

/// Depth images of things made of balls: what is nearest to the camera counts, as for a real one.
class Scene {
 public:
    explicit Scene(Size size = {640, 480}, double focal_px = 600.0) {
        rig.camera.size = size;
        rig.camera.matrix(0, 0) = focal_px;
        rig.camera.matrix(1, 1) = focal_px;
        rig.camera.matrix(0, 2) = 0.5 * (size.width - 1);
        rig.camera.matrix(1, 2) = 0.5 * (size.height - 1);
        depth.depth.resize(size.width, size.height);
        clear();
    }

    void clear() { depth.depth.fill(0); }

    void ball(const Vec3f& c, float r) {
        const auto f = static_cast<float>(rig.camera.matrix(0, 0));
        const auto cx = static_cast<float>(rig.camera.matrix(0, 2));
        const auto cy = static_cast<float>(rig.camera.matrix(1, 2));
        const float reach = 1.2F * f * r / (c.z() - r);
        const float u = f * c.x() / c.z() + cx;
        const float v = f * c.y() / c.z() + cy;
        const int x0 = std::max(0, static_cast<int>(u - reach));
        const int x1 = std::min(depth.depth.width() - 1, static_cast<int>(u + reach) + 1);
        const int y0 = std::max(0, static_cast<int>(v - reach));
        const int y1 = std::min(depth.depth.height() - 1, static_cast<int>(v + reach) + 1);
        for (int y = y0; y <= y1; ++y) {
            for (int x = x0; x <= x1; ++x) {
                const Vec3f ray((static_cast<float>(x) - cx) / f, (static_cast<float>(y) - cy) / f,
                                1.0F);
                const float a = ray.squaredNorm();
                const float b = ray.dot(c);
                const float q = b * b - a * (c.squaredNorm() - r * r);
                if (q >= 0.0F) {
                    put(x, y, (b - std::sqrt(q)) / a);
                }
            }
        }
    }

    void capsule(const Vec3f& a, const Vec3f& b, float ra, float rb) {
        const int n = std::max(1, static_cast<int>((b - a).norm() / 2.0F));
        for (int k = 0; k <= n; ++k) {
            const float t = static_cast<float>(k) / static_cast<float>(n);
            ball(a + t * (b - a), ra + t * (rb - ra));
        }
    }

    void wall(float z_mm) {
        for (int y = 0; y < depth.depth.height(); ++y) {
            for (int x = 0; x < depth.depth.width(); ++x) {
                put(x, y, z_mm);
            }
        }
    }

    /// Chest, shoulders, neck and head of a user, the chest's front at about z_mm.
    void person(float x_mm, float z_mm) {
        capsule({x_mm - 60.0F, 60.0F, z_mm + 110.0F}, {x_mm - 60.0F, 400.0F, z_mm + 110.0F}, 110.0F,
                110.0F);
        capsule({x_mm + 60.0F, 60.0F, z_mm + 110.0F}, {x_mm + 60.0F, 400.0F, z_mm + 110.0F}, 110.0F,
                110.0F);
        capsule({x_mm, 0.0F, z_mm + 100.0F}, {x_mm, -100.0F, z_mm + 90.0F}, 55.0F, 55.0F);
        ball({x_mm, -190.0F, z_mm + 80.0F}, 90.0F);
    }

    void noise(double sigma_mm, double missing, unsigned seed) {
        std::mt19937 random(seed);
        std::normal_distribution<double> gauss(0.0, sigma_mm / depth.depth_unit_mm);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        for (int y = 0; y < depth.depth.height(); ++y) {
            for (int x = 0; x < depth.depth.width(); ++x) {
                std::uint16_t& d = depth.depth.at(x, y);
                if (d != 0) {
                    const double noisy = std::max(1.0, d + gauss(random));
                    d = uniform(random) < missing ? std::uint16_t{0}
                                                  : static_cast<std::uint16_t>(noisy);
                }
            }
        }
    }

    Rig rig;
    DepthFrame depth;

 private:
    void put(int x, int y, float z_mm) {
        const double steps = z_mm / depth.depth_unit_mm + 0.5;
        std::uint16_t& d = depth.depth.at(x, y);
        if (steps < 65535.0 && (d == 0 || steps < d)) {
            d = static_cast<std::uint16_t>(steps);
        }
    }
};

/// A hand of an adult that shows its palm, fingers up, forearm down and away from the camera.
struct SyntheticHand {
    Vec3f palm_mm{0.0F, 0.0F, 600.0F};  ///< skin at the palm's centre
    bool thumb_to_the_right = true;     ///< in the image: a right hand's palm
    std::array<bool, kFingerCount> extended{true, true, true, true, true};
    bool pinching = false;                 ///< thumb and index touch and close a ring
    Vec3f elbow_mm{0.0F, 260.0F, 130.0F};  ///< from the palm's centre

    static constexpr float kPalmRadiusMm = 42.0F;
    static constexpr float kFingerRadiusMm = 8.5F;

    /// Distal extreme of a finger, on the silhouette.
    [[nodiscard]] Vec3f tip(Finger f) const { return local(kTips[index(f)], kFingerRadiusMm); }

    void draw(Scene& scene) const {
        constexpr float kEdge = 15.0F;
        const Vec3f centre = palm_mm + Vec3f(0.0F, 0.0F, kEdge);
        for (float y = -27.0F; y <= 27.0F; y += 4.5F) {
            for (float x = -27.0F; x <= 27.0F; x += 4.5F) {
                if (x * x + y * y <= 27.1F * 27.1F) {
                    scene.ball(centre + Vec3f(x, y, 0.0F), kEdge);
                }
            }
        }
        for (std::size_t f = 0; f < kFingerCount; ++f) {
            if (pinching && f <= index(Finger::index)) {
                continue;
            }
            if (extended[f]) {
                scene.capsule(side(kRoots[f]) + centre, side(kTips[f]) + centre, kFingerRadiusMm,
                              kFingerRadiusMm);
            }
        }
        if (pinching) {
            const Vec3f meet = side({52.0F, -62.0F, -20.0F}) + centre;
            const Vec3f knuckle = side({40.0F, -88.0F, -10.0F}) + centre;
            const Vec3f joint = side({66.0F, -25.0F, -10.0F}) + centre;
            scene.capsule(side(kRoots[1]) + centre, knuckle, kFingerRadiusMm, kFingerRadiusMm);
            scene.capsule(knuckle, meet, kFingerRadiusMm, kFingerRadiusMm);
            scene.capsule(side(kRoots[0]) + centre, joint, kFingerRadiusMm, kFingerRadiusMm);
            scene.capsule(joint, meet, kFingerRadiusMm, kFingerRadiusMm);
        }
        scene.capsule(centre + Vec3f(0.0F, 40.0F, 10.0F), centre + elbow_mm, 26.0F, 34.0F);
    }

 private:
    static constexpr std::size_t index(Finger f) { return static_cast<std::size_t>(f); }
    [[nodiscard]] Vec3f side(Vec3f p) const {
        if (!thumb_to_the_right) {
            p.x() = -p.x();
        }
        return p;
    }
    [[nodiscard]] Vec3f local(const Vec3f& p, float beyond) const {
        const Vec3f d = side(p);
        return palm_mm + d + beyond * Vec3f(d.x(), d.y(), 0.0F).normalized() +
               Vec3f(0.0F, 0.0F, 15.0F);
    }

    // Centres of the balls at roots and tips, from the palm's centre, a relaxed open hand.
    inline static const std::array<Vec3f, kFingerCount> kRoots{
        Vec3f{25.0F, 10.0F, 0.0F}, Vec3f{26.0F, -30.0F, 0.0F}, Vec3f{9.0F, -34.0F, 0.0F},
        Vec3f{-9.0F, -33.0F, 0.0F}, Vec3f{-25.0F, -28.0F, 0.0F}};
    inline static const std::array<Vec3f, kFingerCount> kTips{
        Vec3f{76.0F, -20.0F, -8.0F}, Vec3f{46.0F, -98.0F, -12.0F}, Vec3f{12.0F, -110.0F, -12.0F},
        Vec3f{-20.0F, -103.0F, -12.0F}, Vec3f{-50.0F, -80.0F, -10.0F}};
};

}  // namespace xtrack::test
