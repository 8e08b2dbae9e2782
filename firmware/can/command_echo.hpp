// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware/can/layout.hpp"

namespace hotfire::firmware::can {

/// How old the commands are that the nodes of a rig say they have. A node echoes the counter of its newest command in every
/// reading; a counter that does not change, or that of no command, is no answer.
class CommandEcho {
 public:
  /// Of so many reading messages, each of a node of its own.
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

  /// Since the newest command that every node has was sent; before any is known to be there, since the first one was.
  std::int64_t age_ns(std::int64_t now_ns) const noexcept {
    return begun_ ? now_ns - *std::min_element(answered_ns_.begin(), answered_ns_.begin() + nodes_) : 0;
  }

  /// Commanding has ended; the next command is the first again.
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
