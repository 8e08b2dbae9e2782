// SPDX-License-Identifier: Apache-2.0
// libFuzzer harness of the reader of DBC files, of the map made from one, and of what its signals read in a frame.

#include <cstdint>
#include <vector>

#include "tests/fuzz/input_file.hpp"
#include "tools/files/can/can_map.hpp"
#include "tools/files/can/dbc.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace hotfire;
  const std::string_view text = fuzz::text_of(bytes, size);
  fuzz::read_or_refuse([&] {
    const Dbc dbc = read_dbc(text, "input.dbc");
    for (const DbcMessage& message : dbc.messages) {
      const std::vector<std::uint8_t> data(message.length, 0xA5);
      for (const DbcSignal& signal : message.signals) {
        if (signal.start / 8 < message.length) {  // of a real frame
          signal.allows(signal.physical(data));
        }
      }
    }
  });
  fuzz::read_or_refuse([&] { read_can_map(text, "input.dbc"); });
  return 0;
}
