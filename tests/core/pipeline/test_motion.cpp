// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <xtrack/depth_decoder.hpp>

#include "core/pipeline/frame_window.hpp"
#include "tests/core/pipeline/plane_scene.hpp"

namespace xtrack {
namespace {

using test::plane_frame;
using test::plane_rig;

PatternSequence wide() { return three_step_sequence(Axis::x, {512, 384}, 512.0); }

// What a camera's pool does: frames that are lent in turn, whose pixels are not what they were once
// they are given back.
class NineFrames {
 public:
    FramePtr lend(const Frame& content) {
        Frame& frame = frames_[next_++ % frames_.size()];
        frame = content;
        return {&frame, [](Frame* back) { back->pixels.fill(255); }};
    }

 private:
    std::array<Frame, 9> frames_;
    std::size_t next_ = 0;
};

TEST(Motion, AFrameIsNotTakenForTheOneThatLayThereBefore) {
    const Rig rig = plane_rig();
    FrameWindow window(3);
    MotionEstimator motion(rig.camera.size, 3, {});
    int pushed = 0;
    const auto push = [&](int pattern, Frame& place, double z_mm, int row_begin, int row_end) {
        place = *plane_frame(rig, wide(), pattern, pushed++, z_mm);
        place.clean_row_begin = row_begin;
        place.clean_row_end = row_end;
        const FramePtr frame(&place, [](const Frame*) {});
        window.push(frame);
        motion.update(window, *frame);
    };
    std::array<Frame, 2> other;
    const auto show_another = [&] {
        for (int n = 0; n < 100; ++n) {
            push(1, other[static_cast<std::size_t>(n % 2)], 700.0, 0, 64);
        }
    };
    // Two shows of two images each, with the scene's one change between. The next show, of one
    // image, frees the places of the first; the one after that lies where its second image was.
    std::array<Frame, 6> places;
    push(0, places[0], 600.0, 0, 32);
    push(0, places[1], 600.0, 32, 64);
    show_another();
    push(0, places[2], 700.0, 0, 32);
    push(0, places[3], 700.0, 32, 64);
    EXPECT_TRUE(motion.row_disturbed(5));
    show_another();
    push(0, places[4], 700.0, 0, 64);
    show_another();
    push(0, places[1], 700.0, 0, 64);
    show_another();
    push(0, places[5], 700.0, 0, 64);
    for (int cx = 0; cx < motion.cells_x(); ++cx) {
        EXPECT_FALSE(motion.disturbed(cx, 5)) << cx;
    }
}

TEST(Motion, ReadsNoFrameThatTheWindowGaveBack) {
    NineFrames lent;
    std::vector<FramePtr> kept;
    auto from_lent = DepthDecoder::create(plane_rig(), wide(), plane_rig().camera.size, {});
    auto from_kept = DepthDecoder::create(plane_rig(), wide(), plane_rig().camera.size, {});
    ASSERT_TRUE(from_lent && from_kept);
    for (int n = 0; n < 15; ++n) {
        const auto frame =
            plane_frame(plane_rig(), wide(), n % 3, n, 600.0 + 30.0 * std::min(n, 8));
        // From here on all have one stamp, and no two can be compared.
        frame->stamp = Stamp::from_us(10000 * std::min(n, 8));
        kept.push_back(frame);
        from_kept->push(frame);
        from_lent->push(lent.lend(*frame));
        for (int y = 0; y < from_kept->depth().depth.height(); ++y) {
            const std::uint16_t* expected = from_kept->depth().depth.row(y);
            ASSERT_TRUE(std::equal(expected, expected + 96, from_lent->depth().depth.row(y)))
                << "frame " << n << " row " << y;
        }
    }
}

// A card before a wall, with a texture of its own, that moves along the axis the fringes change
// along, and nearer.
class SlidingCard {
 public:
    static constexpr double kWall_mm = 1000.0;
    static constexpr int kWidth_px = 60;
    static constexpr int kHeight_px = 64;

    SlidingCard(int step_px, double nearer_mm, int down_px = 0)
        : step_px_(step_px), nearer_mm_(nearer_mm), down_px_(down_px) {}

    [[nodiscard]] static Rig rig() {
        Rig rig = plane_rig({192, 96});
        rig.camera.matrix(0, 0) = 240.0;
        rig.camera.matrix(1, 1) = 240.0;
        rig.projector_from_camera_T.x() = 200.0;
        return rig;
    }
    // Unique from 400 to 1200 mm, and fine enough that a cycle's move shows.
    [[nodiscard]] static PatternSequence patterns() {
        return three_step_sequence(Axis::x, {512, 384}, 140.0);
    }
    // The share of the card's inner pixels whose depth is right in the image of frame n.
    [[nodiscard]] double close_share(const DepthFrame& depth, int n) const {
        constexpr int kEdge_px = 4;
        int all = 0;
        int close = 0;
        for (int y = kEdge_px; y < kHeight_px - kEdge_px; ++y) {
            for (int x = kEdge_px; x < kWidth_px - kEdge_px; ++x) {
                const double seen_mm =
                    depth.depth.at(left_px(n) + x, top_px(n) + y) * depth.depth_unit_mm;
                ++all;
                close += std::abs(seen_mm - z_mm(n)) < 20.0 ? 1 : 0;
            }
        }
        return static_cast<double>(close) / all;
    }
    [[nodiscard]] int left_px(int n) const { return 70 + step_px_ * (n - 9); }
    [[nodiscard]] int top_px(int n) const { return 16 + down_px_ * (n - 8); }
    [[nodiscard]] double z_mm(int n) const { return 700.0 - nearer_mm_ * n; }
    [[nodiscard]] FramePtr frame(int n) const { return frame(n, n % 3); }
    [[nodiscard]] std::shared_ptr<Frame> frame(int n, int pattern) const {
        auto seen = plane_frame(rig(), patterns(), pattern, n, kWall_mm);
        const auto card = plane_frame(rig(), patterns(), pattern, n, z_mm(n));
        for (int y = 0; y < kHeight_px; ++y) {
            for (int x = 0; x < kWidth_px; ++x) {
                // Blotches of some pixels, such as skin and the gaps of fingers have.
                const bool dark = ((x / 7) * 5 + (y / 9) * 3) % 4 == 0;
                const int at = left_px(n) + x;
                std::uint8_t& pixel = seen->pixels.at(at, top_px(n) + y);
                pixel = static_cast<std::uint8_t>(
                    std::lround((dark ? 0.7 : 1.0) * card->pixels.at(at, top_px(n) + y)));
            }
        }
        return seen;
    }

 private:
    int step_px_;
    double nearer_mm_;
    int down_px_;
};

struct Slide {
    int step_px;
    double nearer_mm;
};
class Slides : public testing::TestWithParam<Slide> {};

TEST_P(Slides, AlongTheFringesAreFollowedToTheNewestFrame) {
    const SlidingCard card(GetParam().step_px, GetParam().nearer_mm);
    const Rig rig = SlidingCard::rig();
    auto decoder = DepthDecoder::create(rig, SlidingCard::patterns(), rig.camera.size, {});
    ASSERT_TRUE(decoder) << decoder.error().message;
    constexpr int kFrames = 15;
    for (int n = 0; n < kFrames; ++n) {
        decoder->push(card.frame(n));
    }
    const DepthFrame& depth = decoder->depth();
    ASSERT_EQ(depth.sequence, static_cast<std::uint64_t>(kFrames - 1));
    EXPECT_GT(card.close_share(depth, kFrames - 1), 0.9);
}

INSTANTIATE_TEST_SUITE_P(Motion, Slides,
                         testing::Values(Slide{0, 0.0}, Slide{3, 0.0}, Slide{-3, 0.0},
                                         Slide{5, 0.0}, Slide{6, 0.0}, Slide{7, 0.0},
                                         Slide{0, 10.0}, Slide{2, 8.0}));

// Which frame of a show that lasts two sees the switch of patterns, in all rows of the card.
enum class Switch { first, last };
struct HeldSlide {
    Switch seen_by;
    int step_px;
    int down_px;
    double close;  // share of the card that must be right
};
class HeldSlides : public testing::TestWithParam<HeldSlide> {
 protected:
    // Frame n of a stream in which every pattern is held for two. The share of the frame's own
    // pattern grows, or falls, from row to row.
    [[nodiscard]] static FramePtr frame(const SlidingCard& card, int n, Switch seen_by) {
        constexpr int kCleanRows = 8;
        const int pattern = n / 2 % 3;
        const auto seen = card.frame(n, pattern);
        const int height = seen->pixels.height();
        const bool first = seen_by == Switch::first;
        if ((n % 2 == 0) != first) {
            return seen;
        }
        const auto other = card.frame(n, (pattern + (first ? 2 : 1)) % 3);
        const int blended = height - kCleanRows;
        for (int y = 0; y < blended; ++y) {
            const double share = 0.4 + 0.6 * (y + 0.5) / blended;
            const int row = first ? y : height - 1 - y;
            for (int x = 0; x < seen->pixels.width(); ++x) {
                std::uint8_t& pixel = seen->pixels.at(x, row);
                pixel = static_cast<std::uint8_t>(
                    std::lround(share * pixel + (1.0 - share) * other->pixels.at(x, row)));
            }
        }
        seen->clean_row_begin = first ? blended : 0;
        seen->clean_row_end = first ? height : kCleanRows;
        return seen;
    }
};

TEST_P(HeldSlides, AreFollowedByRowsThatSawTheSwitch) {
    const SlidingCard card(GetParam().step_px, 0.0, GetParam().down_px);
    const Rig rig = SlidingCard::rig();
    auto decoder = DepthDecoder::create(rig, SlidingCard::patterns(), rig.camera.size, {});
    ASSERT_TRUE(decoder) << decoder.error().message;
    int judged = 0;
    for (int n = 0; n < 16; ++n) {
        decoder->push(frame(card, n, GetParam().seen_by));
        // From when the move is known throughout, in frames that saw one pattern.
        if (n >= 12 && (n % 2 == 0) != (GetParam().seen_by == Switch::first)) {
            EXPECT_GT(card.close_share(decoder->depth(), n), GetParam().close) << n;
            ++judged;
        }
    }
    EXPECT_EQ(judged, 2);
}

// Along the fringes the images of one pattern match best a little short of the move.
INSTANTIATE_TEST_SUITE_P(
    Motion, HeldSlides,
    testing::Values(HeldSlide{Switch::first, 0, 0, 0.9}, HeldSlide{Switch::first, 0, 2, 0.9},
                    HeldSlide{Switch::first, 0, -2, 0.9}, HeldSlide{Switch::last, 0, 2, 0.9},
                    HeldSlide{Switch::last, 0, -2, 0.9}, HeldSlide{Switch::first, 2, 0, 0.55},
                    HeldSlide{Switch::last, -2, 0, 0.55}));

// A bright stripe on black that moves down the image.
std::shared_ptr<Frame> stripe_frame(const Rig& rig, int n, int top) {
    auto frame = plane_frame(rig, wide(), n % 3, n, 700.0);
    for (int y = 0; y < frame->pixels.height(); ++y) {
        if (y < top || y >= top + 24) {
            std::fill_n(frame->pixels.row(y), frame->pixels.width(), std::uint8_t{0});
        }
    }
    return frame;
}

TEST(Motion, ImagesMayBeNarrowerThanACell) {
    const Rig rig = plane_rig({4, 96});
    auto decoder = DepthDecoder::create(rig, wide(), rig.camera.size, {});
    ASSERT_TRUE(decoder) << decoder.error().message;
    for (int n = 0; n < 18; ++n) {
        const DecodeStatus status = decoder->push(stripe_frame(rig, n, 10 + 2 * n));
        EXPECT_EQ(status.state, n < 2 ? DecodeState::need_more : DecodeState::depth_ready);
    }
}

TEST(Motion, StampsThatAreAgesApartOrAllButEqualAreBorne) {
    const Rig rig = plane_rig({64, 96});
    constexpr int kFarthest_px = 4 * kMaxImageSide_px;
    int far = 0;
    for (const int first_of_late : {4, 7, 8, 9, 10}) {
        FrameWindow window(3);
        MotionEstimator motion(rig.camera.size, 3, {});
        Stamp stamp;
        for (int n = 0; n < 18; ++n) {
            const auto frame = stripe_frame(rig, n, 10 + 2 * n);
            // A nanosecond from image to image, then a century, after which the third pattern is
            // not seen again.
            if (n > first_of_late && n % 3 == 2) {
                continue;
            }
            stamp = stamp + (n == first_of_late ? std::chrono::hours(24 * 36500) : Duration{1});
            frame->stamp = stamp;
            window.push(frame);
            motion.update(window, *frame);
            for (int pattern = 0; pattern < 3; ++pattern) {
                if (const Frame* image = window.newest(pattern)) {
                    // Some images away at most, not somewhere an overflow leads.
                    const float path =
                        std::clamp(motion.path_since(*image).y(), -static_cast<float>(kFarthest_px),
                                   static_cast<float>(kFarthest_px));
                    EXPECT_EQ(motion.to(*image).dy, -static_cast<int>(std::lround(path)));
                    far += std::fabs(path) == static_cast<float>(kFarthest_px) ? 1 : 0;
                }
            }
        }
    }
    EXPECT_GT(far, 0);
}

}  // namespace
}  // namespace xtrack
