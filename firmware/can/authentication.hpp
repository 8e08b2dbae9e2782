// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nettle/cmac.h>

#include <array>
#include <cstdint>

#include "firmware/can/message.hpp"
#include "hal/can.hpp"

namespace hotfire::firmware::can {

using AuthenticationKey = std::array<std::uint8_t, 16>;

/// Proves that a frame is new and comes from a sender with the key. A message that can be authenticated ends with 32 bits of
/// freshness and a code of 64 bits. The code is the first half of CMAC-AES-128 (NIST SP 800-38B; RFC 4493) over data id,
/// freshness (64 bits) and the bytes of the frame from its counter to its freshness. Numbers are little-endian. This is the
/// structure of AUTOSAR's Secure Onboard Communication. The check of the frame covers freshness and code too.
///
/// Freshness is the sender's real time in microseconds. A frame has its lower half. A sender never uses a value twice. A
/// receiver accepts a frame if it is newer than the last one of its message and within a tolerance of the receiver's own
/// time. Both clocks must therefore agree to that tolerance. A replayed frame is refused, unless the receiver has restarted
/// and the frame is younger than the tolerance.
///
/// The object has all its memory: no call allocates, and none fails.
class Authentication {
 public:
  using RealTime = std::int64_t (*)() noexcept;  ///< [ns] since any beginning that sender and receiver share

  Authentication(const AuthenticationKey& key, std::int64_t tolerance_ns, RealTime real_time) noexcept;

  /// Completes an encoded frame of a message that can be authenticated.
  void seal(const Message& message, hal::CanFrame& frame) noexcept;

  /// Whether a decoded frame is authentic and fresh; if so `newest_us`, the freshness of the last one of the message, is
  /// set.
  bool accepts(const Message& message, const hal::CanFrame& frame, std::uint64_t& newest_us) noexcept;

 private:
  static constexpr std::size_t kCodeBytes = 8;
  using Code = std::array<std::uint8_t, kCodeBytes>;

  Code code_of(const Message& message, std::uint64_t freshness_us, const hal::CanFrame& frame) noexcept;
  std::uint64_t now_us() const noexcept;

  cmac_aes128_ctx context_{};
  std::uint64_t tolerance_us_;
  RealTime real_time_;
  std::uint64_t last_us_ = 0;  ///< freshness given last
};

}  // namespace hotfire::firmware::can
