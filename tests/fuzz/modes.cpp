// SPDX-License-Identifier: Apache-2.0
// libFuzzer harness of the reader of mode tables: what it takes is written and read again, the same.

#include <cstdint>

#include "tests/fuzz/input_file.hpp"
#include "tools/structure/mode_table.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace hotfire;
  static const fuzz::InputFile file("modes");
  fuzz::read_or_refuse([&] {
    const ModeSet modes = load_modes(file.holding(fuzz::text_of(bytes, size)));
    const std::string text = mode_table_text(modes, {});
    if (mode_table_text(load_modes(file.holding(text)), {}) != text) {
      std::abort();
    }
  });
  return 0;
}
