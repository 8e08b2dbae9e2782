// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <functional>
#include <iterator>
#include <span>
#include <string>

#include "firmware/replay/replay.hpp"
#include "hal/recording/reader.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::firmware::test_recording {

inline std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline Replay replayed(const std::string& path) {
  hal::RecordingReader reader(path);
  STRCMP_EQUAL("", reader.error().c_str());
  return replay(reader);
}

/// The recording with a block of its own for every cycle, changed by `change(cycle, bytes)`; false leaves a cycle out.
inline std::string rewritten(const std::string& path, const std::function<bool(std::uint64_t, std::string&)>& change) {
  hal::RecordingReader reader(path);
  std::string blocks;
  hal::RecordedCycle cycle;
  while (reader.next(cycle)) {
    std::string one(reinterpret_cast<const char*>(&cycle.head), sizeof cycle.head);
    one.append(reinterpret_cast<const char*>(cycle.commands.data()), cycle.commands.size_bytes());
    one.append(reinterpret_cast<const char*>(cycle.readings.data()), cycle.readings.size_bytes());
    if (!change(cycle.head.cycle, one)) {
      continue;
    }
    hal::BlockHead head;
    head.cycles = 1;
    head.checksum = head.checksum_with(std::as_bytes(std::span(one)));
    blocks.append(reinterpret_cast<const char*>(&head), sizeof head).append(one);
  }
  const std::string old = content_of(path);
  return old.substr(0, old.find("\ncycles\n") + 8) + blocks;
}

}  // namespace hotfire::firmware::test_recording
