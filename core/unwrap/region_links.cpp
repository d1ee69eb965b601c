// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/region_links.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <tuple>

namespace xtrack {
namespace {

/// Fewer pixels are a fragment: broken off by noise, not a surface of its own.
constexpr std::uint32_t kFragmentPixels = 64;
constexpr std::uint32_t kClearVotes = 16 * kSoundVotes;
constexpr double kClearSupport = 0.9;
constexpr std::uint32_t kFairVotes = 4 * kSoundVotes;
constexpr double kFairSupport = 0.75;
bool is_supported(const RegionLink& link, double support) noexcept {
    return static_cast<double>(link.votes) >= support * kSoundVotes * link.contact;
}

/// Speaks for itself, whatever else there is.
bool is_clear(const RegionLink& link) noexcept {
    return link.votes >= kClearVotes && is_supported(link, kClearSupport);
}

std::size_t hash(const RegionLink& link) noexcept {
    // Multiplicative hashing of both nodes; the order is left out, so that one hash serves both
    // kinds of sameness.
    std::uint64_t h = (std::uint64_t{link.a} << 32U | link.b) * 0x9E3779B97F4A7C15U;
    return static_cast<std::size_t>(h ^ h >> 32U);
}

bool same_regions(const RegionLink& x, const RegionLink& y) noexcept {
    return x.a == y.a && x.b == y.b;
}

bool same_link(const RegionLink& x, const RegionLink& y) noexcept {
    return same_regions(x, y) && x.order == y.order;
}

/// @return the link between the roots, the lesser one first; a == b where they are one set
RegionLink between_roots(OrderForest& forest, RegionLink link) noexcept {
    const OrderForest::Place a = forest.find(link.a);
    const OrderForest::Place b = forest.find(link.b);
    link.order += a.order - b.order;
    link.a = a.root;
    link.b = b.root;
    if (link.a > link.b) {
        std::swap(link.a, link.b);
        link.order = -link.order;
    }
    return link;
}

void count_in(RegionLink& sum, const RegionLink& link) noexcept {
    sum.votes += link.votes;
    sum.contact += link.contact;
}

}  // namespace

/// What a round may join: the strongest bonds first, and doubtful ones only when all clear ones
/// have been taken and counted.
struct RegionLinks::Level {
    std::uint32_t min_votes;
    double support;
};

void RegionLinks::reserve(std::size_t count) {
    links_.reserve(count);
    pairs_.reserve(count);
    table_.reserve(std::bit_ceil(2 * count + 1));
}

void RegionLinks::add(OrderForest& forest, RegionLink link) {
    link = between_roots(forest, link);
    if (link.a == link.b) {
        return;
    }
    if (is_clear(link)) {
        forest.join(link.a, link.b, link.order);
    } else if (!links_.empty() && same_link(links_.back(), link)) {
        // Contacts come along borders, so most are with the same two regions as the one before.
        count_in(links_.back(), link);
    } else {
        links_.push_back(link);
    }
}

void RegionLinks::join_all(OrderForest& forest, double support) {
    for (const Level& level :
         {Level{kClearVotes, std::max(support, kClearSupport)},
          Level{kFairVotes, std::max(support, kFairSupport)}, Level{1, support}}) {
        while (join_round(forest, level)) {
        }
    }
}

bool RegionLinks::join_round(OrderForest& forest, const Level& level) {
    resolve(forest);
    rank(level.min_votes);
    bool joined = false;
    for (const RegionLink& pair : pairs_) {
        const RegionLink now = between_roots(forest, pair);
        if (now.a == now.b) {
            continue;
        }
        const bool surfaces =
            forest.pixels(now.a) >= kFragmentPixels && forest.pixels(now.b) >= kFragmentPixels;
        // What was counted before one of them was joined to something else says little of the
        // whole, unless it is much: the rest waits for the next round.
        const bool enough =
            same_regions(now, pair) ? is_supported(pair, level.support) : is_clear(pair);
        if (surfaces && !enough) {
            continue;
        }
        forest.join(now.a, now.b, now.order);
        joined = true;
    }
    return joined;
}

/// Moves the links to the present roots, drops those within one set, and counts equal ones as one.
void RegionLinks::resolve(OrderForest& forest) {
    std::size_t kept = 0;
    for (const RegionLink& link : links_) {
        const RegionLink now = between_roots(forest, link);
        if (now.a == now.b) {
            continue;
        }
        if (kept > 0 && same_link(links_[kept - 1], now)) {
            count_in(links_[kept - 1], now);
        } else {
            links_[kept++] = now;
        }
    }
    links_.resize(kept);
    gather(links_, pairs_, same_link, count_in);
    links_.swap(pairs_);
}

/// Of each two regions the order with the most votes, with their whole contact; most votes first.
void RegionLinks::rank(std::uint32_t min_votes) {
    gather(links_, pairs_, same_regions, [](RegionLink& best, const RegionLink& link) {
        if (std::tie(link.votes, best.order) > std::tie(best.votes, link.order)) {
            best.votes = link.votes;
            best.order = link.order;
        }
        best.contact += link.contact;
    });
    std::erase_if(pairs_, [&](const RegionLink& pair) { return pair.votes < min_votes; });
    std::sort(pairs_.begin(), pairs_.end(), [](const RegionLink& x, const RegionLink& y) {
        return std::tie(y.votes, x.a, x.b) < std::tie(x.votes, y.a, y.b);
    });
}

template <typename Same, typename Merge>
void RegionLinks::gather(const std::vector<RegionLink>& from, std::vector<RegionLink>& into,
                         Same same, Merge merge) {
    constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();
    const std::size_t slots = std::bit_ceil(2 * from.size() + 1);
    table_.assign(slots, kFree);
    into.clear();
    for (const RegionLink& link : from) {
        std::size_t slot = hash(link) & (slots - 1);
        while (table_[slot] != kFree && !same(into[table_[slot]], link)) {
            slot = (slot + 1) & (slots - 1);
        }
        if (table_[slot] == kFree) {
            table_[slot] = static_cast<std::uint32_t>(into.size());
            into.push_back(link);
        } else {
            merge(into[table_[slot]], link);
        }
    }
}

}  // namespace xtrack
