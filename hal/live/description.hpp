// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/recording/format.hpp"

namespace hotfire::hal {

/// A number with a name, and what it means.
struct LiveWordMeaning {
  std::uint64_t number = 0;
  std::string name;
  std::string meaning{};
};

/// One count of a program.
struct LiveCounterName {
  std::string group;  ///< one word: loop, recording, bus, faults, or the name of a message
  std::string name;
};

/// The meaning of the words of a live view. A slot has the head of a cycle, the commands and the readings as in a recording
/// (hal/recording/format.hpp), then one word for each counter.
struct LiveDescription {
  RecordingHeader header;               ///< its model is left out: it may be as long as a profile
  std::vector<LiveWordMeaning> states;  ///< of an interlock, in `CycleHead::flags`; empty: the program has none
  std::vector<LiveWordMeaning> faults;
  std::vector<LiveWordMeaning> endings;  ///< why it ended; never number 0
  std::vector<LiveCounterName> counters;

  std::size_t slot_words() const noexcept {
    return cycle_bytes(header.actuators, header.start.size()) / sizeof(double) + counters.size();
  }
};

std::string description_text(const LiveDescription& description);

/// A description, or the error in its text.
struct ParsedDescription {
  LiveDescription description;
  std::string error;
};
ParsedDescription parse_description(std::string_view text);

}  // namespace hotfire::hal
