// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Allocations by malloc and its kin since the start of the calling thread; the real-time executable reports it when this
/// guard is linked into it.
extern "C" std::uint64_t hotfire_allocation_count() noexcept;

namespace hotfire::test {

/// Counts what the calling thread takes from and gives back to the heap while it lives: malloc, calloc, realloc, free,
/// posix_memalign, aligned_alloc, memalign. It sits below `operator new`, which CppUTest replaces for its own leak
/// detection, so it sees both. Sanitizers bring their own malloc: there the guard is compiled out, `available` is false and
/// it counts nothing.
class AllocationGuard {
 public:
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  static constexpr bool available = false;
#else
  static constexpr bool available = true;
#endif

  AllocationGuard() noexcept;

  std::uint64_t allocations() const noexcept;
  std::uint64_t releases() const noexcept;

 private:
  std::uint64_t allocations_before_;
  std::uint64_t releases_before_;
};

}  // namespace hotfire::test
