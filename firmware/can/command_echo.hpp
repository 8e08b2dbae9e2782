// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware/can/layout.hpp"

namespace hotfire::firmware::can {

/// Age of the newest commands that the nodes of a rig have received. A node echoes the counter of its newest command in
/// every reading. A counter that does not change, or that belongs to no command, is not an answer.
class CommandEcho {
 public:
  /// `messages`: number of reading messages, each of a separate node.
  explicit CommandEcho(std::size_t nodes) noexcept : nodes_(nodes) {}

  void note_sent(std::uint8_t counter, std::int64_t now_ns) noexcept {
    if (!begun_) {
      begun_ = true;
      sent_ns_.fill(kNotSent);
      answered_ns_.fill(now_ns);
    }
    sent_ns_[counter] = now_ns;
  }

  void note_echo(std::size_t node, std::uint8_t counter) noexcept {
    if (counter != last_[node] && sent_ns_[counter] != kNotSent) {
      answered_ns_[node] = std::max(answered_ns_[node], sent_ns_[counter]);
    }
    last_[node] = counter;
  }

  /// Time since the newest command was sent that every node has. Until a node is known to have one, the time since the first
  /// command.
  std::int64_t age_ns(std::int64_t now_ns) const noexcept {
    return begun_ ? now_ns - *std::min_element(answered_ns_.begin(), answered_ns_.begin() + nodes_) : 0;
  }

  /// Ends commanding; the next command is the first again.
  void forget() noexcept { begun_ = false; }

 private:
  static constexpr std::int64_t kNotSent = -1;
  static constexpr std::size_t kCounters = 256;

  std::size_t nodes_;
  bool begun_ = false;
  std::array<std::int64_t, kCounters> sent_ns_{};
  std::array<std::int64_t, kMostReadingMessages> answered_ns_{};
  std::array<std::uint8_t, kMostReadingMessages> last_{};
};

}  // namespace hotfire::firmware::can
