// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/unwrap/order_forest.hpp"

namespace xtrack {

/// Votes of a neighbour pair for the fringe order that its step gives: a sound step, one within the
/// noise, outweighs several that are merely possible.
inline constexpr std::uint32_t kSoundVotes = 4;
inline constexpr std::uint32_t kPossibleVotes = 1;

/// Where two regions touch, and what that says of their orders.
struct RegionLink {
    std::uint32_t a = 0;  ///< node of an OrderForest
    std::uint32_t b = 0;
    std::int32_t order = 0;     ///< of b when that of a is 0
    std::uint32_t votes = 0;    ///< for this order
    std::uint32_t contact = 0;  ///< neighbour pairs, with or without a vote
};

/// Joins touching regions in the order of what speaks for it. All contacts of the same two regions
/// are counted together, so that one lucky step cannot decide against a hundred others; and counted
/// anew after every round, as regions have grown.
class RegionLinks {
 public:
    /// Links up to `count` are added without going to the heap.
    void reserve(std::size_t count);
    void clear() noexcept { links_.clear(); }

    /// Adds a contact; one within a set says nothing any more.
    /// @param link is moved to the roots of its sets
    void add(OrderForest& forest, RegionLink& link);

    /// Joins two nodes at once, for a contact beyond doubt, unless they are one set already.
    static void join(OrderForest& forest, RegionLink& link) noexcept;

    /// Joins until nothing more can be. Two regions that could each stand alone are joined where
    /// `support` of their contact, 0 ... 1, agrees; a fragment is joined to what it fits best.
    void join_all(OrderForest& forest, double support);

 private:
    bool join_ranked(OrderForest& forest, std::uint32_t min_votes, double support, bool last);
    void count_anew(OrderForest& forest);
    void rank();
    template <typename Same, typename Merge>
    void gather(const std::vector<RegionLink>& from, std::vector<RegionLink>& into, Same same,
                Merge merge);

    std::vector<RegionLink> links_;
    std::vector<RegionLink> pairs_;
    std::vector<RegionLink> ranked_;
    std::vector<std::uint32_t> table_;
};

}  // namespace xtrack
