// SPDX-License-Identifier: Apache-2.0
// What is counted for and against orders, within an image and over the images.
#include <algorithm>

#include "core/pipeline/component_orders.hpp"

namespace xtrack {
namespace {

// With a rig a component's order is another than it was once so many lines have said so, in all,
// and such a share of what was said. What was said counts less by this from image to image.
constexpr int kConvincingLines = 24;
constexpr double kConvincingShare = 0.6;
constexpr double kKept = 0.8;
constexpr int kLine = 16;                   // so that a line is not forgotten at once
constexpr int kMostEvidence = kLine << 13;  // sums over all samples stay integers

}  // namespace

void ComponentOrders::Votes::add(int order, int count) noexcept {
    if (order < -reach_ || order > reach_) {
        return;
    }
    counts_[static_cast<std::size_t>(order + reach_)] += count;
    const bool first = low_ > high_;
    low_ = first ? order : std::min(low_, order);
    high_ = first ? order : std::max(high_, order);
    total_ += count;
}

void ComponentOrders::Votes::clear() noexcept {
    for (int order = low_; order <= high_; ++order) {
        counts_[static_cast<std::size_t>(order + reach_)] = 0;
    }
    low_ = 0;
    high_ = -1;
    total_ = 0;
}

int ComponentOrders::Votes::of(int order) const noexcept {
    return order < low_ || order > high_ ? 0 : counts_[static_cast<std::size_t>(order + reach_)];
}

int ComponentOrders::Votes::best() const noexcept {
    int found = low_;
    for (int order = low_; order <= high_; ++order) {
        found = of(order) > of(found) ? order : found;
    }
    return found;
}

int ComponentOrders::Votes::reached(double share) const noexcept {
    int sum = 0;
    for (int order = low_; order <= high_; ++order) {
        sum += of(order);
        if (sum >= share * total_) {
            return order;
        }
    }
    return low_;
}

// That so much was said of what was there an image ago, seen from an order there now.
void ComponentOrders::hear(std::uint16_t id_before, int order) noexcept {
    const Evidence& said = evidence_before_[id_before - 1U];
    for (int n = 0; metric_ && n < static_cast<int>(said.size()); ++n) {
        heard_.add(order + n - kEvidenceReach, said[static_cast<std::size_t>(n)]);
    }
}

void ComponentOrders::keep_evidence(std::size_t index) noexcept {
    Evidence& kept = evidence_[index];
    for (int n = 0; metric_ && n < static_cast<int>(kept.size()); ++n) {
        kept[static_cast<std::size_t>(n)] =
            std::min(evidence_of(orders_[index] + n - kEvidenceReach), kMostEvidence);
    }
}

// What the images have said for an order, the older the less, in kLine.
int ComponentOrders::evidence_of(int order) const noexcept {
    const double heard = heard_.of(order) / static_cast<double>(samples_.size());
    return static_cast<int>(kKept * heard) +
           kLine * (rough_.of(order) + bridged_.of(order) + joined_.of(order));
}

int ComponentOrders::best_told(int least, int most) const noexcept {
    int best = least;
    for (int order = least; order <= most; ++order) {
        best = is_possible(order) && evidence_of(order) > evidence_of(best) ? order : best;
    }
    return best;
}

bool ComponentOrders::is_convincing(int order, int least, int most) const noexcept {
    int all = 0;
    for (int other = least; other <= most; ++other) {
        all += is_possible(other) ? evidence_of(other) : 0;
    }
    return metric_ && evidence_of(order) >= kLine * kConvincingLines &&
           evidence_of(order) >= kConvincingShare * all;
}

}  // namespace xtrack
