// SPDX-License-Identifier: Apache-2.0
#include "tests/support/allocation_counter.hpp"

#include <atomic>
#include <cerrno>
#include <cstddef>

// Every way to the heap ends in one of these; glibc keeps its own under other names.
#if defined(__GLIBC__) && !defined(XTRACK_SANITIZED)
#define XTRACK_COUNTS_ALLOCATIONS 1
namespace {
std::atomic<long> counted{0};
}
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t bytes) {
    ++counted;
    return __libc_malloc(bytes);
}
void* calloc(std::size_t n, std::size_t bytes) {
    ++counted;
    return __libc_calloc(n, bytes);
}
void* realloc(void* p, std::size_t bytes) {
    ++counted;
    return __libc_realloc(p, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
    ++counted;
    return __libc_memalign(alignment, bytes);
}
void* memalign(std::size_t alignment, std::size_t bytes) {
    ++counted;
    return __libc_memalign(alignment, bytes);
}
int posix_memalign(void** p, std::size_t alignment, std::size_t bytes) {
    ++counted;
    *p = __libc_memalign(alignment, bytes);
    return *p != nullptr ? 0 : ENOMEM;
}
}
#endif

namespace xtrack::test {

bool counts_allocations() noexcept {
#ifdef XTRACK_COUNTS_ALLOCATIONS
    return true;
#else
    return false;
#endif
}

long allocations() noexcept {
#ifdef XTRACK_COUNTS_ALLOCATIONS
    return counted;
#else
    return 0;
#endif
}

}  // namespace xtrack::test
