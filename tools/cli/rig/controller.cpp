// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/rig/realtime_program.hpp"
#include "tools/cli/shared/commands.hpp"

namespace hotfire {

void add_controller(CLI::App& program) {
  add_realtime_command(program, "controller", "Command a plant on a CAN bus, to test a rig without another controller",
                       TakesModel::never);
}

}  // namespace hotfire
