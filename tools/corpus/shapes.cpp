// SPDX-License-Identifier: Apache-2.0
#include "tools/corpus/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace xtrack::tools::corpus {

namespace {

using sim::FingerAngles;
using sim::kAnglesPerFinger;

constexpr std::array<float, kAnglesPerFinger> kFoldedFinger{1.45F, 0.0F, 1.7F, 0.9F};
constexpr std::array<float, kAnglesPerFinger> kThumbOverFist{0.9F, -0.1F, 0.6F, 0.8F};
constexpr std::array<float, kAnglesPerFinger> kThumbOut{-0.15F, 0.35F, -0.05F, -0.05F};
constexpr std::array<float, kAnglesPerFinger> kStraightFinger{0.05F, 0.0F, 0.05F, 0.03F};

void set(FingerAngles& fingers, std::size_t finger,
         const std::array<float, kAnglesPerFinger>& angles) {
    std::copy(angles.begin(), angles.end(),
              fingers.begin() + static_cast<std::ptrdiff_t>(finger * kAnglesPerFinger));
}

FingerAngles mixed(const FingerAngles& a, const FingerAngles& b, float share) {
    FingerAngles m{};
    for (std::size_t i = 0; i < m.size(); ++i) {
        m[i] = a[i] + share * (b[i] - a[i]);
    }
    return m;
}

}  // namespace

FingerAngles flat() {
    FingerAngles f = sim::relaxed_open();
    constexpr std::array<float, kFingerCount> kSpread{0.0F, 0.10F, 0.0F, -0.08F, -0.17F};
    for (std::size_t finger = 1; finger < kFingerCount; ++finger) {
        set(f, finger, kStraightFinger);
        f[finger * kAnglesPerFinger + 1] = kSpread[finger];
    }
    set(f, 0, {0.0F, 0.30F, 0.0F, 0.0F});
    return f;
}

FingerAngles fist() {
    FingerAngles f{};
    set(f, 0, kThumbOverFist);
    for (std::size_t finger = 1; finger < kFingerCount; ++finger) {
        set(f, finger, kFoldedFinger);
    }
    return f;
}

FingerAngles pointing() {
    FingerAngles f = fist();
    set(f, 1, kStraightFinger);
    return f;
}

FingerAngles victory() {
    FingerAngles f = pointing();
    set(f, 2, kStraightFinger);
    f[1 * kAnglesPerFinger + 1] = 0.20F;
    f[2 * kAnglesPerFinger + 1] = -0.12F;
    return f;
}

FingerAngles thumb_out() {
    FingerAngles f = fist();
    set(f, 0, kThumbOut);
    return f;
}

FingerAngles pinched() {
    static const FingerAngles closed = sim::solve_pinch_closed(sim::hand_model());
    return closed;
}

// The thumb stays away from the index finger: were it to come near, that would be a pinch.
FingerAngles gripping() {
    FingerAngles f = mixed(sim::relaxed_open(), fist(), 0.5F);
    set(f, 0, {0.45F, 0.35F, 0.05F, 0.05F});
    return f;
}

FingerAngles loose(float curl) {
    FingerAngles f = mixed(sim::relaxed_open(), fist(), 0.45F * curl);
    set(f, 0, {0.05F + 0.15F * curl, 0.15F * curl, 0.05F, 0.10F});
    return f;
}

FingerAngles with_index_bent(FingerAngles fingers, float rad) {
    float* a = &fingers[1 * kAnglesPerFinger];
    a[0] += rad;
    a[2] += 0.35F * rad;
    a[3] += 0.15F * rad;
    return fingers;
}

float likeness(const FingerAngles& fingers, const FingerAngles& shape, const FingerAngles& from) {
    float least = 1.0F;
    for (std::size_t f = 0; f < kFingerCount; ++f) {
        float whole = 0.0F;
        float left = 0.0F;
        for (std::size_t i = f * kAnglesPerFinger; i < (f + 1) * kAnglesPerFinger; ++i) {
            whole += (shape[i] - from[i]) * (shape[i] - from[i]);
            left += (shape[i] - fingers[i]) * (shape[i] - fingers[i]);
        }
        constexpr float kSame = 0.05F;  // rad^2: a finger that has no way to go is there
        if (whole > kSame) {
            least = std::min(least, 1.0F - std::sqrt(left / whole));
        }
    }
    return least;
}

}  // namespace xtrack::tools::corpus
