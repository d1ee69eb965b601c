// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/mutex.hpp"

namespace xtrack {

/// Callbacks that may come and go from any thread, even from inside a callback. The list is copied
/// when it changes and never while events are delivered: delivering takes no lock during the calls
/// and allocates nothing. A callback removed by another thread may still run once, if its delivery
/// had already begun.
template <typename... Args>
class Subscribers {
 public:
    using Callback = std::function<void(Args...)>;

    /// @return `id`, which the caller keeps unique
    int add(int id, Callback callback) {
        const MutexLock lock(mutex_);
        auto next = std::make_shared<List>(*list_);
        next->emplace_back(id, std::move(callback));
        list_ = std::move(next);
        return id;
    }

    void remove(int id) {
        // Dies after the lock: what a callback holds may call back here as it is destroyed.
        std::shared_ptr<const List> before;
        const MutexLock lock(mutex_);
        auto next = std::make_shared<List>();
        for (const auto& entry : *list_) {
            if (entry.first != id) {
                next->push_back(entry);
            }
        }
        before = std::exchange(list_, std::move(next));
    }

    void call(Args... args) const {
        const std::shared_ptr<const List> list = snapshot();
        for (const auto& [id, callback] : *list) {
            callback(args...);
        }
    }

    [[nodiscard]] bool empty() const { return snapshot()->empty(); }

 private:
    using List = std::vector<std::pair<int, Callback>>;

    [[nodiscard]] std::shared_ptr<const List> snapshot() const {
        const MutexLock lock(mutex_);
        return list_;
    }

    mutable Mutex mutex_;
    std::shared_ptr<const List> list_ XTRACK_GUARDED_BY(mutex_) = std::make_shared<List>();
};

}  // namespace xtrack
