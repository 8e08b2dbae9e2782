// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace hotfire::hal {

/// The largest share of a bus that a schedule may take. The rest is for retransmission and for frames of other nodes.
inline constexpr double kLargestBusLoad = 0.7;

/// The longest time for which a frame can occupy a bus [s], with the worst case of stuff bits and the space to the next
/// frame. `bytes` as on the wire, rates in bit/s.
///
/// Classic, base format: 47 + 8 n bits and floor((33 + 8 n) / 4) stuff bits (Davis, Burns, Bril, Lukkien 2007).
constexpr double longest_classic_frame(unsigned bytes, double bit_rate) noexcept {
  const unsigned stuff = (33 + 8 * bytes) / 4;
  return (47 + 8 * bytes + stuff) / bit_rate;
}

/// FD, ISO 11898-1:2015, base format: at the arbitration rate 17 bits from start to the rate switch, at most 4 stuff bits of
/// theirs, and 13 from the check's delimiter to the space; at the data rate 5 + 8 n bits and the other stuff bits of the
/// floor((21 + 8 n) / 4) that start to data can have together, the stuff count of 4, a check of 17 (to 16 bytes) or 21 bits
/// and its 6 or 7 fixed stuff bits.
constexpr double longest_fd_frame(unsigned bytes, double bit_rate, double data_bit_rate) noexcept {
  constexpr unsigned kMostArbitrationStuff = 4;
  const unsigned stuff = (21 + 8 * bytes) / 4 - kMostArbitrationStuff;
  const unsigned check = bytes <= 16 ? 17 + 6 : 21 + 7;
  return (17 + kMostArbitrationStuff + 13) / bit_rate + (5 + 8 * bytes + stuff + 4 + check) / data_bit_rate;
}

}  // namespace hotfire::hal
