// SPDX-License-Identifier: Apache-2.0
// libFuzzer harness of the reader of MDF files.

#include <cstdint>

#include "tests/fuzz/input_file.hpp"
#include "tools/files/exchange/mdf4.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace hotfire;
  static const fuzz::InputFile file("mdf4");
  const std::string& path = file.holding(fuzz::text_of(bytes, size));
  fuzz::read_or_refuse([&] { read_mdf4(path); });
  return 0;
}
