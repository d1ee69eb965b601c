// SPDX-License-Identifier: Apache-2.0
#include "gestures/segment/components.hpp"

namespace xtrack::segment {

void Components::create(const Grid& grid) {
    runs_.reserve(grid.size());
    parent_.reserve(grid.size());
}

void Components::number() {
    count_ = 0;
    for (Run& run : runs_) {
        const int own = static_cast<int>(&run - runs_.data());
        const int root = root_of(own);
        run.component = root == own ? count_++ : runs_[static_cast<std::size_t>(root)].component;
    }
}

}  // namespace xtrack::segment
