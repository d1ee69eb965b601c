// SPDX-License-Identifier: Apache-2.0
// Photographs and rendered recordings with known answers, kept beside the project's folder
// (../shared/data); skipped where they are absent.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <xtrack/depth_decoder.hpp>
#include <xtrack/light_calibration.hpp>
#include <xtrack/phase_ripple.hpp>
#include <xtrack/relative_depth.hpp>

#include "tests/core/pipeline/recording_on_disk.hpp"

namespace xtrack {
namespace {

// NOLINTBEGIN(bugprone-macro-parentheses): it declares `recording`
#define LOAD_OR_SKIP(name, recording)                                            \
    test::RecordingOnDisk recording;                                             \
    if (!test::load_recording(name, recording)) {                                \
        GTEST_SKIP() << "no recording " << name << " in " << XTRACK_SHARED_DATA; \
    }
// NOLINTEND(bugprone-macro-parentheses)

DepthDecoder decode_all(const test::RecordingOnDisk& recording, DecodeSettings settings) {
    settings.keep_maps = true;
    auto made = DepthDecoder::create(recording.rig, recording.patterns, recording.size(), settings);
    EXPECT_TRUE(made) << made.error().message;
    if (settings.order == OrderSource::depth_image) {
        EXPECT_TRUE(made->set_order_depth(recording.truth_depth(0).view(), 0.1));
    }
    for (const FramePtr& frame : recording.frames) {
        EXPECT_NE(made->push(frame).state, DecodeState::rejected);
    }
    return *std::move(made);
}

struct Skull {
    const char* name;
    double tolerance_mm;
};
class Skulls : public testing::TestWithParam<Skull> {};

TEST_P(Skulls, LieWhereTheyStood) {
    LOAD_OR_SKIP(GetParam().name, recording);
    const DepthDecoder decoder = decode_all(recording, {});
    std::vector<double> z;
    const DepthFrame& depth = decoder.depth();
    for (int y = 0; y < depth.depth.height(); ++y) {
        for (int x = 0; x < depth.depth.width(); ++x) {
            if (depth.depth.at(x, y) > 0 && decoder.phase().modulation.at(x, y) > 8.0F) {
                z.push_back(0.1 * depth.depth.at(x, y));
            }
        }
    }
    ASSERT_GT(z.size(), 300000U);
    std::sort(z.begin(), z.end());
    EXPECT_NEAR(z[z.size() / 2], 386.0, GetParam().tolerance_mm);
    EXPECT_GT(z[z.size() / 100], 350.0);
    EXPECT_LT(z[z.size() * 99 / 100], 450.0);
}

INSTANTIATE_TEST_SUITE_P(Photographs, Skulls,
                         testing::Values(Skull{"fringe/skull-2x3", 2.0},
                                         Skull{"fringe/skull-3step", 3.0},
                                         Skull{"fringe/skull-gray", 2.0}));

TEST(SkullPairs, TwoPeriodsAgreeWithTheGrayCode) {
    LOAD_OR_SKIP("fringe/skull-2x3", sines);
    LOAD_OR_SKIP("fringe/skull-gray", gray);
    const DepthDecoder a = decode_all(sines, {});
    const DepthDecoder b = decode_all(gray, {});
    std::vector<double> difference;
    for (int y = 0; y < a.coordinate_px().height(); ++y) {
        for (int x = 0; x < a.coordinate_px().width(); ++x) {
            if (a.phase().modulation.at(x, y) > 8.0F && b.phase().modulation.at(x, y) > 8.0F) {
                const double d = static_cast<double>(a.coordinate_px().at(x, y)) -
                                 static_cast<double>(b.coordinate_px().at(x, y));
                if (std::isfinite(d)) {
                    difference.push_back(std::fabs(d));
                }
            }
        }
    }
    ASSERT_GT(difference.size(), 300000U);
    std::nth_element(difference.begin(),
                     difference.begin() + static_cast<std::ptrdiff_t>(difference.size() / 2),
                     difference.end());
    const double median = difference[difference.size() / 2];
    RecordProperty("median_absolute_deviation_px", std::to_string(median));
    EXPECT_LE(median, 0.8);
    EXPECT_GT(median, 0.05);  // they are two measurements, not one
}

struct HandScore {
    double rms_mm = 0.0;
    double off = 0.0;
    double missing = 0.0;
};

// On the hand, `erode_px` from its border.
HandScore judge(const test::RecordingOnDisk& recording, const DepthFrame& depth, int truth,
                int erode_px, double limit_mm) {
    const Image<std::uint16_t> want = recording.truth_depth(truth);
    const Image<std::uint8_t> mask = recording.truth_mask(truth);
    cv::Mat hand(mask.height(), mask.width(), CV_8U);
    for (int y = 0; y < hand.rows; ++y) {
        for (int x = 0; x < hand.cols; ++x) {
            hand.at<std::uint8_t>(y, x) = mask.at(x, y) == 1 ? 1 : 0;
        }
    }
    const int side = 2 * erode_px + 1;
    cv::erode(hand, hand, cv::Mat::ones(side, side, CV_8U));
    double count = 0.0;
    double squares = 0.0;
    double inliers = 0.0;
    HandScore score;
    for (int y = 0; y < hand.rows; ++y) {
        for (int x = 0; x < hand.cols; ++x) {
            if (hand.at<std::uint8_t>(y, x) == 0) {
                continue;
            }
            count += 1.0;
            const double error = 0.1 * (depth.depth.at(x, y) - want.at(x, y));
            if (depth.depth.at(x, y) == 0) {
                score.missing += 1.0;
            } else if (std::fabs(error) > limit_mm) {
                score.off += 1.0;
            } else {
                squares += error * error;
                inliers += 1.0;
            }
        }
    }
    score.missing /= count;
    score.off /= count;
    score.rms_mm = std::sqrt(squares / std::max(inliers, 1.0));
    return score;
}

struct Still {
    const char* name;
    OrderSource order;
    double rms_mm;
};
class Stills : public testing::TestWithParam<Still> {};

TEST_P(Stills, ShowTheHandToAFractionOfAMillimetre) {
    LOAD_OR_SKIP(GetParam().name, recording);
    DecodeSettings settings;
    settings.order = GetParam().order;
    const DepthDecoder decoder = decode_all(recording, settings);
    const HandScore score = judge(recording, decoder.depth(), 0, 2, 15.0);
    RecordProperty("rms_mm", std::to_string(score.rms_mm));
    EXPECT_LE(score.rms_mm, GetParam().rms_mm);
    EXPECT_LE(score.off, 0.01);
    EXPECT_LE(score.missing, 0.03);
}

INSTANTIATE_TEST_SUITE_P(
    Rendered, Stills,
    testing::Values(Still{"rendered/static-dual", OrderSource::automatic, 0.45},
                    Still{"rendered/static-gray", OrderSource::automatic, 0.5},
                    Still{"rendered/static-three-step", OrderSource::depth_image, 0.45},
                    Still{"rendered/static-rgb", OrderSource::automatic, 0.6},
                    Still{"rendered/static-dual-gamma22", OrderSource::automatic, 0.8}));

// Light that enters skin comes out around there, farther in red than in blue: six tenths of it with
// sigma, the rest with three times as much, px (1.2 mm each).
void let_light_through(test::RecordingOnDisk& recording, const std::array<double, 3>& sigma_bgr) {
    const Image<std::uint8_t> mask = recording.truth_mask(0);
    constexpr int kLastSkin = 3;  // hand, forearm, the rest of the arm
    cv::Mat skin(mask.height(), mask.width(), CV_32F);
    for (int y = 0; y < skin.rows; ++y) {
        for (int x = 0; x < skin.cols; ++x) {
            skin.at<float>(y, x) = mask.at(x, y) >= 1 && mask.at(x, y) <= kLastSkin ? 1.0F : 0.0F;
        }
    }
    const auto blurred = [&](const cv::Mat& light, double sigma) {
        cv::Mat sum;
        cv::Mat weight;
        cv::GaussianBlur(light.mul(skin), sum, {}, sigma);
        cv::GaussianBlur(skin, weight, {}, sigma);
        return cv::Mat(sum / (weight + 1e-6));
    };
    cv::RNG noise(1);
    for (FramePtr& frame : recording.frames) {
        auto changed = std::make_shared<Frame>(*frame);
        const int channels = frame->channels();
        for (int c = 0; c < channels; ++c) {
            cv::Mat light(skin.rows, skin.cols, CV_32F);
            for (int y = 0; y < skin.rows; ++y) {
                for (int x = 0; x < skin.cols; ++x) {
                    light.at<float>(y, x) = frame->pixels.at(channels * x + c, y);
                }
            }
            const double sigma = sigma_bgr[channels == 1 ? 1 : static_cast<std::size_t>(c)];
            const cv::Mat through = 0.6 * blurred(light, sigma) + 0.4 * blurred(light, 3.0 * sigma);
            for (int y = 0; y < skin.rows; ++y) {
                for (int x = 0; x < skin.cols; ++x) {
                    if (skin.at<float>(y, x) > 0.0F) {
                        changed->pixels.at(channels * x + c, y) = cv::saturate_cast<std::uint8_t>(
                            through.at<float>(y, x) + static_cast<float>(noise.gaussian(0.8)));
                    }
                }
            }
        }
        frame = changed;
    }
}

struct Translucent {
    const char* name;
    std::array<double, 3> sigma_bgr;
    double rms_mm;
};
class TranslucentSkin : public testing::TestWithParam<Translucent> {};

TEST_P(TranslucentSkin, IsMeasuredAllTheSame) {
    LOAD_OR_SKIP(GetParam().name, recording);
    let_light_through(recording, GetParam().sigma_bgr);
    const DepthDecoder decoder = decode_all(recording, {});
    const HandScore score = judge(recording, decoder.depth(), 0, 2, 15.0);
    std::printf("%s, %.1f px in green: RMS %.2f mm, off %.2f %%, missing %.2f %%\n",
                GetParam().name, GetParam().sigma_bgr[1], score.rms_mm, 100.0 * score.off,
                100.0 * score.missing);
    EXPECT_LE(score.rms_mm, GetParam().rms_mm);
    EXPECT_LE(score.off, 0.01);
    EXPECT_LE(score.missing, 0.03);
}

INSTANTIATE_TEST_SUITE_P(Rendered, TranslucentSkin,
                         testing::Values(Translucent{"rendered/static-dual", {0.6, 1.0, 2.0}, 0.6},
                                         Translucent{"rendered/static-gray", {0.6, 1.0, 2.0}, 0.6},
                                         Translucent{"rendered/static-rgb", {0.3, 0.4, 1.0}, 0.6},
                                         Translucent{"rendered/static-rgb", {0.6, 1.0, 2.0}, 1.0}));

// Grey fringes of the same scene say where on the projector each pixel looks. No ramp, no white:
// the projector is known to be linear, and the colours of skin, clothes and wall average.
TEST(ColoursOfARendering, GiveItsMatrixAndItsDepth) {
    LOAD_OR_SKIP("rendered/static-dual", grey);
    LOAD_OR_SKIP("rendered/static-rgb", colour);
    PatternSequence both = grey.patterns;
    both.patterns.insert(both.patterns.end(), colour.patterns.patterns.begin(),
                         colour.patterns.patterns.end());
    auto calibrator = LightCalibrator::create(both, colour.size(), grey.rig);
    ASSERT_TRUE(calibrator) << calibrator.error().message;
    for (const FramePtr& frame : grey.frames) {
        ASSERT_TRUE(calibrator->add(*frame));
    }
    for (const FramePtr& frame : colour.frames) {
        Frame later = *frame;
        later.pattern += static_cast<int>(grey.patterns.patterns.size());
        ASSERT_TRUE(calibrator->add(later));
    }
    const auto found = calibrator->finish();
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_TRUE(found->colour);
    const ColourSelfTest& test = *found->colour;
    const Mat3d error = test.camera_from_projector_rgb - *colour.rig.camera_from_projector_rgb;
    const auto score_of = [&](const std::optional<Mat3d>& matrix) {
        test::RecordingOnDisk with = colour;
        with.rig.camera_from_projector_rgb = matrix;
        return judge(with, decode_all(with, {}).depth(), 0, 2, 15.0);
    };
    const HandScore theirs = score_of(colour.rig.camera_from_projector_rgb);
    const HandScore ours = score_of(test.camera_from_projector_rgb);
    const HandScore none = score_of(std::nullopt);
    std::printf(
        "static-rgb: matrix off by %.3f at most, residual %.3f, phase error %.3f rad, contrast "
        "%.3f, %zu pixels (%s); depth RMS/off/missing with the file's matrix %.2f mm/%.1f/%.1f %%, "
        "with ours %.2f mm/%.1f/%.1f %%, with none %.2f mm/%.1f/%.1f %%\n",
        error.cwiseAbs().maxCoeff(), test.residual, test.phase_error_rad, test.contrast,
        test.pixels, test.reason.c_str(), theirs.rms_mm, 100.0 * theirs.off, 100.0 * theirs.missing,
        ours.rms_mm, 100.0 * ours.off, 100.0 * ours.missing, none.rms_mm, 100.0 * none.off,
        100.0 * none.missing);
    EXPECT_TRUE(test.passed) << test.reason;
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 0.02);
    EXPECT_LE(ours.rms_mm, 0.57);
    EXPECT_LE(ours.off, 0.01);
    EXPECT_LE(ours.missing, 0.03);
}

// Of three steps; where the first begins does not matter to gamma.
const std::vector<double> kPhases_rad{0.0, -2.0943951, -4.1887902};

// Of the shortest period, with the projector's gamma as given.
PhaseMap phase_of(const test::RecordingOnDisk& recording, std::optional<double> gamma) {
    test::RecordingOnDisk with = recording;
    with.patterns.gamma = gamma;
    DecodeSettings settings;
    settings.order = OrderSource::none;
    settings.motion = MotionHandling::off;
    return decode_all(with, settings).phase();
}

// The columns from `begin` to `end`.
PhaseMap part_of(const PhaseMap& map, int begin, int end) {
    PhaseMap part;
    part.period_px = map.period_px;
    part.phase_rad.resize(end - begin, map.phase_rad.height());
    for (int y = 0; y < part.phase_rad.height(); ++y) {
        std::copy(map.phase_rad.row(y) + begin, map.phase_rad.row(y) + end, part.phase_rad.row(y));
    }
    return part;
}

struct Wall {
    const char* name;
    double ripple_rad;  // before, as published
};
class Gammas : public testing::TestWithParam<Wall> {};

// Gamma is learnt from the left half and judged by the right.
TEST_P(Gammas, AreFoundFromTheFringes) {
    LOAD_OR_SKIP(GetParam().name, recording);
    const PhaseMap seen = phase_of(recording, std::nullopt);
    const int width = seen.phase_rad.width();
    const auto gamma = estimate_gamma(part_of(seen, 0, width / 2), kPhases_rad);
    ASSERT_TRUE(gamma) << gamma.error().message;
    const auto before = measure_ripple(part_of(seen, width / 2, width), 3);
    const auto after = measure_ripple(part_of(phase_of(recording, *gamma), width / 2, width), 3);
    ASSERT_TRUE(before && after);
    std::printf("%s: gamma %.2f, ripple at three times the phase %.3f -> %.3f rad\n",
                GetParam().name, *gamma, before->gamma_rad, after->gamma_rad);
    EXPECT_NEAR(before->gamma_rad, GetParam().ripple_rad, 0.2 * GetParam().ripple_rad);
    EXPECT_LT(after->gamma_rad, before->gamma_rad / 5.0);
    EXPECT_EQ(cause_of(*before), RippleCause::gamma);
}

INSTANTIATE_TEST_SUITE_P(Photographs, Gammas,
                         testing::Values(Wall{"fringe/gamma-wall-a", 0.288},
                                         Wall{"fringe/gamma-wall-b", 0.096},
                                         Wall{"fringe/mugs", 0.39}));

// With the gamma that the recording states taken away.
TEST(GammaOfAHand, IsFoundFromTheFringes) {
    LOAD_OR_SKIP("rendered/static-dual-gamma22", recording);
    const auto gamma = estimate_gamma(phase_of(recording, std::nullopt), kPhases_rad);
    ASSERT_TRUE(gamma) << gamma.error().message;
    EXPECT_NEAR(*gamma, 2.2, 0.2);
    recording.patterns.gamma = *gamma;
    const HandScore score = judge(recording, decode_all(recording, {}).depth(), 0, 2, 15.0);
    std::printf("static-dual-gamma22 without its gamma: found %.2f, RMS %.2f mm, off %.2f %%\n",
                *gamma, score.rms_mm, 100.0 * score.off);
    EXPECT_LE(score.rms_mm, 0.6);
    EXPECT_LE(score.off, 0.01);
    EXPECT_LE(score.missing, 0.03);
}

// Mugs before a wall, without a calibration: the wall is flat, the mugs stand out.
TEST(HeightsOfMugs, StandOutFromTheWall) {
    LOAD_OR_SKIP("fringe/mugs", recording);
    const auto gamma = estimate_gamma(phase_of(recording, std::nullopt), kPhases_rad);
    ASSERT_TRUE(gamma) << gamma.error().message;
    auto relative = RelativeDepth::create(recording.size());
    ASSERT_TRUE(relative);
    const auto measured = relative->measure(phase_of(recording, *gamma));
    ASSERT_TRUE(measured) << measured.error().message;
    const Image<float>& height = relative->height_rad();
    const auto percentile_in = [&](const cv::Rect& part, double share) {
        std::vector<float> heights;
        for (int y = part.y; y < part.y + part.height; ++y) {
            std::copy_if(height.row(y) + part.x, height.row(y) + part.x + part.width,
                         std::back_inserter(heights), [](float h) { return std::isfinite(h); });
        }
        EXPECT_GT(heights.size(), static_cast<std::size_t>(part.area()) / 2);
        std::sort(heights.begin(), heights.end());
        return heights[static_cast<std::size_t>(share * static_cast<double>(heights.size() - 1))];
    };
    const cv::Rect wall(800, 60, 900, 200);
    EXPECT_NEAR(percentile_in(wall, 0.5), 0.0F, 0.2F);
    EXPECT_LT(percentile_in(wall, 0.99) - percentile_in(wall, 0.01), 0.8F);
    const cv::Rect mug(500, 560, 330, 400);
    EXPECT_GT(percentile_in(mug, 0.9) - percentile_in(mug, 0.1), 3.0F);
}

struct Moving {
    const char* name;
    int first, last;  // frames of the stroke
    double off, missing;
};
class MovingHands : public testing::TestWithParam<Moving> {};

/// Mean of the frames of the stroke; truth is that of the frame which the depth is registered to.
HandScore judge_stroke(const test::RecordingOnDisk& recording, const Moving& stroke,
                       MotionHandling motion) {
    DecodeSettings settings;
    settings.motion = motion;
    auto decoder =
        DepthDecoder::create(recording.rig, recording.patterns, recording.size(), settings);
    HandScore sum;
    double frames = 0.0;
    for (const FramePtr& frame : recording.frames) {
        const auto number = static_cast<int>(frame->sequence);
        if (decoder->push(frame).state != DecodeState::depth_ready || number < stroke.first ||
            number > stroke.last) {
            continue;
        }
        const auto seen = static_cast<int>(decoder->depth().sequence);
        const HandScore score = judge(recording, decoder->depth(), seen, 0, 20.0);
        sum.off += score.off;
        sum.missing += score.missing;
        sum.rms_mm += score.rms_mm;
        frames += 1.0;
    }
    const HandScore mean{sum.rms_mm / frames, sum.off / frames, sum.missing / frames};
    std::printf("%s, motion %s: RMS %.1f mm, off %.1f %%, missing %.1f %%\n", stroke.name,
                motion == MotionHandling::follow ? "followed" : "as it comes", mean.rms_mm,
                100.0 * mean.off, 100.0 * mean.missing);
    return mean;
}

TEST_P(MovingHands, StayWholeWhileTheyMove) {
    LOAD_OR_SKIP(GetParam().name, recording);
    const HandScore plain = judge_stroke(recording, GetParam(), MotionHandling::off);
    const HandScore followed = judge_stroke(recording, GetParam(), MotionHandling::follow);
    EXPECT_LE(followed.off, GetParam().off);
    EXPECT_LE(followed.missing, GetParam().missing);
    EXPECT_LT(followed.off, 0.25 * plain.off);
}

INSTANTIATE_TEST_SUITE_P(Rendered, MovingHands,
                         testing::Values(Moving{"rendered/grey-swipe-left-60", 27, 64, 0.08, 0.15},
                                         Moving{"rendered/swipe-left-dual-60", 12, 45, 0.10,
                                                0.30}));

// Corrections for a hand that comes nearer, too: unwrapping takes what is beyond for no phase.
TEST(PhasesOfWhatMoves, StayWithinHalfATurn) {
    LOAD_OR_SKIP("rendered/push-three-60", recording);
    DecodeSettings settings;
    settings.order = OrderSource::none;
    settings.keep_maps = true;
    auto made = DepthDecoder::create(recording.rig, recording.patterns, recording.size(), settings);
    ASSERT_TRUE(made) << made.error().message;
    float most = 0.0F;
    for (const FramePtr& frame : recording.frames) {
        if (made->push(frame).state != DecodeState::depth_ready) {
            continue;
        }
        const Image<float>& phase = made->phase().phase_rad;
        for (int y = 0; y < phase.height(); ++y) {
            for (int x = 0; x < phase.width(); ++x) {
                most = std::max(most, std::fabs(phase.at(x, y)));  // NaN is passed over
            }
        }
    }
    EXPECT_LE(most, 3.141593F);
    EXPECT_GT(most, 3.14F);
}

}  // namespace
}  // namespace xtrack
