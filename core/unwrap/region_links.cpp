// SPDX-License-Identifier: Apache-2.0
#include "core/unwrap/region_links.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
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

/// At least half as long as a side of the lesser region: there is not much else to count.
bool is_wide(const RegionLink& link, std::uint32_t lesser_pixels) noexcept {
    return 4 * std::uint64_t{link.contact} * link.contact >= lesser_pixels;
}

/// What two surfaces joined on so many votes must agree on at least: while much is certain, nothing
/// else is taken, and on a few votes fragments alone are joined.
double usual_support(std::uint32_t votes) noexcept {
    return votes >= kClearVotes  ? kClearSupport
           : votes >= kFairVotes ? kFairSupport
                                 : std::numeric_limits<double>::infinity();
}

/// 0 for the most votes, kRanks - 1 for none. The leading bits of the number are its class.
constexpr std::uint32_t kRanks = 256;
std::uint32_t rank_of(std::uint32_t votes) noexcept {
    constexpr int kExactBits = 4;
    const int shift = std::max(static_cast<int>(std::bit_width(votes)) - kExactBits, 0);
    return kRanks - 1 -
           ((static_cast<std::uint32_t>(shift) << (kExactBits - 1)) + (votes >> shift));
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

/// Moves the link to the roots, the lesser one first.
/// @return whether they are two. In place: a copy of what was just written would wait for it.
bool move_to_roots(OrderForest& forest, RegionLink& link) noexcept {
    const OrderForest::Place a = forest.find(link.a);
    const OrderForest::Place b = forest.find(link.b);
    const std::int32_t order = link.order + a.order - b.order;
    const bool swap = a.root > b.root;
    link.a = swap ? b.root : a.root;
    link.b = swap ? a.root : b.root;
    link.order = swap ? -order : order;
    return a.root != b.root;
}

void count_in(RegionLink& sum, const RegionLink& link) noexcept {
    sum.votes += link.votes;
    sum.contact += link.contact;
}

}  // namespace

void RegionLinks::reserve(std::size_t count) {
    links_.reserve(count);
    pairs_.reserve(count);
    ranked_.reserve(count);
    table_.reserve(std::bit_ceil(2 * count + 1));
}

void RegionLinks::add(OrderForest& forest, RegionLink& link) {
    if (!move_to_roots(forest, link)) {
        return;
    }
    // Contacts come along borders, so most are with the same two regions as the one before.
    if (!links_.empty() && same_link(links_.back(), link)) {
        count_in(links_.back(), link);
    } else {
        links_.push_back(link);
    }
}

void RegionLinks::join(OrderForest& forest, RegionLink& link) noexcept {
    if (move_to_roots(forest, link)) {
        forest.join(link.a, link.b, link.order);
    }
}

void RegionLinks::join_all(OrderForest& forest, double support) {
    count_anew(forest);
    std::uint32_t min_votes = pairs_.empty() ? 0 : pairs_.front().votes;
    bool joined = min_votes > 0;
    while (min_votes > 1 || joined) {
        min_votes = std::max(min_votes / (min_votes > kClearVotes ? 2U : 4U), 1U);
        joined = join_ranked(forest, min_votes, std::max(support, usual_support(min_votes)), false);
        // Surfaces part by noise touch in a few places until the fragments between them have been
        // shared out, so they come last.
        if (!joined && min_votes == 1) {
            joined = join_ranked(forest, min_votes, support, true);
        }
        if (joined) {
            count_anew(forest);
        }
    }
}

/// @param last whether two surfaces may be joined by a contact that is short for their size
/// @return whether regions have changed
bool RegionLinks::join_ranked(OrderForest& forest, std::uint32_t min_votes, double support,
                              bool last) {
    bool joined = false;
    for (const RegionLink& pair : pairs_) {
        if (pair.votes < min_votes) {
            break;
        }
        RegionLink now = pair;
        if (!move_to_roots(forest, now)) {
            continue;
        }
        const std::uint32_t lesser_pixels = std::min(forest.pixels(now.a), forest.pixels(now.b));
        if (lesser_pixels >= kFragmentPixels) {
            // What was counted before one of them was joined to something else says little of the
            // whole, unless it is much: the rest waits until it has been counted anew.
            const bool grown = !same_regions(now, pair);
            const bool enough = grown
                                    ? pair.votes >= kClearVotes && is_supported(pair, kClearSupport)
                                    : is_supported(pair, support);
            if (!enough || ((grown || !last) && !is_wide(pair, lesser_pixels))) {
                continue;
            }
        }
        forest.join(now.a, now.b, now.order);
        joined = true;
    }
    return joined;
}

/// Moves the links to the present roots, drops those within one set, counts equal ones as one, and
/// ranks the pairs of regions by the votes of the order that has most of them.
void RegionLinks::count_anew(OrderForest& forest) {
    std::size_t kept = 0;
    for (RegionLink& link : links_) {
        if (!move_to_roots(forest, link)) {
            continue;
        }
        if (kept > 0 && same_link(links_[kept - 1], link)) {
            count_in(links_[kept - 1], link);
        } else {
            links_[kept++] = link;
        }
    }
    links_.resize(kept);
    gather(links_, pairs_, same_link, count_in);
    links_.swap(pairs_);
    gather(links_, pairs_, same_regions, [](RegionLink& best, const RegionLink& link) {
        if (std::tie(link.votes, best.order) > std::tie(best.votes, link.order)) {
            best.votes = link.votes;
            best.order = link.order;
        }
        best.contact += link.contact;
    });
    rank();
}

/// Sorts the pairs by votes, most first; exact for few votes, by classes of an eighth for many.
void RegionLinks::rank() {
    std::array<std::uint32_t, kRanks + 1> begin{};
    for (const RegionLink& pair : pairs_) {
        ++begin[rank_of(pair.votes) + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    ranked_.resize(pairs_.size());
    for (const RegionLink& pair : pairs_) {
        ranked_[begin[rank_of(pair.votes)]++] = pair;
    }
    ranked_.swap(pairs_);
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
