// SPDX-License-Identifier: Apache-2.0
#include "firmware/lab/lab_image.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/image/image_entries.hpp"

namespace hotfire::firmware {
namespace {

constexpr double kLargest = 1e9;
constexpr double kSmallest = 1e-9;

/// What is done within this time is one act of a person, whose hand, sleeve or button may shake: it can arm or start, not
/// both. No profile may ask for less [s].
constexpr double kOneAct = 1.0;
/// No node sends a message more often: a classic frame of eight bytes takes longer at 1 Mbit/s [s].
constexpr double kShortestReadingPeriod = 1e-4;
/// Frames of a message that a cycle looks at, so that those of every message have room (hal::kMaxCanArrivals).
constexpr double kMostReadingsInAPeriod = 32.0;
/// Contacts of buttons bounce for some milliseconds [s].
constexpr double kShortestDebounce = 0.005;

std::uint32_t read_cycles(Entries& entries, const char* key, double least, double most, double period) {
  return static_cast<std::uint32_t>(std::ceil(read_bounded(entries, key, least, most, "s") / period));
}

void read_interlock(Entries& entries, InterlockSettings& settings, double period) {
  settings.start_is_arm = !entries.has("line.start");
  settings.debounce = read_cycles(entries, "interlock.debounce", kShortestDebounce, kOneAct, period);
  // A hold lasts from the first cycle that is on to the last.
  settings.start_hold =
      1 + read_cycles(entries, "interlock.start_hold", settings.start_is_arm ? kOneAct : 0.0, 60.0, period);
  settings.longest_press = 1 + read_cycles(entries, "interlock.longest_press", kOneAct, 600.0, period);
  settings.least_armed = read_cycles(entries, "interlock.least_armed", kOneAct, 600.0, period);
  settings.most_armed = read_cycles(entries, "interlock.arming_timeout", 2.0 * kOneAct, 3600.0, period);
  settings.most_stopping = static_cast<std::uint32_t>(read_bounded(entries, "stopping_time", 0.0, 600.0, "s") / period);
  if (settings.start_hold >= settings.longest_press) {
    entries.refuse("interlock.start_hold is not below interlock.longest_press: no press would start");
  }
  if (settings.least_armed + settings.start_hold >= settings.most_armed) {
    entries.refuse("interlock.arming_timeout is over before least_armed and start_hold are: no press would start");
  }
}

void read_settings(Entries& entries, LabSettings& settings) {
  settings.actuators = static_cast<std::size_t>(read_bounded(entries, "actuators", 1.0, hal::kMaxActuators, ""));
  settings.piston_per_command = read_bounded(entries, "piston_per_command", kSmallest, kLargest, "m/rad");
  settings.current_per_command = read_bounded(entries, "current_per_command", 0.0, kLargest, "A/rad");
  settings.current_per_error = read_bounded(entries, "current_per_error", 0.0, kLargest, "A/m");
  settings.current_limit = read_bounded(entries, "current_limit", kSmallest, 0.032, "A");
  settings.approach_rate = read_bounded(entries, "approach_rate", kSmallest, kLargest, "rad/s");
  settings.rest_speed = read_bounded(entries, "rest_speed", kSmallest, kLargest, "m/s");
  settings.most_overruns = static_cast<std::uint64_t>(read_bounded(entries, "limits.overruns", 0.0, kLargest, ""));
  if (settings.current_per_command == 0.0 && settings.current_per_error == 0.0) {
    entries.refuse("current_per_command and current_per_error are both 0: no command would move anything");
  }
}

/// A limit that each actuator has for itself.
template <class Put>
void read_each(Entries& entries, const char* key, double lower, double upper, std::string_view unit, std::size_t actuators,
               Put&& put) {
  PerActuator values{};
  read_list(entries, key, lower, upper, unit, std::span(values).first(actuators));
  for (std::size_t i = 0; i < actuators; ++i) {
    put(i, values[i]);
  }
}

void read_actuator_limits(Entries& entries, FaultLimits& limits, std::size_t actuators) {
  const auto read = [&](const char* key, double lower, const char* unit, double ActuatorLimits::*limit,
                        double upper = kLargest) {
    read_each(entries, key, lower, upper, unit, actuators,
              [&](std::size_t i, double value) { limits.actuators[i].*limit = value; });
  };
  read_each(entries, "limits.reading_age", 0.0, 600.0, "s", actuators, [&](std::size_t i, double value) {
    limits.actuators[i].reading_age_ns = static_cast<std::int64_t>(1e9 * value);
  });
  read("limits.lowest_position", -kLargest, "m", &ActuatorLimits::lowest_position);
  read("limits.highest_position", -kLargest, "m", &ActuatorLimits::highest_position);
  read("limits.speed", kSmallest, "m/s", &ActuatorLimits::speed);
  if (entries.has("limits.load_pressure")) {
    read("limits.load_pressure", kSmallest, "Pa", &ActuatorLimits::load_pressure, kMostLoadPressure);
  }
  for (std::size_t i = 0; i < actuators; ++i) {
    if (limits.actuators[i].lowest_position > limits.actuators[i].highest_position) {
      entries.refuse(text("limits.lowest_position of actuator %zu is above its highest_position", i + 1));
    }
  }
}

/// After the limits of the actuators.
void read_reading_period(Entries& entries, FaultLimits& limits, std::size_t actuators, double period) {
  constexpr const char* kKey = "limits.reading_period";
  if (!entries.has(kKey)) {
    return;
  }
  limits.readings_answer_sync = entries.take(kKey)->value == "sync";
  if (limits.readings_answer_sync) {
    return;
  }
  const double every = read_bounded(entries, kKey, kShortestReadingPeriod, 600.0, "s");
  limits.reading_period_ns = static_cast<std::int64_t>(1e9 * every);
  if (period > kMostReadingsInAPeriod * every) {
    entries.refuse(text("%s = %g s is more than %g frames of a message in a period of %g s", kKey, every,
                        kMostReadingsInAPeriod, period));
  }
  for (std::size_t i = 0; i < actuators; ++i) {
    if (limits.reading_period_ns > limits.actuators[i].reading_age_ns) {
      entries.refuse(text("%s is above limits.reading_age of actuator %zu: its readings would be stale", kKey, i + 1));
      return;
    }
  }
}

void read_limits(Entries& entries, FaultLimits& limits, std::size_t actuators, double period) {
  const auto cycles = [&](const char* key, double most) {
    return static_cast<std::uint64_t>(read_bounded(entries, key, 0.0, most, "s") / period);
  };
  limits.command_age_ns = static_cast<std::int64_t>(1e9 * read_bounded(entries, "limits.command_age", 0.0, 600.0, "s"));
  limits.lowest_reading = read_bounded(entries, "limits.lowest_reading", -kLargest, kLargest, "m");
  limits.highest_reading = read_bounded(entries, "limits.highest_reading", limits.lowest_reading, kLargest, "m");
  limits.disagreement = read_bounded(entries, "limits.disagreement", 0.0, kLargest, "m");
  limits.command_rate = read_bounded(entries, "limits.command_rate", 0.0, kLargest, "m/s");
  limits.position_error = read_bounded(entries, "limits.position_error", 0.0, kLargest, "m");
  limits.position_error_cycles = cycles("limits.position_error_time", 600.0);
  const double longest = static_cast<double>(FaultLimits::kMostSpeedCycles) * period;
  limits.speed_cycles = std::max<std::uint64_t>(1, cycles("limits.speed_time", longest));
  limits.read_back_cycles = cycles("limits.read_back_time", 10.0);
  read_actuator_limits(entries, limits, actuators);
  read_reading_period(entries, limits, actuators, period);
}

LabLines read_lines(Entries& entries) {
  LabLines lines;
  const auto read = [&](const char* key, std::string& line, bool needed = true) {
    const Entry* entry = needed || entries.has(key) ? entries.take(key) : nullptr;
    line = entry == nullptr ? std::string() : entry->value;
  };
  read("line.emergency_stop", lines.emergency_stop);
  read("line.hydraulic_enable", lines.hydraulic_enable);
  read("line.arm", lines.arm);
  read("line.start", lines.start, false);
  read("line.supply_read_back", lines.supply_read_back, false);
  read("line.fault_read_back", lines.fault_read_back, false);
  read("line.supply", lines.supply);
  read("line.heartbeat", lines.heartbeat);
  read("line.fault", lines.fault);
  return lines;
}

std::vector<Segment> read_segments(Entries& entries, std::size_t actuators) {
  std::vector<Segment> segments;
  for (std::string prefix = "segment.0."; entries.has(prefix + "duration"); prefix = text("segment.%zu.", segments.size())) {
    const auto read_angles = [&](const char* key, PerActuator& angles) {
      read_list(entries, prefix + key, -kLargest, kLargest, "rad", std::span(angles).first(actuators));
    };
    Segment segment;
    segment.duration = read_bounded(entries, prefix + "duration", kSmallest, kLargest, "s");
    read_angles("from", segment.from);
    read_angles("to", segment.to);
    read_angles("amplitude", segment.amplitude);
    segment.frequency = read_bounded(entries, prefix + "frequency", kSmallest, 1000.0, "Hz");
    segment.last_frequency = read_bounded(entries, prefix + "last_frequency", kSmallest, 1000.0, "Hz");
    segments.push_back(segment);
  }
  if (segments.empty()) {
    entries.refuse("missing key segment.0.duration");
  }
  return segments;
}

}  // namespace

LabImage parse_lab_image(const std::string& text, const std::string& name, double period) {
  Entries entries(text, name);
  LabSettings settings;
  LabImage image;
  read_word(entries, "schema", std::array<std::string_view, 1>{"1"});
  read_word(entries, "topology", std::array<std::string_view, 1>{kLabTopology});
  read_settings(entries, settings);
  read_interlock(entries, settings.interlock, period);
  read_limits(entries, settings.limits, settings.actuators, period);
  image.lines = read_lines(entries);
  settings.profile = Profile(read_segments(entries, settings.actuators));
  entries.refuse_unused();
  image.text = text;
  image.error = entries.error();
  if (image.error.empty()) {
    image.settings = std::move(settings);
  }
  return image;
}

}  // namespace hotfire::firmware
