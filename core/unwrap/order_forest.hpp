// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace xtrack {

/// Disjoint sets whose members know their fringe order against each other: union-find with
/// potentials. Nodes are numbered from 0 as they are added.
class OrderForest {
 public:
    /// A node's set, and the node's order when the root's is 0.
    struct Place {
        std::uint32_t root = 0;
        std::int32_t order = 0;
    };

    /// Nodes up to `count` are added without going to the heap.
    void reserve(std::size_t count) { nodes_.reserve(count); }
    void clear() noexcept { nodes_.clear(); }
    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(nodes_.size());
    }

    /// @return the new node, a set of its own that has `pixels` pixels
    std::uint32_t add(std::uint32_t pixels) {
        nodes_.push_back({size(), 0, pixels});
        return size() - 1;
    }

    [[nodiscard]] Place find(std::uint32_t node) noexcept {
        std::int32_t order = 0;
        while (nodes_[node].parent != node) {
            Node& here = nodes_[node];
            const Node& above = nodes_[here.parent];
            // Every node passed is hung up one generation higher; a root's own order is 0.
            here.order += above.order;
            here.parent = above.parent;
            order += here.order;
            node = here.parent;
        }
        return {node, order};
    }

    /// @pre a root
    [[nodiscard]] std::uint32_t pixels(std::uint32_t root) const noexcept {
        return nodes_[root].pixels;
    }

    /// Makes one set of two.
    /// @param order of root b when that of root a is 0
    /// @pre two different roots
    /// @return the root that stays one: that of more pixels
    std::uint32_t join(std::uint32_t a, std::uint32_t b, std::int32_t order) noexcept {
        assert(a != b && nodes_[a].parent == a && nodes_[b].parent == b);
        if (nodes_[a].pixels < nodes_[b].pixels) {
            std::swap(a, b);
            order = -order;
        }
        nodes_[a].pixels += nodes_[b].pixels;
        nodes_[b].parent = a;
        nodes_[b].order = order;
        return a;
    }

 private:
    struct Node {
        std::uint32_t parent = 0;
        std::int32_t order = 0;  ///< when the parent's is 0
        std::uint32_t pixels = 0;
    };
    std::vector<Node> nodes_;
};

}  // namespace xtrack
