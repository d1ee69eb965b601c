// SPDX-License-Identifier: Apache-2.0
#include "core/sim/sensor.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/sim/random.hpp"

namespace xtrack::sim {
namespace {

constexpr unsigned kQuantileBits = 12;
constexpr std::size_t kQuantiles = std::size_t{1} << kQuantileBits;
constexpr float kWhite = 255.0F;

/// Inverse of the normal distribution, by bisection: set-up only.
double normal_quantile(double p) {
    double low = -8.0;
    double high = 8.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (0.5 * std::erfc(-middle / std::sqrt(2.0)) < p ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

std::uint8_t to_byte(float v) {
    return static_cast<std::uint8_t>(std::clamp(v, 0.0F, kWhite) + 0.5F);
}

}  // namespace

Sensor::Sensor(const SimCamera& camera, std::uint64_t seed, Size size)
    : channels_(camera.colour ? 3 : 1),
      chroma_422_(camera.colour && camera.chroma_422),
      // Three taps with the variance of the Gaussian.
      side_weight_(static_cast<float>(0.5 * camera.blur_px * camera.blur_px)),
      shot_(static_cast<float>(kWhite / camera.full_well_e)),
      seed_(mix(seed, 303U)) {
    const double read_grey = camera.read_noise_e * kWhite / camera.full_well_e;
    read_ = static_cast<float>(read_grey * read_grey);
    light_.resize(size.width * static_cast<int>(channels_), size.height);
    lines_.resize(static_cast<std::size_t>(light_.width()) * 3);
    normal_.resize(kQuantiles);
    double square = 0.0;
    for (std::size_t i = 0; i < kQuantiles; ++i) {
        const double q =
            normal_quantile((static_cast<double>(i) + 0.5) / static_cast<double>(kQuantiles));
        normal_[i] = static_cast<float>(q);
        square += q * q;
    }
    // Cut tails take a little of the variance: give it back.
    const auto unit = static_cast<float>(std::sqrt(static_cast<double>(kQuantiles) / square));
    for (float& q : normal_) {
        q *= unit;
    }
}

void Sensor::blur() {
    if (side_weight_ <= 0.0F) {
        return;
    }
    const auto width = static_cast<std::size_t>(light_.width());
    const float side = side_weight_;
    const float middle = 1.0F - 2.0F * side;
    const auto along_x = [&](int y, float* out) {
        const float* in = light_.row(y);
        for (std::size_t i = 0; i < channels_; ++i) {
            out[i] = middle * in[i] + side * (in[i] + in[i + channels_]);
            const std::size_t last = width - 1 - i;
            out[last] = middle * in[last] + side * (in[last] + in[last - channels_]);
        }
        for (std::size_t x = channels_; x + channels_ < width; ++x) {
            out[x] = middle * in[x] + side * (in[x - channels_] + in[x + channels_]);
        }
    };
    std::array<float*, 3> line{lines_.data(), lines_.data() + width, lines_.data() + 2 * width};
    along_x(0, line[0]);
    std::copy(line[0], line[0] + width, line[1]);
    for (int y = 0; y < light_.height(); ++y) {
        const bool last = y + 1 == light_.height();
        if (!last) {
            along_x(y + 1, line[2]);
        }
        const float* above = line[0];
        const float* here = line[1];
        const float* below = last ? line[1] : line[2];
        float* out = light_.row(y);
        for (std::size_t x = 0; x < width; ++x) {
            out[x] = middle * here[x] + side * (above[x] + below[x]);
        }
        std::rotate(line.begin(), line.begin() + 1, line.end());
    }
}

void Sensor::add_noise(std::uint64_t frame) {
    constexpr int kPerWord = 5;  // 12 of 64 bits each
    constexpr std::uint64_t kMask = kQuantiles - 1;
    for (int y = 0; y < light_.height(); ++y) {
        float* row = light_.row(y);
        const std::uint64_t key = mix(mix(seed_, frame), static_cast<std::uint64_t>(y));
        std::uint64_t word = 0;
        std::uint64_t counter = 0;
        for (int x = 0; x < light_.width(); x += kPerWord) {
            word = mix(key + counter++);
            const int end = std::min(x + kPerWord, light_.width());
            for (int i = x; i < end; ++i) {
                const float grey = std::max(row[i], 0.0F);
                row[i] += std::sqrt(grey * shot_ + read_) * normal_[word & kMask];
                word >>= kQuantileBits;
            }
        }
    }
}

void Sensor::pack_422(ImageView<std::uint8_t> pixels) const {
    // BT.601, video range, as UVC cameras send it.
    for (int y = 0; y < pixels.height; ++y) {
        const float* in = light_.row(y);
        std::uint8_t* out = pixels.row(y);
        const int columns = pixels.width / 3;
        for (int x = 0; x < columns; x += 2) {
            const int pair = std::min(2, columns - x);
            std::array<float, 2> luma{};
            float u = 0.0F;
            float v = 0.0F;
            for (int i = 0; i < pair; ++i) {
                const float* p = in + static_cast<std::ptrdiff_t>(x + i) * 3;
                const float b = std::clamp(p[0], 0.0F, kWhite);
                const float g = std::clamp(p[1], 0.0F, kWhite);
                const float r = std::clamp(p[2], 0.0F, kWhite);
                luma[static_cast<std::size_t>(i)] =
                    std::floor(16.5F + 0.257F * r + 0.504F * g + 0.098F * b);
                u += -0.148F * r - 0.291F * g + 0.439F * b;
                v += 0.439F * r - 0.368F * g - 0.071F * b;
            }
            u = std::floor(u / static_cast<float>(pair) + 0.5F);
            v = std::floor(v / static_cast<float>(pair) + 0.5F);
            for (int i = 0; i < pair; ++i) {
                const float l = 1.164F * (luma[static_cast<std::size_t>(i)] - 16.0F);
                std::uint8_t* p = out + static_cast<std::ptrdiff_t>(x + i) * 3;
                p[0] = to_byte(l + 2.018F * u);
                p[1] = to_byte(l - 0.391F * u - 0.813F * v);
                p[2] = to_byte(l + 1.596F * v);
            }
        }
    }
}

void Sensor::read_out(std::uint64_t frame, ImageView<std::uint8_t> pixels) {
    blur();
    add_noise(frame);
    if (chroma_422_) {
        pack_422(pixels);
        return;
    }
    for (int y = 0; y < pixels.height; ++y) {
        const float* in = light_.row(y);
        std::uint8_t* out = pixels.row(y);
        for (int x = 0; x < pixels.width; ++x) {
            out[x] = to_byte(in[x]);
        }
    }
}

}  // namespace xtrack::sim
