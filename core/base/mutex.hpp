// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <mutex>

// Clang checks at compile time (-Wthread-safety) that what a mutex guards is touched only under it;
// the standard library's mutex carries no such annotations, hence these thin forms of it.
#if defined(__clang__)
#define XTRACK_THREAD_ATTRIBUTE(x) __attribute__((x))
#else
#define XTRACK_THREAD_ATTRIBUTE(x)
#endif

#define XTRACK_GUARDED_BY(mutex) XTRACK_THREAD_ATTRIBUTE(guarded_by(mutex))
#define XTRACK_REQUIRES(mutex) XTRACK_THREAD_ATTRIBUTE(requires_capability(mutex))

namespace xtrack {

class XTRACK_THREAD_ATTRIBUTE(capability("mutex")) Mutex {
 public:
    void lock() XTRACK_THREAD_ATTRIBUTE(acquire_capability()) { mutex_.lock(); }
    void unlock() XTRACK_THREAD_ATTRIBUTE(release_capability()) { mutex_.unlock(); }

 private:
    std::mutex mutex_;
};

class XTRACK_THREAD_ATTRIBUTE(scoped_lockable) MutexLock {
 public:
    explicit MutexLock(Mutex& mutex) XTRACK_THREAD_ATTRIBUTE(acquire_capability(mutex))
        : mutex_(mutex) {
        mutex_.lock();
    }
    ~MutexLock() XTRACK_THREAD_ATTRIBUTE(release_capability()) { mutex_.unlock(); }
    MutexLock(const MutexLock&) = delete;
    MutexLock& operator=(const MutexLock&) = delete;

 private:
    Mutex& mutex_;
};

/// Waits on a Mutex that the caller holds.
using ConditionVariable = std::condition_variable_any;

}  // namespace xtrack
