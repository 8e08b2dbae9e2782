// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>

#include "tools/cli/rig/realtime_program.hpp"
#include "tools/cli/shared/commands.hpp"
#include "tools/files/rig/profile_file.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

void add_lab(CLI::App& program) {
  const auto profile = std::make_shared<std::string>();
  CLI::App* command = program.add_subcommand("lab", "Drive real actuators through a profile, behind interlocks");
  command->set_help_flag();
  command->allow_extras();
  command->add_option("--profile", *profile, "profile file (.toml)");
  command->callback([command, profile] {
    std::vector<std::string> arguments = command->remaining();
    arguments.insert(arguments.begin(), "lab");
    if (!asks_for_text_only(arguments)) {
      if (profile->empty()) {
        throw UsageError("--profile FILE is needed");
      }
      arguments.insert(arguments.end(), {"--image", share_image(load_profile(*profile).image)});
    }
    become_realtime_program(arguments);
  });
}

}  // namespace hotfire
