// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/peers.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <utility>

namespace xtrack::tools::bench {

namespace {

class ScalarLoop {
 public:
    ScalarLoop(const Scene& scene, std::shared_ptr<FrameRing> ring,
               std::shared_ptr<std::vector<float>> xyz_mm)
        : size_(scene.size()),
          period_px_(static_cast<float>(scene.three_step().patterns.front().period_px)),
          ring_(std::move(ring)),
          xyz_mm_(std::move(xyz_mm)) {
        const Rig& rig = scene.rig();
        const Pinhole& camera = rig.camera;
        fx_ = static_cast<float>(camera.matrix(0, 0));
        fy_ = static_cast<float>(camera.matrix(1, 1));
        cx_ = static_cast<float>(camera.matrix(0, 2));
        cy_ = static_cast<float>(camera.matrix(1, 2));
        const Mat3d from_camera = rig.projector->matrix * rig.projector_from_camera_R;
        const Vec3d from_origin = rig.projector->matrix * rig.projector_from_camera_T;
        p1_ = from_camera.row(0).transpose().cast<float>();
        p3_ = from_camera.row(2).transpose().cast<float>();
        b_ = static_cast<float>(from_origin.x());
        d_ = static_cast<float>(from_origin.z());
        near_mm_ = static_cast<float>(rig.working_volume->near_mm);
        far_mm_ = static_cast<float>(rig.working_volume->far_mm);
        for (int u = 0; u < size_.width; ++u) {
            middle_px_.push_back(static_cast<float>(scene.volume_middle_px(u)));
        }
        xyz_mm_->resize(3U * static_cast<std::size_t>(size_.width) *
                        static_cast<std::size_t>(size_.height));
    }

    void run() noexcept {
        const auto set = ring_->next();
        float* out = xyz_mm_->data();
        for (int v = 0; v < size_.height; ++v) {
            const std::uint8_t* first = set[0]->pixels.row(v);
            const std::uint8_t* second = set[1]->pixels.row(v);
            const std::uint8_t* third = set[2]->pixels.row(v);
            for (int u = 0; u < size_.width; ++u, out += 3) {
                pixel(u, v, first[u], second[u], third[u], out);
            }
        }
    }

 private:
    void pixel(int u, int v, float i1, float i2, float i3, float* out) const noexcept {
        constexpr float kSqrt3 = std::numbers::sqrt3_v<float>;
        constexpr float kLeastModulation_grey = 6.0F;
        const float sine = kSqrt3 * (i2 - i3);
        const float cosine = 2.0F * i1 - i2 - i3;
        const float modulation_grey = std::sqrt(sine * sine + cosine * cosine) / 3.0F;
        float z = std::numeric_limits<float>::quiet_NaN();
        const float ray_x = (static_cast<float>(u) - cx_) / fx_;
        const float ray_y = (static_cast<float>(v) - cy_) / fy_;
        if (modulation_grey >= kLeastModulation_grey) {
            const float turns = std::atan2(sine, cosine) / (2.0F * std::numbers::pi_v<float>);
            const float middle = middle_px_[static_cast<std::size_t>(u)];
            const float order = std::round(middle / period_px_ - turns);
            const float x = (turns + order) * period_px_;
            const float a = p1_.x() * ray_x + p1_.y() * ray_y + p1_.z();
            const float c = p3_.x() * ray_x + p3_.y() * ray_y + p3_.z();
            const float depth = (d_ * x - b_) / (a - c * x);
            if (depth >= near_mm_ && depth <= far_mm_) {
                z = depth;
            }
        }
        out[0] = ray_x * z;
        out[1] = ray_y * z;
        out[2] = z;
    }

    Size size_;
    float period_px_;
    std::shared_ptr<FrameRing> ring_;
    std::shared_ptr<std::vector<float>> xyz_mm_;
    std::vector<float> middle_px_;
    float fx_ = 0.0F;
    float fy_ = 0.0F;
    float cx_ = 0.0F;
    float cy_ = 0.0F;
    Vec3f p1_ = Vec3f::Zero();
    Vec3f p3_ = Vec3f::Zero();
    float b_ = 0.0F;
    float d_ = 0.0F;
    float near_mm_ = 0.0F;
    float far_mm_ = 0.0F;
};

}  // namespace

Contender scalar_peer(const Scene& scene, std::shared_ptr<FrameRing> ring,
                      std::shared_ptr<std::vector<float>> xyz_mm) {
    const auto loop = std::make_shared<ScalarLoop>(scene, std::move(ring), std::move(xyz_mm));
    return {"scalar_atan2f", {}, {}, [loop] { loop->run(); }};
}

Contender memcpy_peer(Size size, std::shared_ptr<FrameRing> ring) {
    // The decoder, too, writes to the same memory each time.
    const auto out = std::make_shared<Image<std::uint8_t>>(size.width, 3 * size.height);
    return {"memcpy", {}, {}, [out, size, ring = std::move(ring)] {
                int row = 0;
                for (const FramePtr& frame : ring->next()) {
                    std::memcpy(out->row(row), frame->pixels.row(0),
                                static_cast<std::size_t>(frame->pixels.stride()) *
                                    static_cast<std::size_t>(size.height));
                    row += size.height;
                }
            }};
}

#if !XTRACK_WITH_OPENCV_CONTRIB
// NOLINTNEXTLINE(performance-unnecessary-value-param): where it is built, the peer keeps the ring
std::optional<Contender> opencv_peer(const Scene& /*scene*/, std::shared_ptr<FrameRing> /*ring*/) {
    return std::nullopt;
}
#endif

}  // namespace xtrack::tools::bench
