// SPDX-License-Identifier: Apache-2.0
// libFuzzer harness of the readers of TOML files. The first byte says which: model, vehicle, lab profile, faults, import
// map.

#include <cstdint>

#include "tests/fuzz/input_file.hpp"
#include "tools/files/import/import.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/files/rig/fault_file.hpp"
#include "tools/files/rig/profile_file.hpp"
#include "tools/structure/vehicle_file.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace hotfire;
  static const fuzz::InputFile file("toml");
  if (size == 0) {
    return 0;
  }
  const std::string& path = file.holding(fuzz::text_of(bytes + 1, size - 1));
  fuzz::read_or_refuse([&] {
    switch (bytes[0] % 6) {
      case 0:
        load_model(path);
        break;
      case 1:
        load_vehicle(path);
        break;
      case 2:
        load_profile(path);
        break;
      case 3:
        load_faults(path, FaultyPlant{{{"piston", "m"}, {"engine", "rad"}}, true, 8});
        break;
      case 4:
        load_import_map(path);
        break;
      default:
        load_import_map(path, ImportSource::candump_log);
    }
  });
  return 0;
}
