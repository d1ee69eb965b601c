// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <xtrack/depth_decoder.hpp>
#include <xtrack/method.hpp>
#include <xtrack/sim.hpp>

namespace xtrack {
namespace {

constexpr int kEroded_px = 2;

bool within_hand(const SimTruth& truth, int x, int y) {
    for (int j = y - kEroded_px; j <= y + kEroded_px; ++j) {
        for (int i = x - kEroded_px; i <= x + kEroded_px; ++i) {
            if (i < 0 || j < 0 || i >= truth.mask.width() || j >= truth.mask.height() ||
                truth.mask.at(i, j) != static_cast<std::uint8_t>(SimPart::hand)) {
                return false;
            }
        }
    }
    return true;
}

// Fingers are as narrow as the cells in which surfaces are told apart, and the clothes and the face
// behind them have other colours: they must not be taken for one of these.
TEST(ColourHand, FingersAreAsRightAsThePalm) {
    auto settings = *SimSettings::preset("ideal-60");
    settings.camera.colour = true;
    settings.script = {{.action = SimAction::idle}};
    settings.patterns = *method_sequence(Method::rgb, settings.rig, Axis::y);
    auto source = SimulatedRig::create(settings);
    ASSERT_TRUE(source) << source.error().message;
    auto decoder =
        DepthDecoder::create(settings.rig, settings.patterns, settings.rig.camera.size, {});
    ASSERT_TRUE(decoder) << decoder.error().message;
    int pixels = 0;
    int off = 0;
    double sum = 0.0;
    for (int n = 0; n < 20; ++n) {
        const FrameSource::Item item = (*source)->next({});
        ASSERT_TRUE(item.frame);
        if (decoder->push(item.frame).state != DecodeState::depth_ready || n < 15) {
            continue;
        }
        const SimTruth& truth = (*source)->truth();
        for (int y = 0; y < truth.depth.height(); ++y) {
            for (int x = 0; x < truth.depth.width(); ++x) {
                if (!within_hand(truth, x, y)) {
                    continue;
                }
                const double error_mm =
                    kDepthUnitMm * (decoder->depth().depth.at(x, y) - truth.depth.at(x, y));
                ++pixels;
                off += std::fabs(error_mm) > 3.0 ? 1 : 0;
                sum += std::fabs(error_mm) > 15.0 ? 0.0 : error_mm * error_mm;
            }
        }
    }
    ASSERT_GT(pixels, 20000);
    EXPECT_LT(std::sqrt(sum / pixels), 0.9) << "mm";
    EXPECT_LT(100.0 * off / pixels, 0.6) << "% off by more than 3 mm";
}

}  // namespace
}  // namespace xtrack
