// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace hotfire::hal {

/// During its life, this thread treats denormal numbers as zero (x86: FTZ and DAZ; aarch64: FZ). One denormal number in a
/// decaying state makes a step tens of times slower. On other processors it does nothing. The destructor restores the
/// earlier setting.
class FlushDenormals {
 public:
  FlushDenormals() noexcept : found_(control()) { set_control(found_ | kFlush); }
  ~FlushDenormals() { set_control(found_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
#if defined(__SSE2__)
  static constexpr std::uint64_t kFlush = 0x8040;  // bit 15 flush to zero, bit 6 denormals are zero
  static std::uint64_t control() noexcept { return _mm_getcsr(); }
  static void set_control(std::uint64_t value) noexcept { _mm_setcsr(static_cast<unsigned>(value)); }
#elif defined(__aarch64__)
  static constexpr std::uint64_t kFlush = 1U << 24;
  static std::uint64_t control() noexcept {
    std::uint64_t value = 0;
    __asm__ volatile("mrs %0, fpcr" : "=r"(value));
    return value;
  }
  static void set_control(std::uint64_t value) noexcept { __asm__ volatile("msr fpcr, %0" : : "r"(value)); }
#else
  static constexpr std::uint64_t kFlush = 0;
  static std::uint64_t control() noexcept { return 0; }
  static void set_control(std::uint64_t) noexcept {}
#endif

  std::uint64_t found_;
};

}  // namespace hotfire::hal
