// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/rig/realtime_program.hpp"
#include "tools/cli/shared/commands.hpp"

namespace hotfire {

void add_timing(CLI::App& program) {
  add_realtime_command(program, "timing", "Check this machine's deterministic timing, with a verdict",
                       TakesModel::optionally);
}

}  // namespace hotfire
