// SPDX-License-Identifier: Apache-2.0
#include "tests/support/allocation_guard.hpp"

#include <malloc.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>

namespace {

// The initial-exec model needs no allocation on first use, which would come back here.
__attribute__((tls_model("initial-exec"))) thread_local std::uint64_t allocation_count = 0;
__attribute__((tls_model("initial-exec"))) thread_local std::uint64_t release_count = 0;

}  // namespace

extern "C" std::uint64_t hotfire_allocation_count() noexcept { return allocation_count; }

namespace hotfire::test {

AllocationGuard::AllocationGuard() noexcept : allocations_before_(allocation_count), releases_before_(release_count) {}

std::uint64_t AllocationGuard::allocations() const noexcept { return allocation_count - allocations_before_; }
std::uint64_t AllocationGuard::releases() const noexcept { return release_count - releases_before_; }

}  // namespace hotfire::test

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

// The C library's own functions behind the names that are taken over here.
extern "C" {
// NOLINTBEGIN(readability-identifier-naming): the names are the C library's.
void* __libc_malloc(std::size_t size) noexcept;
void* __libc_calloc(std::size_t count, std::size_t size) noexcept;
void* __libc_realloc(void* block, std::size_t size) noexcept;
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;
void __libc_free(void* block) noexcept;
// NOLINTEND(readability-identifier-naming)

void* malloc(std::size_t size) noexcept {
  ++allocation_count;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  ++allocation_count;
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) noexcept {
  ++allocation_count;
  return __libc_realloc(block, size);
}

void free(void* block) noexcept {
  release_count += block != nullptr ? 1 : 0;
  __libc_free(block);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++allocation_count;
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++allocation_count;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  ++allocation_count;
  void* const got = __libc_memalign(alignment, size);
  if (got == nullptr) {
    return ENOMEM;
  }
  *block = got;
  return 0;
}
}

#endif
