// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/timing.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>

namespace xtrack::tools::bench {

namespace {

// A peer of a second a call would make minutes of a hundred rounds.
constexpr double kLong_us = 50'000.0;
constexpr std::size_t kRoundsPerLongCall = 20;
constexpr unsigned kOrderSeed = 1;

double timed_us(const Contender& contender) {
    using Clock = std::chrono::steady_clock;
    if (contender.prepare) {
        contender.prepare();
    }
    const auto begin = Clock::now();
    contender.run();
    return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

}  // namespace

Times times_of(std::vector<double> durations_us) {
    std::sort(durations_us.begin(), durations_us.end());
    const auto count = static_cast<double>(durations_us.size());
    const auto quantile = [&](double share) {
        return durations_us[static_cast<std::size_t>(std::ceil(share * count)) - 1];
    };
    return {durations_us.size(), quantile(0.5), quantile(0.99), durations_us.front()};
}

std::vector<Measured> measure(const std::vector<Contender>& contenders, std::size_t rounds,
                              const std::function<void()>& step) {
    std::vector<bool> takes_long;
    takes_long.reserve(contenders.size());
    for (const Contender& contender : contenders) {
        takes_long.push_back(timed_us(contender) > kLong_us);
    }
    std::vector<std::vector<double>> durations_us(contenders.size());
    std::vector<std::size_t> order(contenders.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::mt19937 random(kOrderSeed);
    for (std::size_t round = 0; round < rounds; ++round) {
        std::shuffle(order.begin(), order.end(), random);
        for (const std::size_t i : order) {
            if (!takes_long[i] || round % kRoundsPerLongCall == 0) {
                durations_us[i].push_back(timed_us(contenders[i]));
            }
        }
        step();
    }
    std::vector<Measured> all;
    all.reserve(contenders.size());
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        all.push_back({contenders[i].name, contenders[i].instruction_set,
                       times_of(std::move(durations_us[i]))});
    }
    return all;
}

}  // namespace xtrack::tools::bench
