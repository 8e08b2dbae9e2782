// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/rig/realtime_program.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "tools/cli/shared/plant_image.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

constexpr int kCannotStart = 127;  ///< exit status as a shell gives it

}  // namespace

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

ProgramOutput run_realtime_program(const std::vector<std::string>& arguments) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) {
    throw UsageError(fmt::format("cannot start hotfire-rt: {}", std::strerror(errno)));
  }
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) {
    throw UsageError(fmt::format("cannot start hotfire-rt: {}", std::strerror(errno)));
  }
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
    try {
      become_realtime_program(arguments);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "hotfire: %s\n", error.what());
    }
    _exit(kCannotStart);
  }
  close(ends[1]);
  ProgramOutput output;
  std::array<char, 4096> part{};
  for (ssize_t got = 0; (got = read(ends[0], part.data(), part.size())) != 0;) {
    if (got > 0) {
      output.text.append(part.data(), static_cast<std::size_t>(got));
    } else if (errno != EINTR) {
      break;
    }
  }
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  output.status = WIFEXITED(status) ? WEXITSTATUS(status) : kCannotStart;
  return output;
}

CLI::App* add_realtime_command(CLI::App& program, const std::string& name, const std::string& description, TakesModel model,
                               const RealtimeRun& run) {
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
  command->callback([command, path, played, name, model, run] {
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
    if (run) {
      run(arguments);
    } else {
      become_realtime_program(arguments);
    }
  });
  return command;
}

}  // namespace hotfire
