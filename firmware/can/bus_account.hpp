// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/can/layout.hpp"
#include "firmware/can/message_follower.hpp"

namespace hotfire::firmware {

/// Counts of the frames of a message that a program receives.
struct MessageAccount {
  std::string_view name;
  can::MessageCounters counters;
};

/// State and counters of a program's CAN bus, for its report.
struct BusAccount {
  std::string interface;
  can::Layout layout = can::Layout::classic;
  bool authenticated = false;  ///< commands and readings are
  std::optional<double> load;  ///< share of the bus in the worst case; none: its bit rate is not known
  hal::CanState state = hal::CanState::good;
  hal::CanCounters frames;
  std::vector<MessageAccount> messages{};
  std::uint64_t stale_cycles = 0;  ///< without a command that is young enough
  std::uint64_t too_old = 0;       ///< commands that came too late to be taken
  std::uint64_t unsayable = 0;     ///< frames not sent because a value is beyond its signal
  std::uint64_t lost_syncs = 0;    ///< not sent

  /// Faulty frames: lost, damaged, repeated or out of order.
  std::uint64_t lost() const noexcept {
    std::uint64_t sum = frames.dropped + frames.foreign + frames.impostors;
    for (const MessageAccount& message : messages) {
      sum += message.counters.damaged() + message.counters.of_two_senders() + message.counters.unauthentic;
    }
    return sum;
  }
};

class Json;

/// Its part of the reports.
std::string text_of(const BusAccount& bus);
void add_to(Json& json, const BusAccount& bus);

}  // namespace hotfire::firmware
