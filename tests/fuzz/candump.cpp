// SPDX-License-Identifier: Apache-2.0
// libFuzzer harness of the readers of candump logs: through the map of the project, and through somebody else's.

#include <cstdint>

#include "tests/fuzz/input_file.hpp"
#include "tools/files/can/candump.hpp"
#include "tools/files/import/import.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace hotfire;
  static const fuzz::InputFile file("candump");
  static const Dbc dbc = read_dbc(
      "BO_ 256 COMMAND: 4 X\n SG_ BETA : 0|16@1- (0.001,0) [-10|10] \"deg\" Y\n"
      "BO_ 2566844926 FEEDBACK: 8 Y\n SG_ POSITION : 7|16@0- (0.01,0) [-200|200] \"mm\" X\n"
      " SG_ KIND M : 16|8@1+ (1,0) [0|0] \"\" X\n SG_ PRESSURE m1 : 24|32@1- (1,0) [0|0] \"bar\" X\n"
      "SIG_VALTYPE_ 2566844926 PRESSURE : 1;\n",
      "rig.dbc");
  static const ImportMap map = [] {
    ImportMap own;
    own.path = "map.toml";
    own.rows = "FEEDBACK";
    own.columns = {{"command", "BETA", "", 1.0, 3},
                   {"piston", "POSITION", "mm", -1.0, 5},
                   {"load_pressure", "PRESSURE", "bar", 1.0, 7}};
    return own;
  }();
  const std::string& path = file.holding(fuzz::text_of(bytes, size));
  fuzz::read_or_refuse([&] { load_candump(path); });
  fuzz::read_or_refuse([&] { load_candump(path, {8, 0.5}); });
  fuzz::read_or_refuse([&] { read_candump_columns(path, dbc, map); });
  return 0;
}
