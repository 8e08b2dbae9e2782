// SPDX-License-Identifier: Apache-2.0
// libFuzzer harness of the readers of CSV files: a record, a record with a drop-out, somebody else's table.

#include <cstdint>

#include "tests/fuzz/input_file.hpp"
#include "tools/files/import/import.hpp"
#include "tools/files/record/record.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace hotfire;
  static const fuzz::InputFile file("csv");
  static const ImportMap map = [] {
    ImportMap own;
    own.columns = {{"time", "time[s]", "s", 1.0, 1}, {"command", "command[rad]", "rad", 1.0, 2}};
    return own;
  }();
  const std::string& path = file.holding(fuzz::text_of(bytes, size));
  fuzz::read_or_refuse([&] { load_record(path); });
  fuzz::read_or_refuse([&] { load_record(path, {{0.0015, 0.0035}}); });
  fuzz::read_or_refuse([&] { read_csv_columns(path, map); });
  return 0;
}
