#include "firmware/lab/lab_image.hpp"

#include <cmath>

#include "firmware/image/image_entries.hpp"

namespace hotfire::firmware {
namespace {

constexpr double kLargest = 1e9;
constexpr double kSmallest = 1e-9;

void read_settings(Entries& entries, LabSettings& settings) {
  settings.actuators = static_cast<std::size_t>(read_bounded(entries, "actuators", 1.0, hal::kMaxActuators, ""));
  settings.piston_per_command = read_bounded(entries, "piston_per_command", kSmallest, kLargest, "m/rad");
  settings.current_per_command = read_bounded(entries, "current_per_command", 0.0, kLargest, "A/rad");
  settings.current_per_error = read_bounded(entries, "current_per_error", 0.0, kLargest, "A/m");
  settings.current_limit = read_bounded(entries, "current_limit", kSmallest, 0.032, "A");
  settings.approach_rate = read_bounded(entries, "approach_rate", kSmallest, kLargest, "rad/s");
  settings.rest_speed = read_bounded(entries, "rest_speed", kSmallest, kLargest, "m/s");
  settings.stopping_time = read_bounded(entries, "stopping_time", 0.0, 600.0, "s");
  settings.most_overruns = static_cast<std::uint64_t>(read_bounded(entries, "limits.overruns", 0.0, kLargest, ""));
  if (settings.current_per_command == 0.0 && settings.current_per_error == 0.0) {
    entries.refuse("current_per_command and current_per_error are both 0: no command would move anything");
  }
}

void read_limits(Entries& entries, FaultLimits& limits, double period) {
  const auto nanoseconds = [&](const char* key) {
    return static_cast<std::int64_t>(1e9 * read_bounded(entries, key, 0.0, 600.0, "s"));
  };
  limits.command_age_ns = nanoseconds("limits.command_age");
  limits.reading_age_ns = nanoseconds("limits.reading_age");
  limits.lowest_reading = read_bounded(entries, "limits.lowest_reading", -kLargest, kLargest, "m");
  limits.highest_reading = read_bounded(entries, "limits.highest_reading", limits.lowest_reading, kLargest, "m");
  limits.disagreement = read_bounded(entries, "limits.disagreement", 0.0, kLargest, "m");
  limits.lowest_position = read_bounded(entries, "limits.lowest_position", -kLargest, kLargest, "m");
  limits.highest_position = read_bounded(entries, "limits.highest_position", limits.lowest_position, kLargest, "m");
  limits.command_rate = read_bounded(entries, "limits.command_rate", 0.0, kLargest, "m/s");
  limits.position_error = read_bounded(entries, "limits.position_error", 0.0, kLargest, "m");
  limits.position_error_cycles =
      static_cast<std::uint64_t>(read_bounded(entries, "limits.position_error_time", 0.0, 600.0, "s") / period);
}

std::string read_line(Entries& entries, const std::string& key) {
  const Entry* entry = entries.take(key);
  return entry == nullptr ? std::string() : entry->value;
}

LabLines read_lines(Entries& entries) {
  LabLines lines;
  lines.emergency_stop = read_line(entries, "line.emergency_stop");
  lines.hydraulic_enable = read_line(entries, "line.hydraulic_enable");
  lines.arm = read_line(entries, "line.arm");
  lines.supply = read_line(entries, "line.supply");
  lines.heartbeat = read_line(entries, "line.heartbeat");
  lines.fault = read_line(entries, "line.fault");
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
  read_limits(entries, settings.limits, period);
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
