// SPDX-License-Identifier: Apache-2.0
// libFuzzer harness of the reader of MATLAB files, which works in a process of its own. The first byte says what is asked
// for.

#include <array>
#include <cstdint>

#include "tests/fuzz/input_file.hpp"
#include "tools/files/import/import.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace hotfire;
  static const fuzz::InputFile file("matlab");
  static const std::array<const char*, 4> wanted{"X", "X.beta", "X:2", "nothing"};
  if (size == 0) {
    return 0;
  }
  ImportMap map;
  map.columns = {{"piston", wanted.at(bytes[0] % wanted.size()), "m", 1.0, 1}};
  const std::string& path = file.holding(fuzz::text_of(bytes + 1, size - 1));
  fuzz::read_or_refuse([&] { read_matlab_columns(path, map); });
  return 0;
}
