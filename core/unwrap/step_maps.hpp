// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <xtrack/image.hpp>

namespace xtrack {

/// Bits 0 ... n - 1. @pre 0 <= n < 64
[[nodiscard]] constexpr std::uint64_t bits_below(int n) noexcept {
    return (std::uint64_t{1} << n) - 1U;
}

/// How many bits are set. std::popcount() is a call into a table where the compiler may not assume
/// the instruction, which an x86-64 library for every CPU may not.
[[nodiscard]] constexpr int count_bits(std::uint64_t word) noexcept {
    word -= word >> 1U & 0x5555555555555555U;
    word = (word & 0x3333333333333333U) + (word >> 2U & 0x3333333333333333U);
    word = (word + (word >> 4U)) & 0x0F0F0F0F0F0F0F0FU;
    return static_cast<int>(word * 0x0101010101010101U >> 56U);
}

/// What is known of the steps between the neighbours of a wrapped phase image, a bit a pixel: 64
/// pixels of a row are one word, so that loops, runs and votes are a few operations a word. A step
/// to the right or below belongs to the pixel it starts from.
class StepMaps {
 public:
    using Word = std::uint64_t;
    /// One bit a pixel; word c of row y is at y words() + c.
    using Map = std::vector<Word>;

    explicit StepMaps(Size size);

    /// @param limit_rad deviation beyond which a step is not possible
    /// @pre images of the size given
    void make(ImageView<const float> phase_rad, ImageView<const float> modulation,
              float limit_rad) noexcept;

    [[nodiscard]] int words() const noexcept { return words_; }
    [[nodiscard]] std::size_t at(int word, int y) const noexcept {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(words_) +
               static_cast<std::size_t>(word);
    }

    /// Change of the order over the marked steps to the right of one word.
    [[nodiscard]] std::int32_t rise_along(std::size_t i, Word steps) const noexcept {
        return count_bits(right_up[i] & steps) - count_bits(right_down[i] & steps);
    }
    [[nodiscard]] std::int32_t rise_below(std::size_t i, Word steps) const noexcept {
        return count_bits(below_up[i] & steps) - count_bits(below_down[i] & steps);
    }

    Map valid;                           ///< pixels with a phase
    Map right_up, right_down;            ///< steps that wrap: the order rises or falls
    Map below_up, below_down;            ///< the same downward
    Map right_possible, below_possible;  ///< steps within the limit
    Map right_sound, below_sound;        ///< within the noise, and in no residue
    Map residue;                         ///< the loop right, down, left, up does not close
    /// Of a word: pixels that have one below them, and how many steps to these are sound.
    struct Contact {
        std::uint8_t pixels = 0;
        std::uint8_t sound = 0;
    };
    std::vector<Contact> below_contact;
    std::vector<float> best_modulation;  ///< highest of each word's valid pixels

 private:
    /// Rows in work, by y modulo their number; padded as spatial_row.hpp wants.
    struct Lines {
        std::vector<float> values;
        std::size_t stride = 0;
        [[nodiscard]] float* row(int y) noexcept;
    };
    /// Bounds of what deviates by noise.
    struct Noise {
        float product = 0.0F;   ///< deviation times modulation, rad grey levels
        float most_rad = 0.0F;  ///< deviation at any modulation
    };
    static constexpr int kLines = 8;

    void take(int y, ImageView<const float> phase_rad, ImageView<const float> modulation) noexcept;
    void step(int y) noexcept;
    void judge(int y, float limit_rad, const Noise& noise) noexcept;
    [[nodiscard]] Noise measure_noise(ImageView<const float> phase_rad,
                                      ImageView<const float> modulation) noexcept;
    void cut_residues() noexcept;

    Size size_;
    int words_ = 0;
    Lines phase_rad_, modulation_, right_step_rad_, below_step_rad_;
    std::vector<Word> bad_loops_;  ///< of the row above and of this row
    std::vector<float> deviations_;
    std::vector<float> products_;
};

}  // namespace xtrack
