// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/decode/colour_surface.hpp"

namespace xtrack {

/// A colour pattern, as far as surfaces are concerned.
struct ColourPeriod {
    double period_px = 0.0;
    double phase_rad = 0.0;  ///< of red
};

/// What is looked at of some pixels, an array for each value.
template <typename Pointer>
struct BasicColourSamples {
    std::array<Pointer, 3> fine{};    ///< ColourModel::Light of the finest period
    std::array<Pointer, 3> coarse{};  ///< the same of the period that orders it
    Pointer reference_px{};  ///< nearest to which the coarse period, or without it the fine one,
                             ///< is unwrapped; NaN: nothing known
};
using ColourSamples = BasicColourSamples<const float*>;
using ColourSamplesOut = BasicColourSamples<float*>;

/// How badly one surface explains samples.
struct ColourCost {
    ColourModel::Inverse inverse = ColourModel::Inverse::Identity();  ///< of the surface
    ColourModel::Inverse coarse_inverse = ColourModel::Inverse::Identity();
    float contrast = 1.0F;  ///< of the surface
    float transfer = 1.0F;  ///< of the surface
    ColourPeriod fine;
    ColourPeriod coarse;
    bool has_coarse = false;  ///< else the surface's contrast stands for the coarse one's
    ColourSamples samples;
    int count = 0;
    float* cost = nullptr;           ///< out: 0 ... kMostColourCost
    float* fine_contrast = nullptr;  ///< out, if wanted: as seen; anything where no light is
};

/// That of a pixel that the surface does not explain at all.
inline constexpr float kMostColourCost = 0.5F;

/// The periods' disagreement on coordinate (shares of the fine period) and contrast, squared.
/// @thread any
/// @ownership borrows everything for the call
void colour_cost(const ColourCost& row) noexcept;

/// The reference form, plain C++.
void colour_cost_scalar(const ColourCost& row) noexcept;

#if XTRACK_WITH_HIGHWAY
void colour_cost_highway(const ColourCost& row) noexcept;
#endif

}  // namespace xtrack
