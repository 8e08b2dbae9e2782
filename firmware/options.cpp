#include "firmware/options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include "firmware/status.hpp"
#include "firmware/text.hpp"

namespace hotfire::firmware {
namespace {

/// Reads a value into the options; returns what is allowed if it is not.
using Reader = std::string (*)(const std::string& value, Options& options);

struct OptionLine {
  std::string_view name;
  std::string_view value;  ///< empty: a flag
  std::string_view meaning;
  Reader read;
};

template <class Integer>
std::string read_integer(const std::string& value, Integer lowest, Integer highest, Integer& result) {
  Integer read{};
  const char* const end = value.data() + value.size();
  const auto [stop, error] = std::from_chars(value.data(), end, read);
  if (error != std::errc{} || stop != end || read < lowest || read > highest) {
    return "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest);
  }
  result = read;
  return {};
}

std::string read_number(const std::string& value, double lowest, double highest, double& result) {
  char* end = nullptr;
  const double read = std::strtod(value.c_str(), &end);
  if (value.empty() || *end != '\0' || !(read >= lowest && read <= highest)) {
    return text("a number from %g to %g", lowest, highest);
  }
  result = read;
  return {};
}

template <class Names, class Enumeration>
std::string read_name(const std::string& value, const Names& names, Enumeration& result) {
  const auto found = std::find(names.begin(), names.end(), value);
  if (found == names.end()) {
    std::string allowed;
    for (const std::string_view name : names) {
      allowed.append(allowed.empty() ? "" : ", ").append(name);
    }
    return allowed;
  }
  result = static_cast<Enumeration>(found - names.begin());
  return {};
}

std::string read_period(const std::string& value, Options& options) {
  std::int64_t period_us = 0;
  std::string allowed = read_integer(value, kShortestPeriodNs / 1000, kLongestPeriodNs / 1000, period_us);
  options.loop.period_ns = period_us * 1000;
  return allowed;
}

std::string read_bus(const std::string& value, Options&) {
  return value == "sim" ? "" : "sim (no other bus is in this build)";
}

std::string read_cpu(const std::string& value, Options& options) {
  return read_integer(value, 0, 1023, options.cpu.emplace());
}

std::string read_max_latency(const std::string& value, Options& options) {
  return read_number(value, 0.0, 1e9, options.max_latency_us.emplace());
}

std::string read_max_step(const std::string& value, Options& options) {
  return read_number(value, 0.0, 1e9, options.max_step_us.emplace());
}

constexpr std::uint64_t kManyCycles = 1'000'000'000'000;

constexpr OptionLine kOptionLines[] = {
    {"--image", "FILE",
     "plant image; `hotfire plant --model M.toml` makes it from a model file. Without it\n"
     "`timing` runs the reference axis with every effect active",
     [](const std::string& value, Options& o) { return o.image = value, std::string(); }},
    {"--bus", "NAME", "bus to the controller: sim (commands from --command, no wire)", read_bus},
    {"--period-us", "N", "period, 250 to 10000; default 1000. Longer than 500 is split into equal steps", read_period},
    {"--cycles", "N", "end after N cycles, 0: when interrupted; default 0 for plant, 10000 for timing",
     [](const std::string& value, Options& o) { return read_integer(value, std::uint64_t{0}, kManyCycles, o.loop.cycles); }},
    {"--warm-up", "N", "cycles before those, counted apart; default 100",
     [](const std::string& value, Options& o) {
       return read_integer(value, std::uint64_t{0}, kManyCycles, o.loop.warm_up_cycles);
     }},
    {"--policy", "P", "after an overrun: catch-up (default), skip or stop",
     [](const std::string& value, Options& o) { return read_name(value, kOverrunPolicies, o.loop.policy); }},
    {"--priority", "P", "SCHED_FIFO priority, 1 to 99; 0: an ordinary process; default 80",
     [](const std::string& value, Options& o) { return read_integer(value, 0, 99, o.priority); }},
    {"--cpu", "C", "run on this CPU only", read_cpu},
    {"--require-realtime", "", "exit with 4, before the loop, if this machine does not allow real-time running",
     [](const std::string&, Options& o) { return o.require_realtime = true, std::string(); }},
    {"--max-latency-us", "X", "verdict: no wake-up later than this", read_max_latency},
    {"--max-step-us", "X", "verdict: no step of the model longer than this", read_max_step},
    {"--max-overruns", "N", "verdict: no more overruns than this; default 0 for timing, no limit for plant",
     [](const std::string& value, Options& o) {
       return read_integer(value, std::uint64_t{0}, kManyCycles, o.max_overruns.emplace());
     }},
    {"--actuators", "N", "plants of that model, 1 to 8, each with a command of its own; default 1",
     [](const std::string& value, Options& o) {
       return read_integer(value, std::size_t{1}, hal::kMaxActuators, o.actuators);
     }},
    {"--sync", "S", "what gives the cycles: clock (default), or sim (locked to simulated syncs)",
     [](const std::string& value, Options& o) { return read_name(value, kPaceKinds, o.pace); }},
    {"--max-missed-syncs", "N", "end after more than N in a row; default 10",
     [](const std::string& value, Options& o) {
       return read_integer(value, std::uint64_t{0}, kManyCycles, o.most_missed_syncs);
     }},
    {"--record", "FILE", "record every cycle, for `hotfire replay`, `explain` and `simulate`",
     [](const std::string& value, Options& o) { return o.recording = value, std::string(); }},
    {"--record-buffer-s", "X", "how long the disk may stall before cycles are dropped; default 8",
     [](const std::string& value, Options& o) { return read_number(value, 0.1, 600.0, o.record_buffer_s); }},
    {"--record-max-mib", "N", "end the recording, not the loop, at this size; default 16384",
     [](const std::string& value, Options& o) {
       return read_integer(value, std::uint64_t{1}, std::uint64_t{1} << 24, o.record_max_mib);
     }},
    {"--max-dropped", "N", "verdict: no more cycles than this missing in the recording; default 0",
     [](const std::string& value, Options& o) { return read_integer(value, std::uint64_t{0}, kManyCycles, o.max_dropped); }},
    {"--command", "SHAPE", "what bus sim commands: steps (default), sine or rest",
     [](const std::string& value, Options& o) {
       return read_name(value, hal::sim::CommandSource::kShapes, o.source.shape);
     }},
    {"--amplitude", "X", "of the command, in the plant's unit (rad, or the record's force); default 0.01",
     [](const std::string& value, Options& o) { return read_number(value, -1e9, 1e9, o.source.amplitude); }},
    {"--frequency", "HZ", "of the command; default 0.5",
     [](const std::string& value, Options& o) { return read_number(value, 0.0, 1000.0, o.source.frequency); }},
    {"--json", "", "print the result as JSON, shaped as cyclictest's",
     [](const std::string&, Options& o) { return o.json = true, std::string(); }}};

std::string help() {
  std::string result =
      "The engine in real time: every period the newest command is read, the model stepped, its reading sent.\n\n"
      "  hotfire plant --model simplex.toml --bus sim --cycles 10000 --cpu 1 --max-latency-us 200\n"
      "  hotfire timing --cycles 60000 --max-latency-us 100 --json\n"
      "  hotfire plant --model simplex.toml --record run.hfr\n"
      "  hotfire-rt plant --image plant.image --period-us 500\n"
      "  hotfire-rt replay run.hfr\n\n";
  for (const OptionLine& line : kOptionLines) {
    std::string meaning(line.meaning);
    if (const std::size_t at = meaning.find('\n'); at != std::string::npos) {
      meaning.insert(at + 1, 25, ' ');
    }
    result += text("  %-22s ", (std::string(line.name) + " " + std::string(line.value)).c_str()) + meaning + "\n";
  }
  return result +
         "  --model FILE           with `hotfire` only: the model file, checked there and handed over as an image\n"
         "  --faults FILE          with `hotfire` only: faults that the plant plays, by time (docs/real-time.md)\n"
         "  --help, --version\n\n"
         "Ends on SIGINT and SIGTERM with its result. Exit status: 0 good, 2 wrong use, 4 a limit is not met, stopped by "
         "an\n"
         "overrun, or no real time where it is required, 6 the image is refused or the plant's values are not finite.\n";
}

ParsedOptions wrong_use(const std::string& message) {
  return {std::nullopt, kWrongUse, "hotfire-rt: " + message + "; see hotfire-rt --help\n"};
}

/// Applies the argument at `i`, and moves `i` onto its value if that is an argument of its own.
std::string apply(const std::vector<std::string>& arguments, std::size_t& i, Options& options) {
  const std::size_t equals = std::min(arguments[i].find('='), arguments[i].size());
  const std::string name = arguments[i].substr(0, equals);
  const auto* const line =
      std::find_if(std::begin(kOptionLines), std::end(kOptionLines), [&](const OptionLine& l) { return l.name == name; });
  if (line == std::end(kOptionLines)) {
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
  if (arguments.size() < 2 || (arguments[1] != "plant" && arguments[1] != "timing")) {
    return wrong_use("the first argument is plant, timing or replay");
  }
  if (arguments[1] == "timing") {
    options.mode = Mode::timing;
    options.loop.cycles = 10'000;
    options.max_overruns = 0;
  }
  for (std::size_t i = 2; i < arguments.size(); ++i) {
    const std::string error = apply(arguments, i, options);
    if (!error.empty()) {
      return wrong_use(error);
    }
  }
  if (options.mode == Mode::plant && options.image.empty()) {
    return wrong_use("plant needs --image FILE, or start it as: hotfire plant --model M.toml");
  }
  if (!options.recording.empty() && options.image.empty()) {
    return wrong_use("--record needs a model, which becomes part of the recording: --model FILE, or --image FILE");
  }
  if (options.require_realtime && options.priority == 0) {
    return wrong_use("--require-realtime and --priority 0 exclude each other");
  }
  options.command_line = joined(arguments);
  return {options, 0, {}};
}

}  // namespace hotfire::firmware
