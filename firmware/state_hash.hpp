#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace hotfire::firmware {

/// 64-bit FNV-1a over the bits of what a plant's sensors read, cycle after cycle: two runs with the same hash gave the same
/// bits. Takes the eight bytes of a number from the lowest up, whatever the machine's byte order.
/// [Fowler, Noll, Vo 1991; IETF draft-eastlake-fnv]
class StateHash {
 public:
  void add(std::span<const double> values) noexcept {
    for (const double value : values) {
      auto bits = std::bit_cast<std::uint64_t>(value);
      for (int byte = 0; byte < 8; ++byte) {
        hash_ = (hash_ ^ (bits & 0xff)) * kPrime;
        bits >>= 8;
      }
    }
  }

  std::uint64_t value() const noexcept { return hash_; }

 private:
  static constexpr std::uint64_t kPrime = 0x100000001b3;
  std::uint64_t hash_ = 0xcbf29ce484222325;
};

}  // namespace hotfire::firmware
