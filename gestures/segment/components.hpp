// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "gestures/segment/grid.hpp"

namespace xtrack::segment {

/// Connected components of a part of a grid, as runs of pixels along its rows: far fewer than
/// pixels, and all that counting, filling and measuring needs.
class Components {
 public:
    struct Run {
        int begin = 0, end = 0;  ///< grid indices
        int component = 0;       ///< 0, 1, ... in the order of their first pixels
    };

    void create(const Grid& grid);

    /// @param next (index, end) the first pixel from an index on that belongs to any component;
    /// `end`
    ///        where none before that does. Most of an image does not, so this is what takes time.
    /// @param same (index, index of a neighbour of its eight) whether both belong to one; may be
    ///        asked of pixels that belong to none, too
    template <typename Next, typename Same>
    void find(const Grid& grid, const Box& box, Next&& next, Same&& same);
    /// The same where `value` is not 0.
    template <typename T, typename Same>
    void find_in(const Grid& grid, const Box& box, std::span<const T> value, Same&& same) {
        find(
            grid, box, [v = value.data()](int i, int end) { return next_other_than_0(v, i, end); },
            same);
    }

    [[nodiscard]] std::span<const Run> runs() const noexcept { return runs_; }
    [[nodiscard]] int count() const noexcept { return count_; }

 private:
    template <typename T>
    static int next_other_than_0(const T* value, int i, int end) noexcept {
        // Most are 0, so many are looked at at once.
        constexpr int kAtOnce = static_cast<int>(32 / sizeof(T));
        for (; i + kAtOnce <= end; i += kAtOnce) {
            std::array<std::uint64_t, 4> bits{};
            std::memcpy(bits.data(), value + i, sizeof(bits));
            if ((bits[0] | bits[1] | bits[2] | bits[3]) != 0) {
                break;
            }
        }
        while (i < end && value[i] == T{0}) {
            ++i;
        }
        return i;
    }
    int root_of(int run) noexcept {
        while (parent_[static_cast<std::size_t>(run)] != run) {
            int& up = parent_[static_cast<std::size_t>(run)];
            up = parent_[static_cast<std::size_t>(up)];
            run = up;
        }
        return run;
    }
    /// Joins the runs [begin, end) of one row with those [above, begin) of the row before it.
    template <typename Same>
    void join_rows(int above, int begin, int end, int width, Same&& same);
    void number();

    std::vector<Run> runs_;    ///< row by row
    std::vector<int> parent_;  ///< union-find over runs; the earlier run is the root
    int count_ = 0;
};

template <typename Next, typename Same>
void Components::find(const Grid& grid, const Box& box, Next&& next, Same&& same) {
    runs_.clear();
    parent_.clear();
    int above = 0;
    for (int y = box.y_begin; y < box.y_end; ++y) {
        const int row_begin = static_cast<int>(runs_.size());
        const int end = grid.index(box.x_end, y);
        for (int i = next(grid.index(box.x_begin, y), end); i < end; i = next(i, end)) {
            Run run{i, i + 1, static_cast<int>(runs_.size())};
            while (run.end < end && same(run.end, run.end - 1)) {
                ++run.end;
            }
            i = run.end;
            runs_.push_back(run);
            parent_.push_back(run.component);
        }
        join_rows(above, row_begin, static_cast<int>(runs_.size()), grid.width, same);
        above = row_begin;
    }
    number();
}

template <typename Same>
void Components::join_rows(int above, int begin, int end, int width, Same&& same) {
    int a = above;
    for (int b = begin; b < end; ++b) {
        const Run& low = runs_[static_cast<std::size_t>(b)];
        // Neighbours of its pixels in the row above: one more at either end.
        const int from = low.begin - width - 1;
        const int to = low.end - width + 1;
        while (a < begin && runs_[static_cast<std::size_t>(a)].end <= from) {
            ++a;
        }
        for (int k = a; k < begin && runs_[static_cast<std::size_t>(k)].begin < to; ++k) {
            const int high_root = root_of(k);
            const int low_root = root_of(b);
            if (high_root == low_root) {
                continue;
            }
            const Run& high = runs_[static_cast<std::size_t>(k)];
            const int last = std::min(high.end, to);
            bool joined = false;
            for (int j = std::max(high.begin, from); j < last && !joined; ++j) {
                const int i_end = std::min(j + width + 2, low.end);
                for (int i = std::max(j + width - 1, low.begin); i < i_end && !joined; ++i) {
                    joined = same(i, j);
                }
            }
            if (joined) {
                parent_[static_cast<std::size_t>(std::max(high_root, low_root))] =
                    std::min(high_root, low_root);
            }
        }
    }
}

}  // namespace xtrack::segment
