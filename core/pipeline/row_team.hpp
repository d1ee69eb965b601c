// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "core/base/mutex.hpp"

namespace xtrack {

/// Threads that share the rows of one image, and wait in between. Rows are handed out in bands as
/// members come for them, so what is done to a row must not depend on who does it or when.
///
/// Own code, as a pool of a library would be one for the whole process that embeds us, with threads
/// and settings shared with it.
class RowTeam {
 public:
    /// @param members the caller of run() is one; 1 makes no thread. Throws std::system_error where
    ///        the system has no thread left.
    explicit RowTeam(int members);
    RowTeam(const RowTeam&) = delete;
    RowTeam& operator=(const RowTeam&) = delete;
    ~RowTeam();

    [[nodiscard]] int members() const noexcept { return static_cast<int>(threads_.size()) + 1; }

    /// Calls work(member, first, last) for bands that together are [begin, end), and returns when
    /// all are done. A member, 0 <= member < members(), works on one band at a time. `work` must
    /// not throw. Allocates nothing.
    /// @param band_rows of each but the last
    template <typename Work>
    void run(int begin, int end, int band_rows, Work&& work) noexcept {
        start({begin, end, band_rows,
               [](void* context, int member, int first, int last) {
                   (*static_cast<std::remove_reference_t<Work>*>(context))(member, first, last);
               },
               &work});
    }

 private:
    struct Job {
        int begin = 0;
        int end = 0;
        int band_rows = 1;
        void (*call)(void* context, int member, int first, int last) = nullptr;
        void* context = nullptr;
    };
    void start(const Job& job) noexcept;
    void take_bands(const Job& job, int member) noexcept;
    void wait_for_jobs(int member) noexcept;
    void dismiss() noexcept;

    Mutex mutex_;
    ConditionVariable job_came_;
    ConditionVariable job_done_;
    Job job_ XTRACK_GUARDED_BY(mutex_);
    std::uint64_t jobs_ XTRACK_GUARDED_BY(mutex_) = 0;
    bool open_ XTRACK_GUARDED_BY(mutex_) = false;  ///< the job may be joined
    int working_ XTRACK_GUARDED_BY(mutex_) = 0;    ///< members in the job, but for the caller
    bool over_ XTRACK_GUARDED_BY(mutex_) = false;
    std::atomic<int> next_row_{0};
    std::vector<std::thread> threads_;
};

}  // namespace xtrack
