#include "tools/files/rig/profile_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <vector>

#include "tools/files/model/model_group.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"
#include "tools/files/text/toml_source.hpp"

namespace hotfire {

namespace {

constexpr double kAny = 1e9;
constexpr double kAboveZero = 1e-9;
constexpr double kHighestFrequency = 1000.0;
constexpr std::size_t kMostSegments = 10'000;

/// A number that has to be there.
struct Number {
  std::string_view key;
  std::string_view unit;
  double lower;
  double upper;
};

constexpr std::array<Number, 7> kLabNumbers{{{"piston_per_command", "m/rad", kAboveZero, kAny},
                                             {"current_per_command", "A/rad", 0.0, kAny},
                                             {"current_per_error", "A/m", 0.0, kAny},
                                             {"current_limit", "A", kAboveZero, 0.032},
                                             {"approach_rate", "rad/s", kAboveZero, kAny},
                                             {"rest_speed", "m/s", kAboveZero, kAny},
                                             {"stopping_time", "s", 0.0, 600.0}}};
constexpr std::array<Number, 10> kLimitNumbers{{{"command_age", "s", 0.0, 600.0},
                                                {"reading_age", "s", 0.0, 600.0},
                                                {"lowest_reading", "m", -kAny, kAny},
                                                {"highest_reading", "m", -kAny, kAny},
                                                {"disagreement", "m", 0.0, kAny},
                                                {"lowest_position", "m", -kAny, kAny},
                                                {"highest_position", "m", -kAny, kAny},
                                                {"command_rate", "m/s", 0.0, kAny},
                                                {"position_error", "m", 0.0, kAny},
                                                {"position_error_time", "s", 0.0, 600.0}}};
constexpr std::array<std::string_view, 6> kLines{"emergency_stop", "hydraulic_enable", "arm",
                                                 "supply",         "heartbeat",        "fault"};

/// Angles [rad], one for each actuator.
using Angles = std::vector<double>;

/// A stretch as the real-time side knows it: a straight line with a sine on it.
struct Stretch {
  double duration = 0.0;
  Angles from;
  Angles to;
  Angles amplitude;
  double frequency = 1.0;
  double last_frequency = 1.0;

  double highest(std::size_t actuator) const {
    return std::max(from[actuator], to[actuator]) + std::abs(amplitude[actuator]);
  }
  double lowest(std::size_t actuator) const {
    return std::min(from[actuator], to[actuator]) - std::abs(amplitude[actuator]);
  }
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : source_(path) {}

  LabProfile profile() {
    refuse_unknown_keys(source_, source_.root(), "", {"schema", "lab", "limits", "lines", "profile"});
    require_schema(source_);
    text_ = "schema 1\ntopology lab\n";
    read_lab();
    read_limits();
    read_lines();
    read_profile();
    return {actuators_,
            duration_,
            lowest_ / piston_per_command_,
            highest_ / piston_per_command_,
            command_rate_ / piston_per_command_,
            text_};
  }

 private:
  const toml::node& needed(const toml::table& table, const std::string& prefix, std::string_view key,
                           const std::string& allowed) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) {
      source_.refuse_missing(table, prefix + std::string(key), "missing; allowed: " + allowed);
    }
    return *node;
  }

  double within(const toml::node& node, const std::string& key, std::string_view unit, double lower, double upper) const {
    const double value = source_.number(node, key, unit);
    if (!(value >= lower && value <= upper)) {
      source_.refuse(node, key, fmt::format("allowed: {:g} to {:g} {}", lower, upper, unit));
    }
    return value;
  }

  double number(const toml::table& table, const std::string& prefix, const Number& wanted) const {
    const toml::node& node = needed(table, prefix, wanted.key, fmt::format("a number in {}", wanted.unit));
    return within(node, prefix + std::string(wanted.key), wanted.unit, wanted.lower, wanted.upper);
  }

  std::int64_t count(const toml::node& node, const std::string& key, std::int64_t lowest, std::int64_t highest) const {
    const auto value = node.value_exact<std::int64_t>();
    if (!value || *value < lowest || *value > highest) {
      source_.refuse(node, key, fmt::format("allowed: a whole number from {} to {}", lowest, highest));
    }
    return *value;
  }

  void read_lab() {
    const toml::table& lab = source_.table(needed(source_.root(), "", "lab", "a table [lab]"), "lab");
    Words known = names(kLabNumbers);
    known.push_back("actuators");
    refuse_unknown_keys(source_, lab, "lab.", known);
    const toml::node& actuators = needed(lab, "lab.", "actuators", "1 to 8");
    actuators_ = static_cast<unsigned>(count(actuators, "lab.actuators", 1, 8));
    line("actuators", std::to_string(actuators_));
    for (const Number& wanted : kLabNumbers) {
      const double value = number(lab, "lab.", wanted);
      line(wanted.key, exact(value));
      piston_per_command_ = wanted.key == "piston_per_command" ? value : piston_per_command_;
    }
  }

  void read_limits() {
    const toml::table& limits = source_.table(needed(source_.root(), "", "limits", "a table [limits]"), "limits");
    Words known = names(kLimitNumbers);
    known.push_back("overruns");
    refuse_unknown_keys(source_, limits, "limits.", known);
    for (const Number& wanted : kLimitNumbers) {
      const double value = number(limits, "limits.", wanted);
      line("limits." + std::string(wanted.key), exact(value));
      lowest_ = wanted.key == "lowest_position" ? value : lowest_;
      highest_ = wanted.key == "highest_position" ? value : highest_;
      command_rate_ = wanted.key == "command_rate" ? value : command_rate_;
    }
    const toml::node* overruns = limits.get("overruns");
    line("limits.overruns", std::to_string(overruns == nullptr ? 0 : count(*overruns, "limits.overruns", 0, 1'000'000)));
  }

  void read_lines() {
    const toml::table& lines = source_.table(needed(source_.root(), "", "lines", "a table [lines]"), "lines");
    refuse_unknown_keys(source_, lines, "lines.", {kLines.begin(), kLines.end()});
    for (const std::string_view name : kLines) {
      const std::string key = "lines." + std::string(name);
      const toml::node& node = needed(lines, "lines.", name, "the name of a line of the GPIO chip");
      const std::string value = source_.text(node, key);
      if (value.empty() || value.find_first_of(" \n\t") != std::string::npos) {
        source_.refuse(node, key, "allowed: a name without spaces");
      }
      line("line." + std::string(name), value);
    }
  }

  void read_profile() {
    const toml::node* node = source_.root().get("profile");
    const toml::array* parts = node != nullptr ? node->as_array() : nullptr;
    if (parts == nullptr || parts->empty()) {
      source_.refuse_missing(source_.root(), "profile", "missing; declare at least one: [[profile]]");
    }
    std::size_t segments = 0;
    std::size_t index = 0;
    for (const toml::node& part : *parts) {
      const std::string prefix = fmt::format("profile.{}", index++);
      const toml::table& table = source_.table(part, prefix);
      for (const Stretch& stretch : read_part(table, prefix + ".")) {
        refuse_beyond_limits(stretch, table, prefix);
        write(stretch, segments++);
        duration_ += stretch.duration;
      }
    }
    if (segments > kMostSegments) {
      source_.refuse_missing(source_.root(), "profile", fmt::format("more than {} segments", kMostSegments));
    }
  }

  void refuse_beyond_limits(const Stretch& stretch, const toml::table& table, const std::string& prefix) const {
    for (std::size_t i = 0; i < actuators_; ++i) {
      if (piston_per_command_ * stretch.highest(i) > highest_ || piston_per_command_ * stretch.lowest(i) < lowest_) {
        source_.refuse_missing(
            table, prefix,
            fmt::format(
                "the commands of actuator {}, {:g} to {:g} rad, stand for positions beyond limits.lowest_position and "
                "limits.highest_position, {:g} to {:g} m",
                i + 1, stretch.lowest(i), stretch.highest(i), lowest_, highest_));
      }
    }
  }

  std::vector<Stretch> read_part(const toml::table& table, const std::string& prefix) const {
    static constexpr std::array<std::string_view, 5> kKinds{"rest", "steps", "sweep", "sines", "table"};
    const toml::node& node = needed(table, prefix, "kind", fmt::format("{}", fmt::join(kKinds, ", ")));
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
    return number(table, prefix, {"duration", "s", 1e-3, 1e6});
  }

  /// What a sine swings about: 0 where nothing is said.
  Angles bias(const toml::table& table, const std::string& prefix) const {
    const toml::node* node = table.get("bias");
    return node == nullptr ? all(0.0) : angles(*node, prefix + "bias");
  }

  std::vector<Stretch> steps(const toml::table& table, const std::string& prefix) const {
    refuse_unknown_keys(source_, table, prefix, {"kind", "levels", "hold"});
    const double hold = number(table, prefix, {"hold", "s", 1e-3, 1e6});
    std::vector<Stretch> result;
    for (const Angles& level : list_of_angles(table, prefix, "levels")) {
      result.push_back(line_of(hold, level, level));
    }
    return result;
  }

  std::vector<Stretch> sweep(const toml::table& table, const std::string& prefix) const {
    refuse_unknown_keys(source_, table, prefix, {"kind", "amplitude", "bias", "from", "to", "duration"});
    const Angles amplitude = angles(needed(table, prefix, "amplitude", angles_allowed()), prefix + "amplitude");
    const double from = number(table, prefix, {"from", "Hz", 1e-3, kHighestFrequency});
    const double to = number(table, prefix, {"to", "Hz", 1e-3, kHighestFrequency});
    const Angles middle = bias(table, prefix);
    return {{duration(table, prefix), middle, middle, amplitude, from, to}};
  }

  std::vector<Stretch> sines(const toml::table& table, const std::string& prefix) const {
    refuse_unknown_keys(source_, table, prefix, {"kind", "amplitudes", "bias", "frequencies", "periods"});
    const toml::node& node = needed(table, prefix, "periods", "a whole number");
    const auto periods = static_cast<double>(count(node, prefix + "periods", 1, 100'000));
    const Angles middle = bias(table, prefix);
    std::vector<Stretch> result;
    for (const Angles& amplitude : list_of_angles(table, prefix, "amplitudes")) {
      for (const double frequency : numbers(table, prefix, {"frequencies", "Hz", 1e-3, kHighestFrequency})) {
        result.push_back({periods / frequency, middle, middle, amplitude, frequency, frequency});
      }
    }
    return result;
  }

  std::vector<Stretch> points(const toml::table& table, const std::string& prefix) const {
    refuse_unknown_keys(source_, table, prefix, {"kind", "times", "commands"});
    const std::vector<double> times = numbers(table, prefix, {"times", "s", 0.0, 1e6});
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

  const toml::array& list(const toml::table& table, const std::string& prefix, std::string_view key,
                          const std::string& allowed) const {
    const toml::node& node = needed(table, prefix, key, allowed);
    if (!node.is_array() || node.as_array()->empty()) {
      source_.refuse(node, prefix + std::string(key), "allowed: " + allowed);
    }
    return *node.as_array();
  }

  std::vector<double> numbers(const toml::table& table, const std::string& prefix, const Number& wanted) const {
    const std::string key = prefix + std::string(wanted.key);
    std::vector<double> result;
    for (const toml::node& item : list(table, prefix, wanted.key, fmt::format("a list of numbers in {}", wanted.unit))) {
      result.push_back(within(item, key, wanted.unit, wanted.lower, wanted.upper));
    }
    return result;
  }

  std::string angles_allowed() const {
    return fmt::format("a number in rad, for all actuators, or a list of {}, one for each", actuators_);
  }

  Angles all(double angle) const { return Angles(actuators_, angle); }

  /// What an angle of the profile is: a number for all actuators, or a list with one for each.
  Angles angles(const toml::node& node, const std::string& key) const {
    const toml::array* each = node.as_array();
    if (each == nullptr) {
      return all(within(node, key, "rad", -kAny, kAny));
    }
    if (each->size() != actuators_) {
      source_.refuse(node, key, "allowed: " + angles_allowed());
    }
    Angles result;
    for (const toml::node& item : *each) {
      result.push_back(within(item, key, "rad", -kAny, kAny));
    }
    return result;
  }

  std::vector<Angles> list_of_angles(const toml::table& table, const std::string& prefix, std::string_view key) const {
    std::vector<Angles> result;
    for (const toml::node& item : list(table, prefix, key, "a list, each entry " + angles_allowed())) {
      result.push_back(angles(item, prefix + std::string(key)));
    }
    return result;
  }

  Stretch line_of(double duration, const Angles& from, const Angles& to) const { return {duration, from, to, all(0.0)}; }

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

  template <class Numbers>
  static Words names(const Numbers& numbers) {
    Words words;
    for (const Number& number : numbers) {
      words.push_back(number.key);
    }
    return words;
  }

  static std::string exact(double value) { return fmt::format("{:a}", value); }
  void line(std::string_view key, const std::string& value) { text_ += fmt::format("{} {}\n", key, value); }

  TomlSource source_;
  unsigned actuators_ = 1;
  double duration_ = 0.0;
  double piston_per_command_ = 0.0;
  double lowest_ = 0.0;
  double highest_ = 0.0;
  double command_rate_ = 0.0;
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
