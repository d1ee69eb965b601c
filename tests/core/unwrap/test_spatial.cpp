// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/spatial.hpp"

#include <bit>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/core/decode/each_target.hpp"
#include "tests/core/unwrap/phase_scene.hpp"
#include "tests/support/allocation_counter.hpp"

namespace xtrack {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;

/// An image, and what comes of it.
struct Unwrapped {
    explicit Unwrapped(Size size)
        : phase_rad(size.width, size.height, 0.0F),
          modulation(size.width, size.height, 50.0F),
          unwrapped_rad(size.width, size.height, -77.0F),
          component(size.width, size.height, 77) {}

    void run(const SpatialUnwrapSettings& settings) {
        auto unwrapper = SpatialUnwrapper::create(phase_rad.size(), settings);
        ASSERT_TRUE(unwrapper) << unwrapper.error().message;
        const auto found = unwrapper->unwrap(phase_rad.view(), modulation.view(),
                                             unwrapped_rad.view(), component.view());
        components.assign(found.begin(), found.end());
    }

    Image<float> phase_rad;
    Image<float> modulation;
    Image<float> unwrapped_rad;
    Image<std::uint16_t> component;
    std::vector<PhaseComponent> components;
};

SpatialUnwrapSettings keep_all() {
    SpatialUnwrapSettings settings;
    settings.min_component_px = 1;
    return settings;
}

float wrap(double phase) {
    return static_cast<float>(std::remainder(phase, 2.0 * std::numbers::pi));
}

/// A plane, wrapped; its phase is known but for the turns of the seed.
Unwrapped plane(Size size, double right_rad, double down_rad) {
    Unwrapped image(size);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            image.phase_rad.at(x, y) = wrap(right_rad * x + down_rad * y);
        }
    }
    return image;
}

void expect_plane(const Unwrapped& image, double right_rad, double down_rad) {
    ASSERT_EQ(image.components.size(), 1U);
    const PhaseComponent& all = image.components[0];
    EXPECT_EQ(all.pixels, image.phase_rad.width() * image.phase_rad.height());
    // All modulations are the same, so the first pixel is the seed.
    EXPECT_EQ(all.seed_x_px, 0);
    EXPECT_EQ(all.seed_y_px, 0);
    EXPECT_EQ(all.left_px, 0);
    EXPECT_EQ(all.top_px, 0);
    EXPECT_EQ(all.right_px, image.phase_rad.width() - 1);
    EXPECT_EQ(all.bottom_px, image.phase_rad.height() - 1);
    for (int y = 0; y < image.phase_rad.height(); ++y) {
        for (int x = 0; x < image.phase_rad.width(); ++x) {
            ASSERT_NEAR(image.unwrapped_rad.at(x, y), right_rad * x + down_rad * y, 1e-4)
                << x << ' ' << y;
            ASSERT_EQ(image.component.at(x, y), 1) << x << ' ' << y;
        }
    }
}

TEST(Spatial, PlanesOfAnySlopeAndSizeAreExact) {
    for (const Size size : {Size{130, 40}, Size{64, 5}, Size{65, 3}, Size{200, 1}, Size{1, 200},
                            Size{2, 2}, Size{63, 64}}) {
        for (const double right_rad : {0.31, -1.9, 2.6}) {
            SCOPED_TRACE(testing::Message()
                         << size.width << " x " << size.height << " " << right_rad);
            Unwrapped image = plane(size, right_rad, -0.4);
            // In two pixels a steep slope and a depth step are the same.
            SpatialUnwrapSettings settings = keep_all();
            settings.step_limit_rad = 3.1;
            image.run(settings);
            expect_plane(image, right_rad, -0.4);
        }
    }
}

TEST(Spatial, OnePixelKeepsItsPhase) {
    Unwrapped image({1, 1});
    image.phase_rad.at(0, 0) = 2.5F;
    image.run(keep_all());
    ASSERT_EQ(image.components.size(), 1U);
    EXPECT_EQ(image.components[0].pixels, 1);
    EXPECT_EQ(image.unwrapped_rad.at(0, 0), 2.5F);
    EXPECT_EQ(image.component.at(0, 0), 1);
}

TEST(Spatial, WhatIsNoPhaseIsMasked) {
    const float infinite = std::numeric_limits<float>::infinity();
    for (const float none : {kNone, infinite, -infinite, 4.0F, -3.5F}) {
        Unwrapped image({70, 9});
        image.phase_rad.fill(none);
        image.run(keep_all());
        EXPECT_TRUE(image.components.empty());
        for (int y = 0; y < 9; ++y) {
            for (int x = 0; x < 70; ++x) {
                ASSERT_TRUE(std::isnan(image.unwrapped_rad.at(x, y)));
                ASSERT_EQ(image.component.at(x, y), 0);
            }
        }
    }
}

TEST(Spatial, PixelsOfACheckerboardAreAlone) {
    Unwrapped image({66, 6});
    for (int y = 0; y < 6; ++y) {
        for (int x = 0; x < 66; ++x) {
            image.phase_rad.at(x, y) = (x + y) % 2 == 0 ? 0.01F * static_cast<float>(x) : kNone;
        }
    }
    image.run(keep_all());
    ASSERT_EQ(image.components.size(), 198U);
    for (const PhaseComponent& component : image.components) {
        EXPECT_EQ(component.pixels, 1);
        EXPECT_EQ(component.left_px, component.right_px);
        EXPECT_EQ(image.component.at(component.seed_x_px, component.seed_y_px), component.id);
        EXPECT_EQ(image.unwrapped_rad.at(component.seed_x_px, component.seed_y_px),
                  image.phase_rad.at(component.seed_x_px, component.seed_y_px));
    }
    image.run({});
    EXPECT_TRUE(image.components.empty());
}

TEST(Spatial, ComponentsAreListedBySizeWithSeedAndBox) {
    Unwrapped image = plane({100, 30}, 0.4, 0.1);
    for (int y = 0; y < 30; ++y) {
        image.phase_rad.at(40, y) = kNone;
    }
    for (int x = 0; x < 40; ++x) {
        image.phase_rad.at(x, 28) = kNone;
    }
    image.modulation.at(70, 20) = 80.0F;
    image.modulation.at(10, 11) = 60.0F;
    image.modulation.at(12, 13) = std::numeric_limits<float>::infinity();
    image.modulation.at(40, 3) = 99.0F;  // masked
    SpatialUnwrapSettings settings;
    settings.min_component_px = 41;
    image.run(settings);
    ASSERT_EQ(image.components.size(), 2U);
    const PhaseComponent& right = image.components[0];
    EXPECT_EQ(right.id, 1);
    EXPECT_EQ(right.pixels, 59 * 30);
    EXPECT_EQ(right.seed_x_px, 70);
    EXPECT_EQ(right.seed_y_px, 20);
    EXPECT_EQ(right.left_px, 41);
    EXPECT_EQ(right.right_px, 99);
    EXPECT_EQ(right.bottom_px, 29);
    const PhaseComponent& left = image.components[1];
    EXPECT_EQ(left.id, 2);
    EXPECT_EQ(left.pixels, 40 * 28);
    EXPECT_EQ(left.seed_x_px, 10);
    EXPECT_EQ(left.seed_y_px, 11);
    EXPECT_EQ(left.right_px, 39);
    EXPECT_EQ(left.bottom_px, 27);
    // The row below the gap is too small.
    EXPECT_EQ(image.component.at(5, 29), 0);
    EXPECT_TRUE(std::isnan(image.unwrapped_rad.at(5, 29)));
    EXPECT_EQ(image.component.at(39, 27), 2);
    // A seed keeps its phase, and all others follow it.
    const float seed = image.phase_rad.at(70, 20);
    EXPECT_EQ(image.unwrapped_rad.at(70, 20), seed);
    EXPECT_NEAR(image.unwrapped_rad.at(41, 2), seed + 0.4F * (41 - 70) + 0.1F * (2 - 20), 1e-4);
    EXPECT_EQ(image.unwrapped_rad.at(10, 11), image.phase_rad.at(10, 11));
}

TEST(Spatial, AStepWiderThanTheNoisePartsTwoSurfaces) {
    Unwrapped image = plane({160, 60}, 0.3, 0.0);
    for (int y = 0; y < 60; ++y) {
        for (int x = 90; x < 160; ++x) {
            image.phase_rad.at(x, y) = wrap(0.3 * x + 2.0);
        }
    }
    image.run({});
    ASSERT_EQ(image.components.size(), 2U);
    EXPECT_EQ(image.components[0].pixels, 90 * 60);
    EXPECT_EQ(image.components[1].pixels, 70 * 60);
    EXPECT_NE(image.component.at(89, 30), image.component.at(90, 30));
}

TEST(Spatial, SettingsOutOfRangeAreNamed) {
    const auto message = [](SpatialUnwrapSettings settings) {
        const auto made = SpatialUnwrapper::create({8, 8}, settings);
        return made ? std::string() : made.error().message;
    };
    SpatialUnwrapSettings settings;
    EXPECT_EQ(message(settings), "");
    for (const double bad : {0.0, 0.05, 3.15, std::numbers::pi, -1.0, std::nan("")}) {
        settings.step_limit_rad = bad;
        EXPECT_NE(message(settings).find("step_limit_rad"), std::string::npos) << bad;
    }
    settings = {};
    for (const double bad : {-0.1, 1.1, std::nan("")}) {
        settings.min_support = bad;
        EXPECT_NE(message(settings).find("min_support"), std::string::npos) << bad;
    }
    settings = {};
    for (const int bad : {0, -5, kMaxImagePixels + 1}) {
        settings.min_component_px = bad;
        EXPECT_NE(message(settings).find("min_component_px"), std::string::npos) << bad;
    }
    for (const Size size : {Size{0, 4}, Size{4, -1}, Size{kMaxImageSide_px + 1, 1}}) {
        EXPECT_FALSE(SpatialUnwrapper::create(size, {}));
    }
}

TEST(Spatial, ImagesOfAnotherSizeAreLeftAlone) {
    Unwrapped image({20, 20});
    auto unwrapper = SpatialUnwrapper::create({20, 21}, keep_all());
    ASSERT_TRUE(unwrapper);
    EXPECT_TRUE(unwrapper
                    ->unwrap(image.phase_rad.view(), image.modulation.view(),
                             image.unwrapped_rad.view(), image.component.view())
                    .empty());
    EXPECT_EQ(image.unwrapped_rad.at(3, 3), -77.0F);
    EXPECT_EQ(image.component.at(3, 3), 77);
}

TEST(Spatial, OutputMayBeTheInput) {
    Unwrapped image = plane({100, 20}, 0.5, 0.2);
    auto unwrapper = SpatialUnwrapper::create({100, 20}, keep_all());
    ASSERT_TRUE(unwrapper);
    const auto found = unwrapper->unwrap(image.phase_rad.view(), image.modulation.view(),
                                         image.phase_rad.view(), image.component.view());
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(image.phase_rad.at(99, 19), 0.5F * 99 + 0.2F * 19, 1e-4F);
}

TEST(Spatial, EveryInstructionSetGivesTheSameBits) {
    const auto scene = test::make_phase_scene(test::PhaseSceneKind::bands, 4, {200, 120}, 10.0);
    auto unwrapper = SpatialUnwrapper::create({200, 120}, keep_all());
    ASSERT_TRUE(unwrapper);
    Image<float> first(200, 120, 0.0F);
    test::for_each_target([&] {
        Image<float> unwrapped(200, 120);
        Image<std::uint16_t> component(200, 120);
        const auto found = unwrapper->unwrap(scene.phase_rad.view(), scene.modulation.view(),
                                             unwrapped.view(), component.view());
        ASSERT_FALSE(found.empty());
        for (int y = 0; y < 120; ++y) {
            for (int x = 0; x < 200; ++x) {
                const auto bits = std::bit_cast<std::uint32_t>(unwrapped.at(x, y));
                if (first.at(0, 0) != 0.0F) {
                    ASSERT_EQ(bits, std::bit_cast<std::uint32_t>(first.at(x, y))) << x << ' ' << y;
                }
            }
        }
        first = unwrapped;
    });
}

TEST(Spatial, UnwrappingAllocatesNothing) {
    if (!test::counts_allocations()) {
        GTEST_SKIP()
            << "allocations cannot be counted here: no glibc, or a sanitizer is in its way";
    }
    std::vector<test::PhaseScene> scenes;
    for (const auto kind : {test::PhaseSceneKind::hand, test::PhaseSceneKind::salt}) {
        scenes.push_back(test::make_phase_scene(kind, 3, {160, 120}, 8.0, 40.0));
    }
    auto unwrapper = SpatialUnwrapper::create({160, 120}, keep_all());
    ASSERT_TRUE(unwrapper);
    Image<float> unwrapped(160, 120);
    Image<std::uint16_t> component(160, 120);
    const long before = test::allocations();
    std::size_t components = 0;
    for (const auto& scene : scenes) {
        components += unwrapper
                          ->unwrap(scene.phase_rad.view(), scene.modulation.view(),
                                   unwrapped.view(), component.view())
                          .size();
    }
    EXPECT_EQ(test::allocations() - before, 0);
    EXPECT_GT(components, 2U);
}

TEST(Spatial, WhatIsAskedOfAPixelIsWhatItsRowIsWritten) {
    const auto scene = test::make_phase_scene(test::PhaseSceneKind::hand, 3);
    const Size size = scene.phase_rad.size();
    auto made = SpatialUnwrapper::create(size, {});
    ASSERT_TRUE(made);
    const auto found = made->solve(scene.phase_rad.view(), scene.modulation.view());
    ASSERT_GE(found.size(), 2U);
    std::vector<std::int32_t> turns(found.size());
    for (std::size_t i = 0; i < turns.size(); ++i) {
        turns[i] = 3 * static_cast<std::int32_t>(i) - 2;
    }
    std::vector<float> unwrapped(static_cast<std::size_t>(size.width));
    std::vector<std::uint16_t> component(unwrapped.size());
    int known = 0;
    for (int y = 0; y < size.height; y += 5) {
        made->write_row(y, scene.phase_rad.row(y), turns, unwrapped.data(), component.data());
        for (int x = 0; x < size.width; ++x) {
            const auto i = static_cast<std::size_t>(x);
            const PhasePlace place = made->place(x, y);
            ASSERT_EQ(place.component, component[i]);
            if (place.component == 0) {
                ASSERT_TRUE(std::isnan(unwrapped[i]));
                continue;
            }
            const int order = place.turns + turns[place.component - 1U];
            ASSERT_NEAR(
                unwrapped[i],
                static_cast<double>(scene.phase_rad.at(x, y)) + 2.0 * std::numbers::pi * order,
                1e-4);
            ++known;
        }
    }
    EXPECT_GT(known, 40000);
}

TEST(Spatial, SettingsChangeBetweenImages) {
    const auto scene = test::make_phase_scene(test::PhaseSceneKind::hand, 3);
    auto made = SpatialUnwrapper::create(scene.phase_rad.size(), {});
    ASSERT_TRUE(made);
    ASSERT_GE(made->solve(scene.phase_rad.view(), scene.modulation.view()).size(), 2U);
    SpatialUnwrapSettings settings;
    settings.min_component_px = 100000;
    ASSERT_TRUE(made->set_settings(settings));
    EXPECT_EQ(made->solve(scene.phase_rad.view(), scene.modulation.view()).size(), 1U);
    settings.min_support = 2.0;
    EXPECT_FALSE(made->set_settings(settings));
}

}  // namespace
}  // namespace xtrack
