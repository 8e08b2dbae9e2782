// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <type_traits>

#include "firmware/session/option_table.hpp"

namespace hotfire::firmware {
namespace {

constexpr std::size_t kMeaningAt = 30;  ///< where the second column begins, as in the help of the host's commands
constexpr std::size_t kWidth = 100;     ///< no line is longer, unless a word is

/// What a mode does, how it is started, and examples of it, a line each.
struct ModeHelp {
  std::string_view mode;
  std::string_view purpose;
  std::string_view usage;
  std::string_view examples;
};

constexpr std::array kModes{
    ModeHelp{PlantOptions::mode,
             "Runs a model in real time. In every period it reads the newest command, steps the model and sends the sensor "
             "readings.",
             "hotfire plant --model FILE [OPTIONS], or hotfire-rt plant --image FILE [OPTIONS] on a target",
             "  hotfire plant --model simplex.toml --bus sim --cycles 10000 --cpu 1 --max-latency-us 200\n"
             "  hotfire plant --model simplex.toml --bus sim --record run.hfr\n"
             "  hotfire plant --model simplex.toml --bus can0 --sync can --actuators 8\n"
             "  hotfire plant --model vehicle.toml --bus can0 --sync can --strings\n"
             "  hotfire-rt plant --image plant.image --period-us 500\n"},
    ModeHelp{TimingOptions::mode,
             "Checks the timing of this machine. It runs a model without a bus and judges latencies, steps and overruns.",
             "hotfire timing [OPTIONS], or hotfire-rt timing [OPTIONS] on a target",
             "  hotfire timing --cycles 60000 --max-latency-us 100 --json\n"
             "  hotfire timing --find --seconds 60 --cpu 1\n"},
    ModeHelp{ControllerOptions::mode, "Commands a plant on a CAN bus, for a rig that has no controller of its own.",
             "hotfire controller --bus NAME [OPTIONS], or hotfire-rt controller --bus NAME [OPTIONS] on a target",
             "  hotfire controller --bus can0 --actuators 8 --cycles 10000\n"},
    ModeHelp{LabOptions::mode, "Drives real actuators through a profile, behind interlocks (docs/lab.md).",
             "hotfire lab --profile FILE --bus NAME --gpio CHIP --record FILE --confirm DIGEST [OPTIONS]",
             "  hotfire lab --profile sweep.toml --bus can0 --gpio rig --record run.hfr --confirm DIGEST\n"
             "  hotfire lab --profile sweep.toml --bus vcan0 --gpio gpio-sim.0-node0 --rehearsal\n"},
    ModeHelp{ReplayOptions::mode,
             "Steps the model of a recording, or the logic of a lab, with the recorded inputs and compares every bit.",
             "hotfire-rt replay RECORDING [--json]", "  hotfire-rt replay run.hfr\n"}};

/// An option that `hotfire` itself takes before it starts hotfire-rt.
struct HostOption {
  std::string_view name;
  std::string_view value;
  std::string_view meaning;
  std::array<std::string_view, 2> modes;
};

constexpr std::array kHostOptions{
    HostOption{"--model",
               "FILE",
               "model file (.toml) of one axis or of a vehicle, instead of --image",
               {PlantOptions::mode, TimingOptions::mode}},
    HostOption{"--profile", "FILE", "profile (.toml), instead of --image", {LabOptions::mode}},
    HostOption{"--faults",
               "FILE",
               "file of the faults that the plant simulates, by time (docs/real-time.md)",
               {PlantOptions::mode, TimingOptions::mode}},
    HostOption{"--disturbances",
               "FILE",
               "record whose torque, force, vibration and thrust act on the plant",
               {PlantOptions::mode, TimingOptions::mode}},
    HostOption{"--find", "", "search for the shortest period without an overrun", {TimingOptions::mode}},
    HostOption{"--seconds", "S", "with --find: time at each period [s]; default 5", {TimingOptions::mode}}};

/// Whether every mode takes an option that is a run: only these have the options of a loop.
bool takes_every_run(const OptionLine& line) {
  const auto takes = [&]<class... Own>(const std::variant<Own...>*) {
    std::size_t index = 0;
    return ((line.modes[index++] == std::is_base_of_v<RunOptions, Own>)&&...);
  };
  return takes(static_cast<const Options*>(nullptr));
}

bool takes(const OptionLine& line, std::string_view mode) {
  const auto found = std::find_if(kModes.begin(), kModes.end(), [&](const ModeHelp& one) { return one.mode == mode; });
  return found == kModes.end() || line.modes[static_cast<std::size_t>(found - kModes.begin())];
}

/// Two columns: an option with its value, and what it does, in lines of at most `kWidth`.
std::string entry(std::string_view name, std::string_view value, std::string_view meaning) {
  std::string line = std::string("  ").append(name).append(value.empty() ? "" : " ").append(value);
  std::string result;
  // A word that is too long for its line begins the next.
  line.resize(std::max(line.size() + 1, kMeaningAt), ' ');
  bool is_first = true;
  while (!meaning.empty()) {
    const std::size_t end = std::min(meaning.find(' '), meaning.size());
    if (!is_first && line.size() + 1 + end > kWidth) {
      result.append(line).append("\n");
      line.assign(kMeaningAt, ' ');
      is_first = true;
    }
    line.append(is_first ? "" : " ").append(meaning.substr(0, end));
    is_first = false;
    meaning.remove_prefix(std::min(end + 1, meaning.size()));
  }
  return result.append(line).append("\n");
}

std::string examples_of(std::string_view mode) {
  std::string result;
  for (const ModeHelp& one : kModes) {
    if (mode.empty() || one.mode == mode) {
      result.append(one.examples);
    }
  }
  return result;
}

/// The lines of options that `mode` takes. Without a mode each line begins with the modes that take the option.
std::string options_of(std::string_view mode) {
  std::string result;
  for (const OptionLine& line : option_lines()) {
    if (takes(line, mode)) {
      const std::string modes = mode.empty() && !takes_every_run(line) ? modes_of(line) + ": " : "";
      result += entry(line.name, line.value, modes + std::string(line.meaning));
    }
  }
  return result + entry("--help", "", "print this help") + entry("--version", "", "print the version");
}

std::string host_options_of(std::string_view mode) {
  std::string result;
  for (const HostOption& option : kHostOptions) {
    const bool is_taken = std::find(option.modes.begin(), option.modes.end(), mode) != option.modes.end();
    if (mode.empty() || is_taken) {
      std::string modes;
      for (const std::string_view one : option.modes) {
        modes.append(modes.empty() || one.empty() ? "" : ", ").append(one);
      }
      result += entry(option.name, option.value, (mode.empty() ? modes + ": " : "") + std::string(option.meaning));
    }
  }
  return result.empty() ? result : "\nOptions with `hotfire` only:\n" + result;
}

constexpr std::string_view kEndOfRun =
    "\nThe program ends on SIGINT, SIGTERM, SIGHUP and SIGQUIT and then prints its result.\n"
    "Exit status: 0 good; 1 bad verdict, or a stopped profile; 2 wrong use; 3 the bus cannot be used or was lost;\n"
    "4 a limit is not met, an overrun stopped the run, or required real time is missing; 5 interlock of a lab;\n"
    "6 the image is refused, or values of the plant are not finite.\n";
constexpr std::string_view kEndOfReplay =
    "\nExit status: 0 every recorded cycle has the same bits; 1 one differs, or is behind a gap; 2 wrong use;\n"
    "6 the file is refused.\n";
constexpr std::string_view kEndOfAny =
    "\nThe program ends on SIGINT, SIGTERM, SIGHUP and SIGQUIT and then prints its result.\n"
    "Exit status: 0 good; 1 bad verdict, a stopped profile, or a replay that differs; 2 wrong use; 3 the bus cannot be\n"
    "used or was lost; 4 a limit is not met, an overrun stopped the run, or required real time is missing; 5 interlock of\n"
    "a lab; 6 the image or recording is refused, or values of the plant are not finite.\n";

std::string help_of_every_mode() {
  std::string modes;
  for (const ModeHelp& one : kModes) {
    modes += entry(one.mode, "", one.purpose);
  }
  return "Runs a plant, a controller or a lab in real time, checks the timing of a machine, or replays a recording.\n"
         "Usage: hotfire-rt plant|timing|controller|lab [OPTIONS], or hotfire-rt replay RECORDING [--json]\n\n"
         "Modes; hotfire-rt MODE --help prints the options of one:\n" +
         modes + "\nExamples:\n" + examples_of("") + "\nOptions:\n" + options_of("") + host_options_of("") +
         std::string(kEndOfAny);
}

}  // namespace

std::string modes_of(const OptionLine& line) {
  std::string result;
  const auto add = [&]<class... Own>(const std::variant<Own...>*) {
    std::size_t index = 0;
    ((line.modes[index++] ? result.append(result.empty() ? "" : ", ").append(Own::mode) : result), ...);
  };
  add(static_cast<const Options*>(nullptr));
  return result;
}

std::string help_of(std::string_view mode) {
  const auto own = std::find_if(kModes.begin(), kModes.end(), [&](const ModeHelp& one) { return one.mode == mode; });
  if (own == kModes.end()) {
    return help_of_every_mode();
  }
  const bool is_replay = mode == ReplayOptions::mode;
  const std::string options = is_replay
                                  ? entry("--json", "", "print the result as JSON") + entry("--help", "", "print this help")
                                  : options_of(mode);
  return std::string(own->purpose)
      .append("\nUsage: ")
      .append(own->usage)
      .append("\n\nExamples:\n")
      .append(own->examples)
      .append("\nOptions:\n")
      .append(options)
      .append(host_options_of(mode))
      .append(is_replay ? kEndOfReplay : kEndOfRun);
}

}  // namespace hotfire::firmware
