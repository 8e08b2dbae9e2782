// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace hotfire::hal {

/// 64-bit FNV-1a. Takes the eight bytes of a number from the lowest up, whatever the machine's byte order.
///
/// Two uses: over the state and the readings of a plant, cycle after cycle, two runs with the same hash gave the same bits;
/// over a block of a recording it detects a torn or damaged one. [Fowler, Noll, Vo 1991; IETF draft-eastlake-fnv]
class Fnv1a {
 public:
  void add(std::span<const double> values) noexcept {
    for (const double value : values) {
      add(std::bit_cast<std::uint64_t>(value));
    }
  }

  void add(std::uint64_t bits) noexcept {
    for (int byte = 0; byte < 8; ++byte) {
      hash_ = (hash_ ^ (bits & 0xff)) * kPrime;
      bits >>= 8;
    }
  }

  void add(std::span<const std::byte> bytes) noexcept {
    for (const std::byte byte : bytes) {
      hash_ = (hash_ ^ static_cast<std::uint64_t>(byte)) * kPrime;
    }
  }

  std::uint64_t value() const noexcept { return hash_; }

 private:
  static constexpr std::uint64_t kPrime = 0x100000001b3;
  std::uint64_t hash_ = 0xcbf29ce484222325;
};

}  // namespace hotfire::hal
