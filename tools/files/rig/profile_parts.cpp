// SPDX-License-Identifier: Apache-2.0
#include "tools/files/rig/profile_parts.hpp"

#include <fmt/ranges.h>

#include <array>
#include <numbers>
#include <string_view>

#include "tools/files/model/model_group.hpp"
#include "tools/files/text/suggestion.hpp"

namespace hotfire {

namespace {

constexpr double kHighestFrequency = 1000.0;
constexpr std::size_t kMostSegments = 10'000;
/// Ends that are nearer than this meet: a sine of whole periods ends at its bias but for rounding [rad].
constexpr double kMeets = 1e-9;
/// A rate that is meant to be the limit is so but for rounding.
constexpr double kProfileRounding = 1.0 + 1e-9;

class Parts {
 public:
  Parts(const ProfileNumbers& numbers, const StretchLimits& limits)
      : numbers_(numbers), source_(numbers.source()), limits_(limits) {}

  std::vector<Stretch> read() {
    const toml::node* node = source_.root().get("profile");
    const toml::array* parts = node != nullptr ? node->as_array() : nullptr;
    if (parts == nullptr || parts->empty()) {
      source_.refuse_missing(source_.root(), "profile", "missing; declare at least one: [[profile]]");
    }
    std::size_t index = 0;
    for (const toml::node& part : *parts) {
      const std::string prefix = fmt::format("profile.{}", index++);
      const toml::table& table = source_.table(part, prefix);
      for (const Stretch& stretch : read_part(table, prefix + ".")) {
        refuse_beyond_limits(stretch, table, prefix);
        add(stretch);
      }
    }
    if (stretches_.size() > kMostSegments) {
      source_.refuse_missing(source_.root(), "profile", fmt::format("more than {} segments", kMostSegments));
    }
    return std::move(stretches_);
  }

 private:
  /// Adds a stretch, and before it the line from where the last one has ended. A level has the line in its own time, if it
  /// is long enough, so that a step takes as long as it is said to.
  void add(Stretch next) {
    if (stretches_.empty()) {
      stretches_.push_back(next);
      return;
    }
    Angles ends;
    double farthest = 0.0;
    for (std::size_t i = 0; i < numbers_.actuators(); ++i) {
      ends.push_back(stretches_.back().end(i));
      farthest = std::max(farthest, std::abs(next.from[i] - ends[i]));
    }
    if (farthest > kMeets) {
      const double duration = farthest / limits_.slew_rate;
      stretches_.push_back(line_of(duration, ends, next.from));
      const bool is_level = next.from == next.to && next.amplitude == all(0.0);
      next.duration -= is_level && duration < next.duration ? duration : 0.0;
    }
    stretches_.push_back(next);
  }

  void refuse_beyond_limits(const Stretch& stretch, const toml::table& table, const std::string& prefix) const {
    for (std::size_t i = 0; i < numbers_.actuators(); ++i) {
      if (stretch.highest(i) > limits_.highest[i] || stretch.lowest(i) < limits_.lowest[i]) {
        source_.refuse_missing(
            table, prefix,
            fmt::format("the commands of actuator {}, {:g} to {:g} rad, demand positions beyond limits.lowest_position "
                        "and limits.highest_position, {:g} to {:g} rad",
                        i + 1, stretch.lowest(i), stretch.highest(i), limits_.lowest[i], limits_.highest[i]));
      }
      if (stretch.rate(i) > limits_.rate[i] * kProfileRounding) {
        source_.refuse_missing(table, prefix,
                               fmt::format("the command of actuator {} changes by up to {:g} rad/s; limits.command_rate and "
                                           "limits.speed allow {:g} rad/s",
                                           i + 1, stretch.rate(i), limits_.rate[i]));
      }
    }
  }

  std::vector<Stretch> read_part(const toml::table& table, const std::string& prefix) const {
    static constexpr std::array<std::string_view, 5> kKinds{"rest", "steps", "sweep", "sines", "table"};
    const toml::node& node = numbers_.needed(table, prefix, "kind", fmt::format("{}", fmt::join(kKinds, ", ")));
    const std::string kind = source_.text(node, prefix + "kind");
    if (kind == "rest") {
      refuse_unknown_keys(source_, table, prefix, {"kind", "duration"});
      return {line_of(duration(table, prefix), all(0.0), all(0.0))};
    }
    if (kind == "steps") {
      return steps(table, prefix);
    }
    if (kind == "sweep") {
      return sweep(table, prefix);
    }
    if (kind == "sines") {
      return sines(table, prefix);
    }
    if (kind == "table") {
      return points(table, prefix);
    }
    source_.refuse(node, prefix + "kind", suggestion(kind, {kKinds.begin(), kKinds.end()}));
  }

  double duration(const toml::table& table, const std::string& prefix) const {
    return numbers_.number(table, prefix, {"duration", "s", 1e-3, 1e6});
  }

  /// What a sine swings about: 0 where nothing is said.
  Angles bias(const toml::table& table, const std::string& prefix) const {
    const toml::node* node = table.get("bias");
    return node == nullptr ? all(0.0) : angles(*node, prefix + "bias");
  }

  std::vector<Stretch> steps(const toml::table& table, const std::string& prefix) const {
    refuse_unknown_keys(source_, table, prefix, {"kind", "levels", "hold"});
    const double hold = numbers_.number(table, prefix, {"hold", "s", 1e-3, 1e6});
    std::vector<Stretch> result;
    for (const Angles& level : list_of_angles(table, prefix, "levels")) {
      result.push_back(line_of(hold, level, level));
    }
    return result;
  }

  std::vector<Stretch> sweep(const toml::table& table, const std::string& prefix) const {
    refuse_unknown_keys(source_, table, prefix, {"kind", "amplitude", "bias", "from", "to", "duration"});
    const Angles amplitude =
        angles(numbers_.needed(table, prefix, "amplitude", numbers_.each_allowed("rad")), prefix + "amplitude");
    const double from = numbers_.number(table, prefix, {"from", "Hz", 1e-3, kHighestFrequency});
    const double to = numbers_.number(table, prefix, {"to", "Hz", 1e-3, kHighestFrequency});
    const Angles middle = bias(table, prefix);
    return {{duration(table, prefix), middle, middle, amplitude, from, to}};
  }

  std::vector<Stretch> sines(const toml::table& table, const std::string& prefix) const {
    refuse_unknown_keys(source_, table, prefix, {"kind", "amplitudes", "bias", "frequencies", "periods"});
    const toml::node& node = numbers_.needed(table, prefix, "periods", "a whole number");
    const auto periods = static_cast<double>(numbers_.count(node, prefix + "periods", 1, 100'000));
    const Angles middle = bias(table, prefix);
    std::vector<Stretch> result;
    for (const Angles& amplitude : list_of_angles(table, prefix, "amplitudes")) {
      for (const double frequency : list_of(table, prefix, {"frequencies", "Hz", 1e-3, kHighestFrequency})) {
        result.push_back({periods / frequency, middle, middle, amplitude, frequency, frequency});
      }
    }
    return result;
  }

  std::vector<Stretch> points(const toml::table& table, const std::string& prefix) const {
    refuse_unknown_keys(source_, table, prefix, {"kind", "times", "commands"});
    const std::vector<double> times = list_of(table, prefix, {"times", "s", 0.0, 1e6});
    const std::vector<Angles> commands = list_of_angles(table, prefix, "commands");
    if (times.size() != commands.size() || times.size() < 2 || times.front() != 0.0) {
      source_.refuse_missing(table, prefix + "times", "allowed: as many as commands, at least two, the first 0");
    }
    std::vector<Stretch> result;
    for (std::size_t i = 1; i < times.size(); ++i) {
      if (!(times[i] > times[i - 1])) {
        source_.refuse_missing(table, prefix + "times",
                               fmt::format("allowed: rising, but {:g} follows {:g}", times[i], times[i - 1]));
      }
      result.push_back(line_of(times[i] - times[i - 1], commands[i - 1], commands[i]));
    }
    return result;
  }

  std::vector<double> list_of(const toml::table& table, const std::string& prefix, const ProfileNumber& wanted) const {
    const std::string key = prefix + std::string(wanted.key);
    std::vector<double> result;
    for (const toml::node& item :
         numbers_.list(table, prefix, wanted.key, fmt::format("a list of numbers in {}", wanted.unit))) {
      result.push_back(numbers_.within(item, key, wanted.unit, wanted.lower, wanted.upper));
    }
    return result;
  }

  Angles all(double angle) const { return Angles(numbers_.actuators(), angle); }

  Angles angles(const toml::node& node, const std::string& key) const {
    return numbers_.each(node, key, {"", "rad", -ProfileNumbers::kAny, ProfileNumbers::kAny});
  }

  std::vector<Angles> list_of_angles(const toml::table& table, const std::string& prefix, std::string_view key) const {
    std::vector<Angles> result;
    for (const toml::node& item : numbers_.list(table, prefix, key, "a list, each entry " + numbers_.each_allowed("rad"))) {
      result.push_back(angles(item, prefix + std::string(key)));
    }
    return result;
  }

  Stretch line_of(double duration, const Angles& from, const Angles& to) const { return {duration, from, to, all(0.0)}; }

  const ProfileNumbers& numbers_;
  const TomlSource& source_;
  const StretchLimits& limits_;
  std::vector<Stretch> stretches_;
};

}  // namespace

double Stretch::rate(std::size_t actuator) const {
  return std::abs(to[actuator] - from[actuator]) / duration +
         2.0 * std::numbers::pi * std::max(frequency, last_frequency) * std::abs(amplitude[actuator]);
}

double Stretch::end(std::size_t actuator) const {
  const double mean_frequency =
      frequency == last_frequency ? frequency : (last_frequency - frequency) / std::log(last_frequency / frequency);
  return to[actuator] + amplitude[actuator] * std::sin(2.0 * std::numbers::pi * mean_frequency * duration);
}

std::vector<Stretch> read_profile_parts(const ProfileNumbers& numbers, const StretchLimits& limits) {
  return Parts(numbers, limits).read();
}

}  // namespace hotfire
