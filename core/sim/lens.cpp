// SPDX-License-Identifier: Apache-2.0
#include "core/sim/lens.hpp"

#include <algorithm>
#include <cstddef>

namespace xtrack::sim {

Lens::Lens(const Pinhole& pinhole)
    : fx_(static_cast<float>(pinhole.matrix(0, 0))),
      fy_(static_cast<float>(pinhole.matrix(1, 1))),
      cx_(static_cast<float>(pinhole.matrix(0, 2))),
      cy_(static_cast<float>(pinhole.matrix(1, 2))),
      skew_(static_cast<float>(pinhole.matrix(0, 1))),
      distorted_(pinhole.distorted()),
      size_(pinhole.size) {
    for (std::size_t i = 0; i < k_.size(); ++i) {
        k_[i] = static_cast<float>(pinhole.distortion[i]);
    }
}

void Lens::distort(float& x, float& y) const {
    // The polynomial may turn back far outside the image; hold the radius where a lens ends.
    constexpr float kLargestRadius2 = 1.5F;
    const float r2 = std::min(x * x + y * y, kLargestRadius2);
    const float radial = (1.0F + r2 * (k_[0] + r2 * (k_[1] + r2 * k_[4]))) /
                         (1.0F + r2 * (k_[5] + r2 * (k_[6] + r2 * k_[7])));
    const float dx = 2.0F * k_[2] * x * y + k_[3] * (r2 + 2.0F * x * x);
    const float dy = k_[2] * (r2 + 2.0F * y * y) + 2.0F * k_[3] * x * y;
    x = x * radial + dx;
    y = y * radial + dy;
}

Vec2f Lens::ray(float u_px, float v_px) const {
    const float y0 = (v_px - cy_) / fy_;
    const float x0 = (u_px - cx_ - skew_ * y0) / fx_;
    float x = x0;
    float y = y0;
    if (distorted_) {
        constexpr int kFixedPointSteps = 20;
        for (int i = 0; i < kFixedPointSteps; ++i) {
            float dx = x;
            float dy = y;
            distort(dx, dy);
            x += x0 - dx;
            y += y0 - dy;
        }
    }
    return {x, y};
}

}  // namespace xtrack::sim
