// SPDX-License-Identifier: Apache-2.0
#include "tools/files/rig/profile_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <sstream>
#include <vector>

#include "hal/recording/format.hpp"
#include "tools/files/model/model_group.hpp"
#include "tools/files/rig/profile_parts.hpp"

namespace hotfire {

namespace {

constexpr double kAny = ProfileNumbers::kAny;
constexpr double kAboveZero = ProfileNumbers::kAboveZero;
/// Steps are slewed at this share of the limit where nothing is said: a rate at the limit would meet it within rounding.
constexpr double kSlewShare = 0.9;

constexpr std::array<ProfileNumber, 7> kLabNumbers{{{"piston_per_command", "m/rad", kAboveZero, kAny},
                                                    {"current_per_command", "A/rad", 0.0, kAny},
                                                    {"current_per_error", "A/m", 0.0, kAny},
                                                    {"current_limit", "A", kAboveZero, 0.032},
                                                    {"approach_rate", "rad/s", kAboveZero, kAny},
                                                    {"rest_speed", "m/s", kAboveZero, kAny},
                                                    {"stopping_time", "s", 0.0, 600.0}}};
constexpr ProfileNumber kSlewRate{"slew_rate", "rad/s", kAboveZero, kAny};
constexpr std::array<ProfileNumber, 7> kLimitNumbers{{{"command_age", "s", 0.0, 600.0},
                                                      {"lowest_reading", "m", -kAny, kAny},
                                                      {"highest_reading", "m", -kAny, kAny},
                                                      {"disagreement", "m", 0.0, kAny},
                                                      {"command_rate", "m/s", kAboveZero, kAny},
                                                      {"position_error", "m", 0.0, kAny},
                                                      {"position_error_time", "s", 0.0, 600.0}}};
/// One for all actuators, or one for each.
constexpr std::array<ProfileNumber, 4> kActuatorLimits{{{"reading_age", "s", 0.0, 600.0},
                                                        {"lowest_position", "m", -kAny, kAny},
                                                        {"highest_position", "m", -kAny, kAny},
                                                        {"speed", "m/s", kAboveZero, kAny}}};
/// As those, but need not be said: load pressures are then not measured. Bounded by what a frame can say.
constexpr ProfileNumber kLoadPressureLimit{"load_pressure", "Pa", kAboveZero, 50e6};
/// How often a node sends each of its messages, or kSync; need not be said: once in a period of the lab.
constexpr std::string_view kSync = "sync";
constexpr ProfileNumber kReadingPeriod{"reading_period", "s", 1e-4, 600.0};
/// A number that need not be said, and what it then is.
struct Default {
  ProfileNumber number;
  double value = 0.0;
};
/// Over which a speed is measured: long against a step of a reading, short against what a piston needs to get anywhere. And
/// how long a contactor may take to follow its line.
constexpr std::array<Default, 2> kLimitDefaults{
    {{{"speed_time", "s", 0.0, 0.64}, 0.01}, {{"read_back_time", "s", 0.0, 10.0}, 0.1}}};
/// Less than this is one act of a person, which can arm or start but not both [s].
constexpr double kOneAct = 1.0;
constexpr std::array<Default, 4> kInterlockDefaults{{{{"debounce", "s", 0.005, kOneAct}, 0.03},
                                                     {{"longest_press", "s", kOneAct, 600.0}, 10.0},
                                                     {{"least_armed", "s", kOneAct, 600.0}, kOneAct},
                                                     {{"arming_timeout", "s", 2.0 * kOneAct, 3600.0}, 60.0}}};
constexpr std::array<std::string_view, 6> kLines{"emergency_stop", "hydraulic_enable", "arm",
                                                 "supply",         "heartbeat",        "fault"};
constexpr std::array<std::string_view, 3> kOptionalLines{"start", "supply_read_back", "fault_read_back"};

template <class Numbers>
Words names_of_numbers(const Numbers& numbers) {
  Words words;
  for (const auto& number : numbers) {
    if constexpr (requires { number.number; }) {
      words.push_back(number.number.key);
    } else {
      words.push_back(number.key);
    }
  }
  return words;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : numbers_(path), source_(numbers_.source()) {}

  LabProfile profile() {
    refuse_unknown_keys(source_, source_.root(), "", {"schema", "lab", "interlock", "limits", "lines", "profile"});
    require_schema(source_);
    text_ = "schema 1\ntopology lab\n";
    read_lab();
    read_limits();
    read_lines();
    read_interlock();
    read_slew_rate();
    std::size_t index = 0;
    double duration = 0.0;
    for (const Stretch& stretch : read_profile_parts(numbers_, limits_)) {
      write(stretch, index++);
      duration += stretch.duration;
    }
    return {static_cast<unsigned>(numbers_.actuators()),
            duration,
            *std::max_element(limits_.lowest.begin(), limits_.lowest.end()),
            *std::min_element(limits_.highest.begin(), limits_.highest.end()),
            *std::min_element(limits_.rate.begin(), limits_.rate.end()),
            hal::model_hash(text_),
            text_};
  }

 private:
  const toml::table& table(const char* name) const {
    return source_.table(numbers_.needed(source_.root(), "", name, fmt::format("a table [{}]", name)), name);
  }

  double read(const toml::table& table, const std::string& prefix, const ProfileNumber& wanted) {
    const double value = numbers_.number(table, prefix, wanted);
    line(prefix == "limits." ? prefix + std::string(wanted.key) : std::string(wanted.key), exact(value));
    return value;
  }

  void read_lab() {
    const toml::table& lab = table("lab");
    Words known = names_of_numbers(kLabNumbers);
    known.push_back("actuators");
    known.push_back(kSlewRate.key);
    refuse_unknown_keys(source_, lab, "lab.", known);
    const toml::node& actuators = numbers_.needed(lab, "lab.", "actuators", "1 to 8");
    numbers_.set_actuators(static_cast<std::size_t>(numbers_.count(actuators, "lab.actuators", 1, 8)));
    line("actuators", std::to_string(numbers_.actuators()));
    for (const ProfileNumber& wanted : kLabNumbers) {
      const double value = read(lab, "lab.", wanted);
      piston_per_command_ = wanted.key == "piston_per_command" ? value : piston_per_command_;
    }
  }

  void read_limits() {
    const toml::table& limits = table("limits");
    Words known = names_of_numbers(kLimitNumbers);
    for (const Words& more : {names_of_numbers(kActuatorLimits), names_of_numbers(kLimitDefaults),
                              Words{kLoadPressureLimit.key, kReadingPeriod.key, "overruns"}}) {
      known.insert(known.end(), more.begin(), more.end());
    }
    refuse_unknown_keys(source_, limits, "limits.", known);
    double command_rate = 0.0;
    for (const ProfileNumber& wanted : kLimitNumbers) {
      const double value = read(limits, "limits.", wanted);
      command_rate = wanted.key == "command_rate" ? value : command_rate;
    }
    for (const auto& [wanted, otherwise] : kLimitDefaults) {
      line("limits." + std::string(wanted.key), exact(numbers_.number_or(limits, "limits.", wanted, otherwise)));
    }
    for (const ProfileNumber& wanted : kActuatorLimits) {
      read_actuator_limit(limits, wanted, command_rate);
    }
    if (limits.contains(kLoadPressureLimit.key)) {
      read_actuator_limit(limits, kLoadPressureLimit, command_rate);
    }
    if (limits.contains(kReadingPeriod.key)) {
      read_reading_period(limits);
    }
    const toml::node* overruns = limits.get("overruns");
    line("limits.overruns",
         std::to_string(overruns == nullptr ? 0 : numbers_.count(*overruns, "limits.overruns", 0, 1'000'000)));
  }

  void read_reading_period(const toml::table& limits) {
    if (limits.get(kReadingPeriod.key)->value<std::string_view>() == kSync) {
      line("limits." + std::string(kReadingPeriod.key), std::string(kSync));
      return;
    }
    const double every = read(limits, "limits.", kReadingPeriod);
    const ProfileNumber& age = kActuatorLimits[0];
    const std::vector<double> ages = numbers_.each(*limits.get(age.key), "limits." + std::string(age.key), age);
    if (const double least = *std::min_element(ages.begin(), ages.end()); every > least) {
      source_.refuse(*limits.get(kReadingPeriod.key), "limits." + std::string(kReadingPeriod.key),
                     fmt::format("allowed: up to limits.reading_age, {:g} s, beyond which a reading is stale", least));
    }
  }

  void read_actuator_limit(const toml::table& limits, const ProfileNumber& wanted, double command_rate) {
    const std::string key = "limits." + std::string(wanted.key);
    std::vector<double> values =
        numbers_.each(numbers_.needed(limits, "limits.", wanted.key, numbers_.each_allowed(wanted.unit)), key, wanted);
    line(key, fmt::format("{:a}", fmt::join(values, ",")));
    for (double& value : values) {
      value = (wanted.key == "speed" ? std::min(value, command_rate) : value) / piston_per_command_;
    }
    limits_.lowest = wanted.key == "lowest_position" ? values : limits_.lowest;
    limits_.highest = wanted.key == "highest_position" ? values : limits_.highest;
    limits_.rate = wanted.key == "speed" ? values : limits_.rate;
  }

  void read_lines() {
    const toml::table& lines = table("lines");
    Words known{kLines.begin(), kLines.end()};
    known.insert(known.end(), kOptionalLines.begin(), kOptionalLines.end());
    refuse_unknown_keys(source_, lines, "lines.", known);
    std::vector<std::string> taken;
    for (const std::string_view name : known) {
      const bool is_optional = std::find(kOptionalLines.begin(), kOptionalLines.end(), name) != kOptionalLines.end();
      if (is_optional && !lines.contains(name)) {
        continue;
      }
      const std::string key = "lines." + std::string(name);
      const toml::node& node = numbers_.needed(lines, "lines.", name, "the name of a line of the GPIO chip");
      const std::string value = source_.text(node, key);
      if (value.empty() || value.find_first_of(" \n\t") != std::string::npos) {
        source_.refuse(node, key, "allowed: a name without spaces");
      }
      if (std::find(taken.begin(), taken.end(), value) != taken.end()) {
        source_.refuse(node, key, "allowed: a line of its own; another key names this one");
      }
      taken.push_back(value);
      line("line." + std::string(name), value);
    }
    has_start_ = lines.contains("start");
  }

  void read_interlock() {
    const toml::node* node = source_.root().get("interlock");
    const toml::table none;
    const toml::table& interlock = node == nullptr ? none : source_.table(*node, "interlock");
    Words known = names_of_numbers(kInterlockDefaults);
    known.push_back("start_hold");
    refuse_unknown_keys(source_, interlock, "interlock.", known);
    for (const auto& [wanted, otherwise] : kInterlockDefaults) {
      line("interlock." + std::string(wanted.key), exact(numbers_.number_or(interlock, "interlock.", wanted, otherwise)));
    }
    const double least = has_start_ ? 0.0 : kOneAct;
    line("interlock.start_hold",
         exact(numbers_.number_or(interlock, "interlock.", {"start_hold", "s", least, 60.0}, least)));
  }

  void read_slew_rate() {
    const toml::table& lab = table("lab");
    const double lowest_rate = *std::min_element(limits_.rate.begin(), limits_.rate.end());
    limits_.slew_rate = numbers_.number_or(lab, "lab.", kSlewRate, kSlewShare * lowest_rate);
    for (const std::string_view key : {kSlewRate.key, std::string_view("approach_rate")}) {
      const double rate = lab.contains(key) ? numbers_.number(lab, "lab.", {key, "rad/s", 0.0, kAny}) : 0.0;
      if (rate > lowest_rate) {
        source_.refuse(*lab.get(key), "lab." + std::string(key),
                       fmt::format("limits.command_rate and limits.speed allow {:g} rad/s", lowest_rate));
      }
    }
  }

  void write(const Stretch& stretch, std::size_t index) {
    const auto field = [&](std::string_view key, const std::vector<double>& values) {
      line(fmt::format("segment.{}.{}", index, key), fmt::format("{:a}", fmt::join(values, ",")));
    };
    field("duration", {stretch.duration});
    field("from", stretch.from);
    field("to", stretch.to);
    field("amplitude", stretch.amplitude);
    field("frequency", {stretch.frequency});
    field("last_frequency", {stretch.last_frequency});
  }

  static std::string exact(double value) { return fmt::format("{:a}", value); }
  void line(std::string_view key, const std::string& value) { text_ += fmt::format("{} {}\n", key, value); }

  ProfileNumbers numbers_;
  const TomlSource& source_;
  double piston_per_command_ = 0.0;
  bool has_start_ = false;
  StretchLimits limits_;
  std::string text_;
};

}  // namespace

bool is_profile(const std::filesystem::path& path) { return TomlSource(path).root().contains("lab"); }

std::string profile_with_parts(const std::filesystem::path& path, const std::string& parts) {
  toml::table whole = TomlSource(path).root();
  whole.insert_or_assign("profile", *toml::parse(parts).get("profile"));
  std::ostringstream text;
  text << whole << '\n';
  return text.str();
}

LabProfile load_profile(const std::filesystem::path& path) { return Reader(path).profile(); }

}  // namespace hotfire
