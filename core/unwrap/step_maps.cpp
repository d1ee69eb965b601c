// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/step_maps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/unwrap/spatial_row.hpp"

namespace xtrack {
namespace {

using Word = StepMaps::Word;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr int kTopBit = kWordPixels - 1;
/// Deviations up to this many standard deviations of the noise are sound: 0.3 % are more.
constexpr double kNoiseSigmas = 3.0;
/// The median of |x| of a normal distribution, in standard deviations.
constexpr double kMedianOfNormal = 0.6745;
/// Deviations below this are sound however clean the image is: surfaces are not planes.
constexpr float kFloor_rad = 0.3F;
/// What is faint beside the rest of the image may deviate this much more than the rest does.
constexpr float kMostOfUsual = 2.0F;
constexpr int kNoiseRows = 16;
constexpr int kNoiseSamplesOfRow = 64;

/// A number of 0 ... 4 in each bit position.
struct Count {
    Word ones, twos, fours;
};

Count count(Word a, Word b, Word c, Word d) noexcept {
    const Word ab = a ^ b, ab2 = a & b;
    const Word cd = c ^ d, cd2 = c & d;
    return {ab ^ cd, ab2 ^ cd2 ^ (ab & cd), ab2 & cd2};
}

/// Wrapped difference of two phases, NaN where either is none.
float step_between(float from_rad, float to_rad) noexcept {
    constexpr float kPi = std::numbers::pi_v<float>;
    const float step_rad = to_rad - from_rad;
    const bool valid = std::fabs(from_rad) <= kPi && std::fabs(to_rad) <= kPi;
    return !valid            ? kNone
           : step_rad > kPi  ? step_rad - 2.0F * kPi
           : step_rad < -kPi ? step_rad + 2.0F * kPi
                             : step_rad;
}

float median(std::vector<float>& values) noexcept {
    if (values.empty()) {
        return 0.0F;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

/// Phase noise is that of the camera over the modulation, so the product of deviation and
/// modulation is one number for the image. The median hears nothing of steps, however large.
StepMaps::Noise StepMaps::measure_noise(ImageView<const float> phase_rad,
                                        ImageView<const float> modulation) noexcept {
    deviations_.clear();
    products_.clear();
    // Along rows, or down a column where rows are too short to tell.
    const bool along = phase_rad.width >= 6;
    const int length = along ? phase_rad.width : phase_rad.height;
    const int lines = along ? phase_rad.height : phase_rad.width;
    const std::ptrdiff_t phase_next = along ? 1 : phase_rad.stride;
    const std::ptrdiff_t modulation_next = along ? 1 : modulation.stride;
    const int line_step = std::max(1, lines / kNoiseRows);
    const int sample_step = std::max(1, length / kNoiseSamplesOfRow);
    for (int line = line_step / 2; line < lines; line += line_step) {
        const float* phase = along ? phase_rad.row(line) : phase_rad.data + line;
        const float* level = along ? modulation.row(line) : modulation.data + line;
        for (int i = 2; i + 3 < length && products_.size() < products_.capacity();
             i += sample_step) {
            const auto step = [&](int n) {
                const float* p = phase + (i + n) * phase_next;
                return step_between(p[0], p[phase_next]);
            };
            const float off = step_deviation(step(0), step(-2), step(-1), step(1), step(2));
            const float weaker = std::min(known_modulation(level[i * modulation_next]),
                                          known_modulation(level[(i + 1) * modulation_next]));
            if (off <= std::numeric_limits<float>::max() && weaker > 0.0F) {
                deviations_.push_back(off);
                products_.push_back(off * weaker);
            }
        }
    }
    constexpr auto kOfMedian = static_cast<float>(kNoiseSigmas / kMedianOfNormal);
    return {kOfMedian * median(products_), kMostOfUsual * kOfMedian * median(deviations_)};
}

float* StepMaps::Lines::row(int y) noexcept {
    return values.data() + stride * static_cast<std::size_t>(y % kLines) + kRowMargin;
}

StepMaps::StepMaps(Size size) : size_(size), words_((size.width + kWordPixels - 1) / kWordPixels) {
    const std::size_t words = static_cast<std::size_t>(words_);
    const std::size_t count = words * static_cast<std::size_t>(size.height);
    for (Map* map : {&valid, &right_up, &right_down, &below_up, &below_down, &right_possible,
                     &below_possible, &right_sound, &below_sound, &residue}) {
        map->resize(count);
    }
    below_contact.resize(count);
    best_modulation.resize(count);
    for (Lines* lines : {&phase_rad_, &modulation_, &right_step_rad_, &below_step_rad_}) {
        lines->stride = words * kWordPixels + 2 * kRowMargin;
        lines->values.assign(lines->stride * kLines, lines == &modulation_ ? 0.0F : kNone);
    }
    bad_loops_.resize(2 * words);
    const auto samples = static_cast<std::size_t>(2 * kNoiseRows * 2 * kNoiseSamplesOfRow);
    deviations_.reserve(samples);
    products_.reserve(samples);
}

void StepMaps::make(ImageView<const float> phase_rad, ImageView<const float> modulation,
                    float limit_rad) noexcept {
    const Noise noise = measure_noise(phase_rad, modulation);
    // Judging a row needs the steps of two rows above and two below, and these the phase of one
    // more.
    std::fill_n(below_step_rad_.row(kLines - 2), size_.width, kNone);
    std::fill_n(below_step_rad_.row(kLines - 1), size_.width, kNone);
    for (int y = -3; y < size_.height; ++y) {
        take(y + 3, phase_rad, modulation);
        if (y + 2 >= 0) {
            step(y + 2);
        }
        if (y >= 0) {
            judge(y, limit_rad, noise);
        }
    }
    cut_residues();
}

void StepMaps::take(int y, ImageView<const float> phase_rad,
                    ImageView<const float> modulation) noexcept {
    if (y >= size_.height) {
        std::fill_n(phase_rad_.row(y), size_.width, kNone);
        std::fill_n(modulation_.row(y), size_.width, 0.0F);
        return;
    }
    TakeRow row;
    row.count = size_.width;
    row.phase_rad = phase_rad.row(y);
    row.modulation = modulation.row(y);
    row.padded_phase_rad = phase_rad_.row(y);
    row.padded_modulation = modulation_.row(y);
    row.best_modulation = &best_modulation[at(0, y)];
    take_row(row);
}

void StepMaps::step(int y) noexcept {
    if (y >= size_.height) {
        std::fill_n(below_step_rad_.row(y), size_.width, kNone);
        return;
    }
    const std::size_t i = at(0, y);
    StepRow row;
    row.words = words_;
    row.phase_rad = phase_rad_.row(y);
    row.below_rad = phase_rad_.row(y + 1);
    row.right_step_rad = right_step_rad_.row(y);
    row.below_step_rad = below_step_rad_.row(y);
    row.valid = &valid[i];
    row.right_up = &right_up[i];
    row.right_down = &right_down[i];
    row.below_up = &below_up[i];
    row.below_down = &below_down[i];
    step_row(row);
}

void StepMaps::judge(int y, float limit_rad, const Noise& noise) noexcept {
    const std::size_t i = at(0, y);
    JudgeRow row;
    row.words = words_;
    row.limit_rad = limit_rad;
    row.noise = noise.product;
    row.sound_limit_rad = noise.most_rad;
    row.floor_rad = kFloor_rad;
    row.step_rad = right_step_rad_.row(y);
    row.beside_rad = {row.step_rad - 2, row.step_rad - 1, row.step_rad + 1, row.step_rad + 2};
    row.modulation = modulation_.row(y);
    row.other_modulation = row.modulation + 1;
    row.possible = &right_possible[i];
    row.sound = &right_sound[i];
    judge_row(row);
    row.step_rad = below_step_rad_.row(y);
    row.beside_rad = {below_step_rad_.row(y + kLines - 2), below_step_rad_.row(y + kLines - 1),
                      below_step_rad_.row(y + 1), below_step_rad_.row(y + 2)};
    row.other_modulation = modulation_.row(y + 1);
    row.possible = &below_possible[i];
    row.sound = &below_sound[i];
    judge_row(row);
}

/// Finds the residues, and takes soundness from the four steps of a loop that is all sound and yet
/// does not close: one of them is wrong, and which one is not known.
void StepMaps::cut_residues() noexcept {
    Word* const bad_above = bad_loops_.data();
    Word* const bad = bad_above + words_;
    std::fill(bad_loops_.begin(), bad_loops_.end(), 0);
    for (int y = 0; y < size_.height; ++y) {
        const bool last = y + 1 == size_.height;
        for (int c = 0; c < words_; ++c) {
            const std::size_t i = at(c, y);
            const std::size_t below = last ? i : at(c, y + 1);
            // The step down that starts one pixel to the right.
            const auto right_of = [&](const Map& map) {
                return map[i] >> 1U | (c + 1 < words_ ? map[i + 1] << kTopBit : 0);
            };
            const Count up =
                count(right_up[i], right_of(below_up), right_down[below], below_down[i]);
            const Count down =
                count(right_down[i], right_of(below_down), right_up[below], below_up[i]);
            residue[i] = (up.ones ^ down.ones) | (up.twos ^ down.twos) | (up.fours ^ down.fours);
            // In the last row no step downward is sound.
            bad[c] = residue[i] & right_sound[i] & right_sound[below] & below_sound[i] &
                     right_of(below_sound);
        }
        for (int c = 0; c < words_; ++c) {
            const std::size_t i = at(c, y);
            right_sound[i] &= ~(bad[c] | bad_above[c]);
            below_sound[i] &= ~(bad[c] | bad[c] << 1U | (c > 0 ? bad[c - 1] >> kTopBit : 0));
            const Word contact = last ? 0 : valid[i] & valid[i + static_cast<std::size_t>(words_)];
            below_contact[i] = {static_cast<std::uint8_t>(count_bits(contact)),
                                static_cast<std::uint8_t>(count_bits(below_sound[i]))};
        }
        std::copy_n(bad, words_, bad_above);
    }
}

}  // namespace xtrack
