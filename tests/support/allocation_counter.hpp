// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace xtrack::test {

/// Whether this build can count: glibc's malloc, and no sanitizer that has taken its place.
[[nodiscard]] bool counts_allocations() noexcept;

/// How often the program that links allocation_counter.cpp asked the heap for memory, by whatever
/// way: new, malloc, OpenCV, all threads.
[[nodiscard]] long allocations() noexcept;

}  // namespace xtrack::test
