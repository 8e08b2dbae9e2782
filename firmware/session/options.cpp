// SPDX-License-Identifier: Apache-2.0
#include "firmware/session/options.hpp"

#include <algorithm>
#include <initializer_list>
#include <type_traits>

#include "firmware/service/status.hpp"
#include "firmware/session/option_table.hpp"

namespace hotfire::firmware {
namespace {

std::string_view mode_of(const Options& options) {
  return std::visit([]<class Own>(const Own&) { return Own::mode; }, options);
}

ParsedOptions wrong_use(const std::string& message) {
  return {std::nullopt, kWrongUse, "hotfire-rt: " + message + "; see hotfire-rt --help\n"};
}

/// The first text that says something.
std::string first_of(std::initializer_list<std::string> texts) {
  const auto found = std::find_if(texts.begin(), texts.end(), [](const std::string& text) { return !text.empty(); });
  return found == texts.end() ? std::string() : *found;
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
  if (!line->modes[options.index()]) {
    return name + " is not an option of " + std::string(mode_of(options)) + "; it is an option of " + modes_of(*line);
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
  ReplayOptions options;
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

/// The defaults of a mode; none for a word that is no mode, and for replay, which is parsed apart.
std::optional<Options> defaults_of(std::string_view mode) {
  std::optional<Options> options;
  const auto take = [&]<class Own>(std::type_identity<Own>) {
    if (mode == Own::mode) {
      options = Own{};
    }
  };
  take(std::type_identity<PlantOptions>{});
  take(std::type_identity<TimingOptions>{});
  take(std::type_identity<ControllerOptions>{});
  take(std::type_identity<LabOptions>{});
  return options;
}

// Each of these says why options that are each allowed contradict each other; empty if they do not.

std::string conflict_of_run(const RunOptions& options) {
  if (options.scheduler == Scheduler::deadline && options.priority == 0) {
    return "--scheduler deadline and --priority 0, an ordinary process, exclude each other";
  }
  if (options.scheduler == Scheduler::deadline && options.cpu) {
    return "--scheduler deadline and --cpu exclude each other: the kernel places such a thread itself";
  }
  return options.require_realtime && options.priority == 0 ? "--require-realtime and --priority 0 exclude each other" : "";
}

std::string conflict_of_image(const ImageOptions& options) {
  return !options.recording.empty() && options.image.empty()
             ? "--record needs a model, which becomes part of the recording: --model FILE, or --image FILE"
             : "";
}

std::string conflict_of_bus(const CanOptions& options, std::size_t actuators) {
  const can::Layout layout = frame_layout(options, actuators);
  if (options.on_can() && actuators > can::most_actuators(layout)) {
    return "--layout " + std::string(can::kLayouts[static_cast<std::size_t>(layout)]) + " has room for " +
           std::to_string(can::most_actuators(layout)) + " actuators: leave it out, or take fd-split for classic-split";
  }
  return {};
}

/// `layout`: none if the file of a vehicle or of a lab decides it.
std::string conflict_of_key(const CanOptions& options, std::optional<can::Layout> layout) {
  if (!options.key.empty() && (!options.on_can() || (layout && !can::is_fd(*layout)))) {
    return "--key needs frames with space for a code: --bus can0 --layout fd, or fd-split";
  }
  return {};
}

std::string conflict_of_mode(const PlantOptions& options) {
  if (options.image.empty()) {
    return "plant needs --image FILE, or start it as: hotfire plant --model M.toml";
  }
  if (options.strings && !options.on_can()) {
    return "--strings is of a plant on a CAN bus: plant --bus can0";
  }
  if (options.load_pressure && !options.on_can()) {
    return "--load-pressure is of a plant on a CAN bus: plant --bus can0";
  }
  if (options.pace == PaceKind::can && !options.on_can()) {
    return "--sync can needs the CAN bus that SYNC is on: --bus can0";
  }
  const bool is_layout_known = options.layout || options.actuators_given;
  return first_of({conflict_of_bus(options, options.actuators),
                   conflict_of_key(options, is_layout_known ? std::optional(frame_layout(options)) : std::nullopt),
                   conflict_of_image(options)});
}

std::string conflict_of_mode(const TimingOptions& options) {
  if (options.pace == PaceKind::can) {
    return "timing has no bus that SYNC could be on: --sync sim, or leave it out";
  }
  return conflict_of_image(options);
}

std::string conflict_of_mode(const ControllerOptions& options) {
  if (!options.on_can()) {
    return "controller needs a bus with a plant on it: --bus can0";
  }
  return first_of({conflict_of_bus(options, options.actuators), conflict_of_key(options, frame_layout(options))});
}

std::string conflict_of_mode(const LabOptions& options) {
  if (options.image.empty() || !options.on_can() || options.gpio.empty()) {
    return "lab needs a profile, a bus and lines: hotfire lab --profile P.toml --bus can0 --gpio CHIP";
  }
  if (options.loop.policy != OverrunPolicy::skip) {
    return "a lab always skips overdue cycles: leave --policy out";
  }
  if (!options.rehearsal && (options.recording.empty() || options.confirm.empty() || options.priority == 0)) {
    return "lab moves real actuators: it needs --record FILE, --confirm DIGEST, which 'hotfire check' prints, and real time "
           "(no --priority 0); on a virtual bus --rehearsal does without";
  }
  return conflict_of_key(options, std::nullopt);
}

std::string conflict_of_mode(const ReplayOptions&) { return {}; }

std::string conflict_in(const Options& options) {
  return std::visit(
      []<class Own>(const Own& own) {
        if constexpr (std::is_base_of_v<RunOptions, Own>) {
          return first_of({conflict_of_mode(own), conflict_of_run(own)});
        } else {
          return conflict_of_mode(own);
        }
      },
      options);
}

}  // namespace

ParsedOptions parse_options(const std::vector<std::string>& arguments) {
  const auto asked = [&](const char* name) {
    return std::find(arguments.begin(), arguments.end(), name) != arguments.end();
  };
  if (asked("--help") || asked("-h")) {
    return {std::nullopt, 0, help_of(arguments.size() > 1 ? arguments[1] : "")};
  }
  if (asked("--version")) {
    return {std::nullopt, 0, "hotfire-rt " HOTFIRE_VERSION "\n"};
  }
  if (arguments.size() > 1 && arguments[1] == "replay") {
    return parse_replay(arguments);
  }
  std::optional<Options> options = arguments.size() < 2 ? std::nullopt : defaults_of(arguments[1]);
  if (!options) {
    return wrong_use("the first argument is plant, timing, controller, lab or replay");
  }
  for (std::size_t i = 2; i < arguments.size(); ++i) {
    const std::string error = apply(arguments, i, *options);
    if (!error.empty()) {
      return wrong_use(error);
    }
  }
  const std::string conflict = conflict_in(*options);
  if (!conflict.empty()) {
    return wrong_use(conflict);
  }
  std::visit(
      [&]<class Own>(Own& own) {
        if constexpr (std::is_base_of_v<RunOptions, Own>) {
          own.command_line = joined(arguments);
        }
      },
      *options);
  return {options, 0, {}};
}

}  // namespace hotfire::firmware
