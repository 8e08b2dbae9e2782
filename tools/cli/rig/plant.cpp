// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/rig/realtime_program.hpp"
#include "tools/cli/shared/commands.hpp"

namespace hotfire {

void add_plant(CLI::App& program) {
  add_realtime_command(program, "plant", "Run a model in real time: answer commands with sensor readings, every period",
                       TakesModel::always);
}

}  // namespace hotfire
