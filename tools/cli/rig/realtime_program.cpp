// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/rig/realtime_program.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "tools/cli/shared/plant_image.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

std::string share_image(const std::string& image) {
  const int file = memfd_create("image", 0);
  if (file < 0 || write(file, image.data(), image.size()) != static_cast<ssize_t>(image.size())) {
    throw UsageError(fmt::format("the image cannot be kept in memory: {}", std::strerror(errno)));
  }
  return fmt::format("/proc/self/fd/{}", file);
}

bool asks_for_text_only(const std::vector<std::string>& arguments) {
  return std::any_of(arguments.begin(), arguments.end(), [](const std::string& argument) {
    return argument == "--help" || argument == "-h" || argument == "--version";
  });
}

void become_realtime_program(const std::vector<std::string>& arguments) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "hotfire-rt";
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), program);
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  std::fflush(nullptr);
  execv(program.c_str(), pointers.data());
  throw UsageError(
      fmt::format("cannot start {}: {}; build or install hotfire-rt beside hotfire", program, std::strerror(errno)));
}

void add_realtime_command(CLI::App& program, const std::string& name, const std::string& description, TakesModel model) {
  const auto path = std::make_shared<std::string>();
  const auto played = std::make_shared<PlayedFiles>();
  CLI::App* command = program.add_subcommand(name, description);
  command->set_help_flag();
  command->allow_extras();
  if (model != TakesModel::never) {
    command->add_option("--model", *path, "model file (.toml), of one axis or of a vehicle");
    command->add_option("--faults", played->faults, "faults to play (.toml)");
    command->add_option("--disturbances", played->disturbances, "record whose torque, force, vibration and thrust to play");
  }
  command->callback([command, path, played, name, model] {
    std::vector<std::string> arguments = command->remaining();
    arguments.insert(arguments.begin(), name);
    if (!asks_for_text_only(arguments)) {
      if (!path->empty()) {
        arguments.insert(arguments.end(), {"--image", share_image(image_of_model(*path, *played))});
      } else if (model == TakesModel::always) {
        throw UsageError("--model FILE is needed");
      } else if (!played->faults.empty() || !played->disturbances.empty()) {
        throw UsageError("--faults and --disturbances need --model FILE, whose plant plays them");
      }
    }
    become_realtime_program(arguments);
  });
}

}  // namespace hotfire
