// SPDX-License-Identifier: Apache-2.0
#include "firmware/session/option_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <type_traits>

#include "firmware/text/text.hpp"

namespace hotfire::firmware {
namespace {

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

std::string read_period(const std::string& value, RunOptions& options) {
  std::int64_t period_us = 0;
  std::string allowed = read_integer(value, kShortestPeriodNs / 1000, kLongestPeriodNs / 1000, period_us);
  options.loop.period_ns = period_us * 1000;
  return allowed;
}

std::string read_bus(const std::string& value, CanOptions& options) {
  options.bus = value;
  return value.empty() ? "sim, or the name of a CAN interface" : "";
}

std::string read_layout(const std::string& value, CanOptions& options) {
  return read_name(value, can::kLayouts, options.layout.emplace());
}

std::string read_cpu(const std::string& value, RunOptions& options) {
  return read_integer(value, 0, 1023, options.cpu.emplace());
}

std::string read_max_latency(const std::string& value, RunOptions& options) {
  return read_number(value, 0.0, 1e9, options.max_latency_us.emplace());
}

std::string read_max_step(const std::string& value, RunOptions& options) {
  return read_number(value, 0.0, 1e9, options.max_step_us.emplace());
}

constexpr std::uint64_t kManyCycles = 1'000'000'000'000;

/// What nobody sees: `modes` is asked before a value is read.
constexpr std::string_view kOfAnotherMode = "an option of this mode";

/// The line of an option. A mode takes it if `Read(value, options)` accepts the options of that mode.
template <auto Read>
constexpr OptionLine line(std::string_view name, std::string_view value, std::string_view meaning) {
  const auto read = [](const std::string& given, Options& options) {
    return std::visit(
        [&given]<class Own>(Own& own) {
          if constexpr (std::is_invocable_v<decltype(Read), const std::string&, Own&>) {
            return Read(given, own);
          } else {
            return std::string(kOfAnotherMode);
          }
        },
        options);
  };
  const auto modes = []<class... Own>(const std::variant<Own...>*) {
    return std::array{std::is_invocable_v<decltype(Read), const std::string&, Own&>...};
  };
  return {name, value, meaning, read, modes(static_cast<const Options*>(nullptr))};
}

constexpr OptionLine kLines[] = {
    line<[](const std::string& value, ImageOptions& o) { return o.image = value, std::string(); }>(
        "--image", "FILE",
        "image of a model or profile, as `hotfire export --image` writes it; default of timing: the reference axis with "
        "every effect active"),
    line<read_bus>(
        "--bus", "NAME",
        "CAN interface such as can0, or sim: a plant without a bus that takes the commands of --command; default sim"),
    line<[](const std::string& value, LabOptions& o) { return o.gpio = value, std::string(value.empty() ? "a chip" : ""); }>(
        "--gpio", "CHIP", "GPIO chip, by path, name or label"),
    line<[](const std::string& value, LabOptions& o) { return o.confirm = value, std::string(); }>(
        "--confirm", "DIGEST",
        "digest of the profile, as `hotfire check` prints it: confirms that you have read the profile"),
    line<[](const std::string&, LabOptions& o) { return o.rehearsal = true, std::string(); }>(
        "--rehearsal", "",
        "dry run on a virtual CAN interface and a simulated GPIO chip: needs no real time, no --record and no --confirm"),
    line<read_layout>("--layout", "L",
                      "layout of the CAN frames: classic (at most two actuators), fd, classic-split or fd-split (each "
                      "reading of a piston in a frame of its own); default: the smallest with room for the actuators"),
    line<[](const std::string& value, CurrentOptions& o) { return read_number(value, 1e-6, 1e6, o.command_per_current); }>(
        "--command-per-current", "X", "command that a servovalve current on a CAN bus represents [rad/A]; default 10"),
    line<[](const std::string& value, PlantOptions& o) { return read_number(value, 1.0, 1e6, o.command_age_ms); }>(
        "--command-age-ms", "X", "largest age of a command on a CAN bus [ms]; an older one gives no current; default 100"),
    line<[](const std::string& value, PlantOptions& o) { return read_number(value, 1.0, 1e6, o.heartbeat_age_ms); }>(
        "--heartbeat-age-ms", "X",
        "largest age of the last HEARTBEAT [ms]; with an older one the valves get no current. Before the first HEARTBEAT, "
        "the age of the first command counts; default 50"),
    line<[](const std::string&, PlantOptions& o) { return o.heartbeat_optional = true, std::string(); }>(
        "--heartbeat-optional", "",
        "accept a controller that never sends HEARTBEAT; a HEARTBEAT that stops later is still a fault"),
    line<[](const std::string& value, CanOptions& o) { return o.key = value, std::string(value.empty() ? "a file" : ""); }>(
        "--key", "FILE",
        "file with the key that authenticates commands and readings, 32 hexadecimal digits; FD layouts only"),
    line<[](const std::string& value, CanOptions& o) { return read_number(value, 1.0, 60'000.0, o.freshness_ms); }>(
        "--freshness-ms", "X", "allowed difference between the clocks of two nodes that share a key [ms]; default 1000"),
    line<[](const std::string& value, CanOptions& o) { return read_number(value, 1e4, 1e6, o.bit_rate); }>(
        "--bit-rate", "N", "bit rate of the CAN bus [bit/s], for the check of its load; default: that of the interface"),
    line<[](const std::string& value, CanOptions& o) { return read_number(value, 1e4, 8e6, o.data_bit_rate); }>(
        "--data-bit-rate", "N", "bit rate of the data of FD frames [bit/s]; default: that of the interface"),
    line<[](const std::string& value, CanOptions& o) {
      return read_integer(value, std::uint64_t{0}, kManyCycles, o.max_lost.emplace());
    }>("--max-lost", "N",
       "verdict: at most N frames lost, repeated, refused or out of order on a CAN bus; default: no limit"),
    line<read_period>(
        "--period-us", "N",
        "period of the loop [us], 50 to 10000; default 1000. A period above 500 is split into equal steps of the model"),
    line<[](const std::string& value, RunOptions& o) {
      return read_integer(value, std::uint64_t{0}, kManyCycles, o.loop.cycles);
    }>("--cycles", "N", "end after N cycles; 0: run until interrupted; default 10000 for timing, else 0"),
    line<[](const std::string& value, RunOptions& o) {
      return read_integer(value, std::uint64_t{0}, kManyCycles, o.loop.warm_up_cycles);
    }>("--warm-up", "N", "cycles before those of --cycles; verdicts leave them out; default 100"),
    line<[](const std::string& value, RunOptions& o) { return read_name(value, kOverrunPolicies, o.loop.policy); }>(
        "--policy", "P", "reaction to an overrun: catch-up, skip or stop; default catch-up. A lab always skips"),
    line<[](const std::string& value, RunOptions& o) { return read_integer(value, 0, 99, o.priority); }>(
        "--priority", "P", "priority of the loop under SCHED_FIFO, 1 to 99; 0: an ordinary process; default 80"),
    line<[](const std::string& value, RunOptions& o) { return read_name(value, kSchedulers, o.scheduler); }>(
        "--scheduler", "S",
        "fifo (default) or deadline: the kernel gives each cycle 90 % of its period, before all other threads"),
    line<read_cpu>("--cpu", "C", "run on this CPU only; default: any"),
    line<[](const std::string&, RunOptions& o) { return o.require_realtime = true, std::string(); }>(
        "--require-realtime", "", "exit with status 4 before the loop if this machine does not allow real-time running"),
    line<read_max_latency>("--max-latency-us", "X", "verdict: no wake-up later than X [us]; default: no limit"),
    line<read_max_step>("--max-step-us", "X", "verdict: no step of the model longer than X [us]; default: no limit"),
    line<[](const std::string& value, RunOptions& o) {
      return read_integer(value, std::uint64_t{0}, kManyCycles, o.max_overruns.emplace());
    }>("--max-overruns", "N", "verdict: at most N overruns; default 0 for timing, else no limit"),
    line<[](const std::string& value, CommandedRunOptions& o) {
      o.actuators_given = true;
      return read_integer(value, std::size_t{1}, hal::kMaxActuators, o.actuators);
    }>("--actuators", "N",
       "number of plants of a model of one axis, 1 to 8, each with its own command; default 1. A vehicle (taos, masv) has "
       "one for each axis, without --actuators"),
    line<[](const std::string&, PlantOptions& o) { return o.strings = true, std::string(); }>(
        "--strings", "",
        "on a CAN bus: send the readings of string potentiometers too, four for each engine. Actuators 1 and 2 are pitch "
        "and yaw of engine 1, 3 and 4 those of engine 2, and so on"),
    line<[](const std::string&, PlantOptions& o) { return o.load_pressure = true, std::string(); }>(
        "--load-pressure", "",
        "on a CAN bus: send the pressure difference across every piston too, for a lab whose profile has "
        "limits.load_pressure"),
    line<[](const std::string& value, PlantRunOptions& o) { return read_name(value, kPaceKinds, o.pace); }>(
        "--sync", "S", "trigger of each cycle: clock (default), sim (simulated SYNC) or can (SYNC frames of the bus)"),
    line<[](const std::string& value, PlantRunOptions& o) {
      return read_integer(value, std::uint64_t{0}, kManyCycles, o.most_missed_syncs);
    }>("--max-missed-syncs", "N", "end after more than N missed SYNCs in a row; default 10"),
    line<[](const std::string& value, PlantRunOptions& o) {
      return read_number(value, 0.0, 1e6, o.sync_patience_ms.emplace());
    }>("--sync-patience-ms", "X",
       "longest wait for a late SYNC [ms]; then the cycle runs without it; default: half a period"),
    line<[](const std::string&, ControllerOptions& o) { return o.lockstep = true, std::string(); }>(
        "--lockstep", "", "begin each cycle after the plant has answered the previous one"),
    line<[](const std::string& value, ImageOptions& o) { return o.recording = value, std::string(); }>(
        "--record", "FILE", "record every cycle into this file, for `hotfire replay`, `explain` and `simulate`"),
    line<[](const std::string&, ImageOptions& o) { return o.overwrite = true, std::string(); }>(
        "--overwrite", "", "replace an existing file that --record names; without this option such a file is refused"),
    line<[](const std::string& value, ImageOptions& o) { return read_number(value, 0.1, 600.0, o.record_buffer_s); }>(
        "--record-buffer-s", "X", "longest disk stall that the buffer covers [s]; a longer one drops cycles; default 8"),
    line<[](const std::string& value, ImageOptions& o) {
      return read_integer(value, std::uint64_t{1}, std::uint64_t{1} << 24, o.record_max_mib);
    }>("--record-max-mib", "N",
       "largest size of the recording [MiB]; the recording then ends and the loop goes on; default 16384"),
    line<[](const std::string& value, ImageOptions& o) {
      return read_integer(value, std::uint64_t{0}, kManyCycles, o.max_dropped);
    }>("--max-dropped", "N", "verdict: at most N cycles missing in the recording; default 0"),
    line<[](const std::string& value, RunOptions& o) {
      return o.live_view = value, std::string(value.empty() ? "a file" : "");
    }>("--watch", "FILE", "live view: file below /dev/shm or /run, which `hotfire watch FILE` shows in a browser"),
    line<[](const std::string& value, CommandedRunOptions& o) {
      return read_name(value, hal::sim::CommandSource::kShapes, o.source.shape);
    }>("--command", "SHAPE",
       "command that the program generates with --bus sim or as the controller: steps (default), sine or rest"),
    line<[](const std::string& value, CommandedRunOptions& o) { return read_number(value, -1e9, 1e9, o.source.amplitude); }>(
        "--amplitude", "X",
        "amplitude of that command, in the unit of the model's input: rad, or the force of a direct model; default 0.01"),
    line<[](const std::string& value, CommandedRunOptions& o) {
      return read_number(value, 0.0, 1000.0, o.source.frequency);
    }>("--frequency", "HZ", "frequency of that command [Hz]; default 0.5"),
    line<[](const std::string&, RunOptions& o) { return o.json = true, std::string(); }>(
        "--json", "", "print the result as JSON, in the form of cyclictest")};

}  // namespace

std::span<const OptionLine> option_lines() { return kLines; }

}  // namespace hotfire::firmware
