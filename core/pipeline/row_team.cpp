// SPDX-License-Identifier: Apache-2.0
#include "core/pipeline/row_team.hpp"

#include <algorithm>

namespace xtrack {

RowTeam::RowTeam(int members) {
    try {
        threads_.reserve(static_cast<std::size_t>(members - 1));
        for (int member = 1; member < members; ++member) {
            threads_.emplace_back([this, member] { wait_for_jobs(member); });
        }
    } catch (...) {
        dismiss();
        throw;
    }
}

RowTeam::~RowTeam() { dismiss(); }

void RowTeam::dismiss() noexcept {
    {
        const MutexLock lock(mutex_);
        over_ = true;
    }
    job_came_.notify_all();
    for (std::thread& thread : threads_) {
        thread.join();
    }
}

void RowTeam::take_bands(const Job& job, int member) noexcept {
    // The mutex that hands out jobs orders what they read and write; here order does not matter.
    for (int first = next_row_.fetch_add(job.band_rows, std::memory_order_relaxed); first < job.end;
         first = next_row_.fetch_add(job.band_rows, std::memory_order_relaxed)) {
        job.call(job.context, member, first, std::min(first + job.band_rows, job.end));
    }
}

void RowTeam::start(const Job& job) noexcept {
    if (threads_.empty()) {
        job.call(job.context, 0, job.begin, job.end);
        return;
    }
    next_row_.store(job.begin, std::memory_order_relaxed);
    {
        const MutexLock lock(mutex_);
        job_ = job;
        ++jobs_;
        open_ = true;
    }
    job_came_.notify_all();
    take_bands(job, 0);
    // Who has not woken up by now is not waited for: on a busy machine that can take long.
    mutex_.lock();
    open_ = false;
    while (working_ > 0) {
        job_done_.wait(mutex_);
    }
    mutex_.unlock();
}

void RowTeam::wait_for_jobs(int member) noexcept {
    std::uint64_t seen = 0;
    mutex_.lock();
    while (true) {
        while (!over_ && !(open_ && jobs_ != seen)) {
            job_came_.wait(mutex_);
        }
        if (over_) {
            break;
        }
        seen = jobs_;
        const Job job = job_;
        ++working_;
        mutex_.unlock();
        take_bands(job, member);
        mutex_.lock();
        if (--working_ == 0) {
            job_done_.notify_one();
        }
    }
    mutex_.unlock();
}

}  // namespace xtrack
