// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <xtrack/depth_decoder.hpp>
#include <xtrack/method.hpp>
#include <xtrack/sim.hpp>

#include "core/pipeline/row_team.hpp"

namespace xtrack {
namespace {

TEST(RowTeam, EveryRowIsDoneOnceByOneMemberAtATime) {
    for (const int members : {1, 2, 5}) {
        RowTeam team(members);
        ASSERT_EQ(team.members(), members);
        // Many short jobs: a member that comes late to one must not take rows of the next.
        for (int round = 0; round < 300; ++round) {
            std::array<std::atomic<int>, 100> done{};
            std::array<std::atomic<int>, 5> at_work{};
            std::atomic<bool> alone{true};
            const int begin = round % 7;
            const int end = 100 - round % 3;
            team.run(begin, end, 1 + round % 17, [&](int member, int first, int last) {
                alone = alone && at_work[static_cast<std::size_t>(member)]++ == 0;
                for (int y = first; y < last; ++y) {
                    ++done[static_cast<std::size_t>(y)];
                }
                --at_work[static_cast<std::size_t>(member)];
            });
            ASSERT_TRUE(alone);
            for (int y = 0; y < 100; ++y) {
                ASSERT_EQ(done[static_cast<std::size_t>(y)], y >= begin && y < end ? 1 : 0)
                    << members << " members, round " << round << ", row " << y;
            }
        }
    }
}

TEST(RowTeam, NothingToDoIsDone) {
    RowTeam team(3);
    team.run(7, 7, 16, [](int, int first, int last) { EXPECT_EQ(first, last); });
}

template <typename T>
bool same_bits(const Image<T>& a, const Image<T>& b) {
    for (int y = 0; y < a.height(); ++y) {
        const auto* left = reinterpret_cast<const std::uint8_t*>(a.row(y));
        const auto* right = reinterpret_cast<const std::uint8_t*>(b.row(y));
        if (!std::equal(left, left + static_cast<std::size_t>(a.width()) * sizeof(T), right)) {
            return false;
        }
    }
    return a.size() == b.size();
}

struct Case {
    const char* preset;
    Method method;
};

class Threads : public testing::TestWithParam<Case> {};

// A hand swipes, so that what follows motion is at work as well.
TEST_P(Threads, GiveTheSameBits) {
    auto settings = *SimSettings::preset(GetParam().preset);
    settings.camera.colour = settings.camera.colour || info(GetParam().method).colour;
    settings.script = {{.action = SimAction::swipe_left}};
    settings.duration_s = 0.4;
    auto patterns = method_sequence(GetParam().method, settings.rig, Axis::x);
    ASSERT_TRUE(patterns) << patterns.error().message;
    settings.patterns = *patterns;
    auto source = SimulatedRig::create(settings);
    ASSERT_TRUE(source) << source.error().message;

    std::vector<DepthDecoder> decoders;
    for (const int threads : {1, 2, 3}) {
        DecodeSettings decode;
        decode.keep_maps = true;
        decode.threads = threads;
        auto decoder =
            DepthDecoder::create(settings.rig, settings.patterns, settings.rig.camera.size, decode);
        ASSERT_TRUE(decoder) << decoder.error().message;
        decoders.push_back(*std::move(decoder));
    }
    int depths = 0;
    while (true) {
        const FrameSource::Item item = (*source)->next({});
        if (!item.frame) {
            break;
        }
        std::vector<DecodeState> states;
        states.reserve(decoders.size());
        for (DepthDecoder& decoder : decoders) {
            states.push_back(decoder.push(item.frame).state);
        }
        const DepthDecoder& one = decoders.front();
        depths += states.front() == DecodeState::depth_ready ? 1 : 0;
        for (std::size_t n = 1; n < decoders.size(); ++n) {
            ASSERT_EQ(states[n], states.front());
            ASSERT_TRUE(same_bits(one.depth().depth, decoders[n].depth().depth)) << depths;
            ASSERT_TRUE(same_bits(one.depth().quality, decoders[n].depth().quality)) << depths;
            ASSERT_TRUE(same_bits(one.phase().phase_rad, decoders[n].phase().phase_rad)) << depths;
            ASSERT_TRUE(same_bits(one.sigma_mm(), decoders[n].sigma_mm())) << depths;
        }
    }
    EXPECT_GT(depths, 1);
}

INSTANTIATE_TEST_SUITE_P(Sequences, Threads,
                         testing::Values(Case{"ideal-60", Method::grey},
                                         Case{"ideal-60", Method::dual},
                                         Case{"ideal-60", Method::gray_phase},
                                         Case{"ideal-60", Method::rgb},
                                         Case{"webcam-30", Method::rgb}),
                         [](const auto& test) {
                             std::string name = test.param.preset;
                             name += std::string("_") + xtrack::info(test.param.method).name;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace xtrack
