// SPDX-License-Identifier: Apache-2.0
#include "firmware/session/options.hpp"

#include <algorithm>

#include "firmware/service/status.hpp"
#include "firmware/session/option_table.hpp"
#include "firmware/text/text.hpp"

namespace hotfire::firmware {
namespace {

std::string help() {
  std::string result =
      "The engine in real time: every period the newest command is read, the model stepped, its reading sent.\n\n"
      "  hotfire plant --model simplex.toml --bus sim --cycles 10000 --cpu 1 --max-latency-us 200\n"
      "  hotfire timing --cycles 60000 --max-latency-us 100 --json\n"
      "  hotfire plant --model simplex.toml --record run.hfr\n"
      "  hotfire plant --model simplex.toml --bus can0 --sync can --actuators 8\n"
      "  hotfire plant --model vehicle.toml --bus can0 --sync can --strings\n"
      "  hotfire lab --profile sweep.toml --bus can0 --gpio rig --record run.hfr --confirm DIGEST\n"
      "  hotfire-rt controller --bus can0 --actuators 8 --cycles 10000\n"
      "  hotfire-rt plant --image plant.image --period-us 500\n"
      "  hotfire-rt replay run.hfr\n\n";
  for (const OptionLine& line : option_lines()) {
    std::string meaning(line.meaning);
    if (const std::size_t at = meaning.find('\n'); at != std::string::npos) {
      meaning.insert(at + 1, 25, ' ');
    }
    result += text("  %-22s ", (std::string(line.name) + " " + std::string(line.value)).c_str()) + meaning + "\n";
  }
  return result +
         "  --model FILE           with `hotfire` only: the model file, checked there and handed over as an image\n"
         "  --profile FILE         with `hotfire lab` only: the profile (docs/lab.md)\n"
         "  --faults FILE          with `hotfire` only: faults that the plant plays, by time (docs/real-time.md)\n"
         "  --disturbances FILE    with `hotfire` only: record whose torque, force, vibration and thrust the plant plays\n"
         "  --help, --version\n\n"
         "Ends on SIGINT, SIGTERM, SIGHUP and SIGQUIT with its result. Exit status: 0 good, 2 wrong use, 3 the bus cannot "
         "be used or was "
         "lost,\n"
         "4 a limit is not met, stopped by an overrun, or no real time where it is required, 5 a lab's interlock, 6 the "
         "image\n"
         "is refused or the plant's values are not finite.\n";
}

ParsedOptions wrong_use(const std::string& message) {
  return {std::nullopt, kWrongUse, "hotfire-rt: " + message + "; see hotfire-rt --help\n"};
}

/// Applies the argument at `i`, and moves `i` onto its value if that is an argument of its own.
std::string apply(const std::vector<std::string>& arguments, std::size_t& i, Options& options) {
  const std::size_t equals = std::min(arguments[i].find('='), arguments[i].size());
  const std::string name = arguments[i].substr(0, equals);
  const std::span<const OptionLine> lines = option_lines();
  const auto line = std::find_if(lines.begin(), lines.end(), [&](const OptionLine& one) { return one.name == name; });
  if (line == lines.end()) {
    return "unknown argument " + arguments[i];
  }
  const bool has_own_value = equals < arguments[i].size();
  if (line->value.empty()) {
    return has_own_value ? name + " takes no value" : line->read("", options);
  }
  if (!has_own_value && i + 1 == arguments.size()) {
    return name + " needs a value";
  }
  const std::string value = has_own_value ? arguments[i].substr(equals + 1) : arguments[++i];
  const std::string allowed = line->read(value, options);
  return allowed.empty() ? "" : name + " " + value + ": allowed is " + allowed;
}

std::string joined(const std::vector<std::string>& arguments) {
  std::string line;
  for (const std::string& argument : arguments) {
    line += (line.empty() ? "" : " ") + argument;
  }
  return line;
}

ParsedOptions parse_replay(const std::vector<std::string>& arguments) {
  Options options;
  options.mode = Mode::replay;
  options.command_line = joined(arguments);
  for (std::size_t i = 2; i < arguments.size(); ++i) {
    if (arguments[i] == "--json") {
      options.json = true;
    } else if (arguments[i].starts_with("-") || !options.recording.empty()) {
      return wrong_use("replay takes one recording and --json; unknown argument " + arguments[i]);
    } else {
      options.recording = arguments[i];
    }
  }
  if (options.recording.empty()) {
    return wrong_use("replay needs a recording, as `plant --record FILE` writes it");
  }
  return {options, 0, {}};
}

bool read_mode(const std::string& word, Options& options) {
  if (word == "timing") {
    options.mode = Mode::timing;
    options.loop.cycles = 10'000;
    options.max_overruns = 0;
  } else if (word == "controller") {
    options.mode = Mode::controller;
  } else if (word == "lab") {
    options.mode = Mode::lab;
    // Commands that were not sent in time are not sent at all.
    options.loop.policy = OverrunPolicy::skip;
  }
  return word == "plant" || options.mode != Mode::plant;
}

/// What options of a lab say together that cannot be.
std::string conflict_in_lab(const Options& options) {
  if (options.mode == Mode::lab && (options.image.empty() || !options.on_can() || options.gpio.empty())) {
    return "lab needs a profile, a bus and lines: hotfire lab --profile P.toml --bus can0 --gpio CHIP";
  }
  if (options.mode == Mode::lab && (options.pace != PaceKind::clock || options.loop.policy != OverrunPolicy::skip)) {
    return "lab keeps its own time and leaves out what is overdue: leave --sync and --policy out";
  }
  if (options.mode == Mode::lab && !options.rehearsal &&
      (options.recording.empty() || options.confirm.empty() || options.priority == 0)) {
    return "lab moves real actuators: it needs --record FILE, --confirm DIGEST, which 'hotfire check' prints, and real time "
           "(no --priority 0); on a virtual bus --rehearsal does without";
  }
  if (options.mode != Mode::lab && (options.rehearsal || !options.confirm.empty())) {
    return "--confirm and --rehearsal are of a lab";
  }
  return {};
}

/// What options that are each allowed say together that cannot be.
std::string conflict_in(const Options& options) {
  const can::Layout layout = options.frame_layout();
  if (options.mode == Mode::plant && options.image.empty()) {
    return "plant needs --image FILE, or start it as: hotfire plant --model M.toml";
  }
  if (options.mode == Mode::timing && options.on_can()) {
    return "timing needs no bus: leave --bus out";
  }
  if (std::string conflict = conflict_in_lab(options); !conflict.empty()) {
    return conflict;
  }
  if (options.mode == Mode::controller && !options.on_can()) {
    return "controller needs a bus with a plant on it: --bus can0";
  }
  if (options.mode == Mode::controller && options.pace == PaceKind::can) {
    return "the controller sends SYNC itself: leave --sync out";
  }
  if (options.strings && (options.mode != Mode::plant || !options.on_can())) {
    return "--strings is of a plant on a CAN bus: plant --bus can0";
  }
  if (options.load_pressure && (options.mode != Mode::plant || !options.on_can())) {
    return "--load-pressure is of a plant on a CAN bus: plant --bus can0; a lab takes load pressures if its profile has "
           "limits.load_pressure";
  }
  if (options.pace == PaceKind::can && !options.on_can()) {
    return "--sync can needs the CAN bus that SYNC is on: --bus can0";
  }
  if (options.on_can() && options.actuators > can::most_actuators(layout)) {
    return "--layout " + std::string(can::kLayouts[static_cast<std::size_t>(layout)]) + " has room for " +
           std::to_string(can::most_actuators(layout)) + " actuators: leave it out, or take fd-split for classic-split";
  }
  if (!options.key.empty() && !(options.on_can() && (options.mode == Mode::lab || can::is_fd(layout)))) {
    return "--key needs frames with space for a code: --bus can0 --layout fd, or fd-split";
  }
  if (!options.recording.empty() && options.image.empty()) {
    return "--record needs a model, which becomes part of the recording: --model FILE, or --image FILE";
  }
  if (options.require_realtime && options.priority == 0) {
    return "--require-realtime and --priority 0 exclude each other";
  }
  return {};
}

}  // namespace

ParsedOptions parse_options(const std::vector<std::string>& arguments) {
  const auto asked = [&](const char* name) {
    return std::find(arguments.begin(), arguments.end(), name) != arguments.end();
  };
  if (asked("--help") || asked("-h")) {
    return {std::nullopt, 0, help()};
  }
  if (asked("--version")) {
    return {std::nullopt, 0, "hotfire-rt " HOTFIRE_VERSION "\n"};
  }
  if (arguments.size() > 1 && arguments[1] == "replay") {
    return parse_replay(arguments);
  }
  Options options;
  if (arguments.size() < 2 || !read_mode(arguments[1], options)) {
    return wrong_use("the first argument is plant, timing, controller, lab or replay");
  }
  for (std::size_t i = 2; i < arguments.size(); ++i) {
    const std::string error = apply(arguments, i, options);
    if (!error.empty()) {
      return wrong_use(error);
    }
  }
  const std::string conflict = conflict_in(options);
  if (!conflict.empty()) {
    return wrong_use(conflict);
  }
  options.command_line = joined(arguments);
  return {options, 0, {}};
}

}  // namespace hotfire::firmware
