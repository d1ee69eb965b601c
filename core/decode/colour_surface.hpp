// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include <xtrack/geometry.hpp>
#include <xtrack/result.hpp>

namespace xtrack {

/// What a surface and the light on it do to the three phases of a colour fringe: the projector's
/// colour k arrives at the camera as
///   v_k = s g_k (1 + o_k + kappa cos(phi + p_k)),
/// s the light, g_k the gain of colour k, o_k a tint of the ambient light. Only deviations between
/// the colours matter, so gains and tints are kept as one complex number each:
///   ln g_k = 2 Re(E e^{-ip_k}),  o_k = 2 Re(O e^{-ip_k}),  p_k counted from red's.
///
/// Light that goes through skin comes out beside where it went in, red farther than blue, which
/// washes short fringes out and leaves long ones: of the fine period there is only
///   f h_k kappa cos(phi + p_k),  ln h_k = 2 Re(F e^{-ip_k}).
/// Where only one period is known this is the same as gains and a tint.
struct ColourSurface {
    float contrast = 1.0F;                ///< kappa f, that of the fine period
    std::array<float, 2> log_gain{};      ///< E
    std::array<float, 2> tint{};          ///< O
    float transfer = 1.0F;                ///< f, of modulation
    std::array<float, 2> log_transfer{};  ///< F
};

/// The colours of a projector and a camera, and the arithmetic of surfaces under them.
/// @thread any; const
class ColourModel {
 public:
    /// Light of the projector's colours red, green, blue as the camera sees it, freed of crosstalk.
    using Light = Eigen::Matrix<float, 3, 1, Eigen::DontAlign>;
    /// From Light to (s, s kappa cos phi, s kappa sin phi), phi at red.
    using Inverse = Eigen::Matrix<float, 3, 3, Eigen::DontAlign>;
    /// From a pixel's blue, green, red to the real and the imaginary part of B e^{i phi}.
    static constexpr std::size_t kTaps = 6;
    using Taps = std::array<float, kTaps>;

    ColourModel() = default;
    /// @param phases_rad of red, green, blue; thirds of a turn apart
    /// @param camera_from_projector_rgb linear; rows camera R, G, B, columns projector R, G, B
    /// @return invalid_argument for other phases, or a matrix that cannot be inverted
    [[nodiscard]] static Result<ColourModel> create(const std::array<double, 3>& phases_rad,
                                                    const Mat3d& camera_from_projector_rgb);

    [[nodiscard]] Light light(const std::uint8_t* bgr) const noexcept {
        return projector_from_bgr_ * Light(bgr[0], bgr[1], bgr[2]);
    }
    /// Of the fine period; contrast and f are left in.
    [[nodiscard]] Inverse inverse(const ColourSurface& surface) const noexcept;
    /// Of the coarse one.
    [[nodiscard]] Inverse coarse_inverse(const ColourSurface& surface) const noexcept;
    /// Taps that give the phase of a pattern whose red has the phase 0.
    [[nodiscard]] Taps taps(const Inverse& inverse) const noexcept;
    /// Red, green, blue, relative to their geometric mean.
    [[nodiscard]] std::array<float, 3> gains(const ColourSurface& surface) const noexcept;
    /// The surface of these gains (any common factor), without tint.
    [[nodiscard]] ColourSurface surface(const std::array<float, 3>& gains,
                                        float contrast) const noexcept;
    /// Phase of each colour from that of red, rad.
    [[nodiscard]] const std::array<float, 3>& steps_rad() const noexcept { return steps_rad_; }

 private:
    Inverse projector_from_bgr_ = Inverse::Identity();
    std::array<float, 3> steps_rad_{};
    std::array<float, 3> cosine_{1.0F, 1.0F, 1.0F};  // of the steps
    std::array<float, 3> sine_{};
};

/// Finds a surface's gains, tint and contrast from its pixels, whatever their shading.
///
/// What is wrong in them shows: the contrast |z| / s, which must not depend on the phase, then has
/// harmonics. With ln g_k off by E and o_k by O,
///   |z| / s = kappa + (2 - kappa^2) Re(E e^{i phi}) + kappa Re(E* e^{2 i phi}) + 2 Re(O e^{i phi})
///             - kappa^2 Re(F e^{i phi}) + kappa Re(F* e^{2 i phi})
/// to first order. So they follow by least squares, and Gauss-Newton steps make them exact.
/// One period alone does not tell F: add_pair() does.
class ColourFit {
 public:
    /// One pixel as seen under what is believed now.
    /// @param seen model.inverse(believed) * light
    void add(const ColourSurface& believed, const ColourModel::Light& seen, float weight) noexcept;
    /// The same pixel under a second, coarser period, which has a contrast of its own: their phases
    /// must agree.
    /// @param fine, coarse model.inverse(believed) and model.coarse_inverse(believed) * light
    /// @param ratio of the fine period to the coarse one
    /// @param ahead_rad the coarse phase, less what the fine one says it should be
    void add_pair(const ColourSurface& believed, const ColourModel::Light& fine,
                  const ColourModel::Light& coarse, float ratio, float ahead_rad,
                  float weight) noexcept;
    [[nodiscard]] float pixels() const noexcept { return sums_[0]; }
    /// One step. What is believed counts as so many pixels. f and F stay until there are pairs.
    /// @param may_transfer false: the surface is opaque, F = 0 and f = 1
    [[nodiscard]] ColourSurface solve(const ColourSurface& believed, float believed_pixels,
                                      bool may_transfer = true) const noexcept;
    void clear() noexcept { sums_.fill(0.0F); }
    void forget(float share) noexcept;

 private:
    static constexpr std::size_t kUnknowns = 8;  // kappa of fine and coarse, E, O, F
    using Row = std::array<float, kUnknowns>;
    void add_equation(const Row& slope, float right, float weight) noexcept;
    // Of the normal equations: upper triangle, right side.
    std::array<float, kUnknowns*(kUnknowns + 1) / 2 + kUnknowns> sums_{};
};

}  // namespace xtrack
