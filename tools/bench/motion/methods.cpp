// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/motion/methods.hpp"

namespace xtrack::tools::bench {

namespace {

constexpr double kFine_px = 96.0;
constexpr double kColourCoarse_px = 768.0;
constexpr double kGrayCell_px = 32.0;
constexpr double kCarrier_px = 16.0;

DecodeSettings as_they_come(PhaseTaps taps) {
    DecodeSettings settings;
    settings.taps = taps;
    settings.motion = MotionHandling::off;
    return settings;
}

}  // namespace

Result<std::array<MotionMethod, kMotionMethods>> motion_methods(const Rig& rig) {
    const auto unique_px = volume_wide_period_px(rig, Axis::x);
    if (!unique_px) {
        return unique_px.error();
    }
    const Size projector = rig.projector->size;
    const PatternSequence three = three_step_sequence(Axis::x, projector, *unique_px);
    std::array<MotionMethod, kMotionMethods> methods{{
        {"three-step",
         "3 steps, one volume-wide period",
         three,
         false,
         as_they_come(PhaseTaps::least_squares),
         {{{2.4, 0, 0},
           {6.6, 25, 1},
           {8.3, 38, 2},
           {9.1, 46, 2},
           {9.6, 50, 3},
           {11, 59, 3},
           {11, 60, 3},
           {12, 74, 2}}},
         {{{3.7, 2}, {5.8, 5}}}},
        {"three-plus-two",
         "3+2, as they come",
         three,
         false,
         as_they_come(PhaseTaps::three_plus_two),
         {{{2.1, 0, 0},
           {5.7, 14, 1},
           {6.9, 33, 1},
           {7.8, 40, 3},
           {8.1, 42, 2},
           {9.7, 48, 2},
           {10, 53, 2},
           {12, 70, 4}}},
         {{{2.2, 2}, {2.4, 4}}}},
        {"grey",
         "3+2, hand followed (grey)",
         three,
         false,
         {},
         {{{2.1, 0, 0},
           {3.0, 3, 2},
           {3.2, 4, 4},
           {3.5, 10, 6},
           {4.9, 9, 11},
           {9.4, 26, 10},
           {11, 41, 11},
           {11, 57, 7}}},
         {}},
        {"dual",
         "2x3, P 96 + unit period",
         dual_sequence(Axis::x, projector, projector.width, kFine_px),
         false,
         {},
         {{{0.6, 0, 0},
           {2.0, 23, 16},
           {4.1, 21, 24},
           {4.5, 30, 34},
           {4.9, 22, 43},
           {8.4, 25, 60},
           {9.6, 25, 59},
           {12, 41, 47}}},
         {}},
        {"gray-phase",
         "Gray code 5 bits + 3 steps",
         gray_code_sequence(Axis::x, projector, kGrayCell_px),
         false,
         {},
         {{{0.4, 0, 0},
           {1.3, 13, 31},
           {2.7, 19, 33},
           {3.9, 17, 47},
           {5.2, 15, 57},
           {10, 12, 79},
           {9.9, 24, 73},
           {kNoFigure, 46, 54}}},
         {}},
        {"rgb-static",
         "RGB one frame, P 96",
         rgb_sequence(Axis::x, projector, {kFine_px}),
         true,
         {},
         {{{2.7, 1, 0},
           {2.7, 1, 1},
           {2.6, 2, 1},
           {2.8, 2, 1},
           {2.8, 2, 0},
           {3.5, 2, 1},
           {2.9, 2, 1},
           {3.6, 2, 0}}},
         {{{2.7, 1}, {2.7, 1}}}},
        {"rgb",
         "RGB two frames, P 768 + P 96",
         rgb_sequence(Axis::x, projector, {kColourCoarse_px, kFine_px}),
         true,
         {},
         {{{1.8, 3, 1},
           {1.8, 3, 1},
           {1.9, 4, 1},
           {2.1, 4, 0},
           {2.3, 6, 0},
           {3.0, 7, 0},
           {2.5, 7, 0},
           {4.2, 11, 0}}},
         {{{1.9, 4}, {1.9, 5}}}},
        {"ftp",
         "one grey frame, P 16 (ftp)",
         n_step_sequence(Axis::x, projector, kCarrier_px, 1),
         false,
         {},
         {},
         {}},
    }};
    // The camera and the projector agree on what is linear but for a rest that calibration leaves.
    for (MotionMethod& method : methods) {
        method.patterns.gamma = 1.0;
    }
    return methods;
}

}  // namespace xtrack::tools::bench
