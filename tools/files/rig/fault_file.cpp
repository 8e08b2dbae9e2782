// SPDX-License-Identifier: Apache-2.0
#include "tools/files/rig/fault_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "model/checks.hpp"
#include "tools/files/model/model_group.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"
#include "tools/files/text/toml_source.hpp"

namespace hotfire {

namespace {

/// What a kind of fault is declared with. The bounds of values are checked by hotfire-rt too, which reads the image.
struct Kind {
  std::string_view name;
  bool of_sensor;
  std::optional<std::string_view> unit;  ///< of its value; empty: the channel's; none: it has no value
  double lower = 0.0;
  double upper = 0.0;
};

constexpr double kLargest = std::numeric_limits<double>::max();
constexpr std::array<Kind, 10> kKinds{{{"stuck", true, std::nullopt},
                                       {"biased", true, "", -kLargest, kLargest},
                                       {"noisy", true, "", 0.0, kLargest},
                                       {"dropped", true, std::nullopt},
                                       {"delayed", true, "s", 0.0, 1.0},
                                       {"leak", false, "m^3/s/Pa", 0.0, 1e-6},
                                       {"lost_supply", false, "Pa", 1e4, 1e9},
                                       {"bus_off", false, std::nullopt},
                                       {"torque", false, "N.m", -1e7, 1e7},
                                       {"thrust", false, "N", 0.0, 1e8}}};

/// One table `[[fault]]`.
class FaultTable {
 public:
  FaultTable(const TomlSource& source, const toml::table& table, const FaultyPlant& plant, std::size_t index)
      : source_(source), table_(table), plant_(plant), prefix_(fmt::format("fault.{}.", index)) {}

  std::string lines() {
    const Kind& kind = read_kind();
    const bool is_bus = kind.name == "bus_off";
    Words known{"kind", "from", "to"};
    if (!is_bus) {
      known.push_back("actuator");
    }
    if (kind.of_sensor) {
      known.push_back("channel");
    }
    if (kind.unit) {
      known.push_back("value");
    }
    refuse_unknown_keys(source_, table_, prefix_, known);
    line("kind", std::string(kind.name));
    const double from = read("from", "s", 0.0, kLargest);
    line("from", exact(from));
    line("to", table_.contains("to") ? exact(read("to", "s", from, kLargest)) : "inf");
    if (!is_bus) {
      line("actuator", std::to_string(read_actuator()));
    }
    const ModelChannel* channel = kind.of_sensor ? &read_channel() : nullptr;
    if (kind.unit) {
      const std::string_view unit = kind.unit->empty() ? channel->unit : *kind.unit;
      line("value", exact(read("value", unit.empty() ? "1" : unit, kind.lower, kind.upper)));
    }
    return text_;
  }

 private:
  const toml::node& needed(std::string_view key, const std::string& allowed) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) {
      source_.refuse_missing(table_, prefix_ + std::string(key), "missing; allowed: " + allowed);
    }
    return *node;
  }

  const Kind& read_kind() const {
    Words names;
    for (const Kind& kind : kKinds) {
      names.push_back(kind.name);
    }
    const toml::node& node = needed("kind", fmt::format("{}", fmt::join(names, ", ")));
    const std::string name = source_.text(node, prefix_ + "kind");
    const auto* const found =
        std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& kind) { return kind.name == name; });
    if (found == kKinds.end()) {
      source_.refuse(node, prefix_ + "kind", suggestion(name, names));
    }
    if (!found->of_sensor && name != "bus_off" && !plant_.hydraulic) {
      source_.refuse(node, prefix_ + "kind", "of a hydraulic axis and its engine, and this model has none");
    }
    if (name == "thrust" && !plant_.has_bearing) {
      source_.refuse(node, prefix_ + "kind", "needs a gimbal bearing; allowed with topology \"taos\" or \"masv\"");
    }
    return *found;
  }

  double read(std::string_view key, std::string_view unit, double lower, double upper) const {
    const toml::node& node = needed(key, fmt::format("a number in {}", unit));
    const std::string full = prefix_ + std::string(key);
    const double value = source_.number(node, full, unit);
    if (!model::is_inside(value, lower, upper)) {
      source_.refuse(node, full, fmt::format("allowed: {:g} to {:g} {}", lower, upper, unit));
    }
    return value;
  }

  std::int64_t read_actuator() const {
    const toml::node* node = table_.get("actuator");
    if (node == nullptr) {
      return 0;
    }
    const auto number = node->value_exact<std::int64_t>();
    if (!number || *number < 1 || *number > plant_.actuators) {
      source_.refuse(*node, prefix_ + "actuator",
                     fmt::format("allowed: 1 to {}; leave it out for every actuator", plant_.actuators));
    }
    return *number;
  }

  const ModelChannel& read_channel() {
    const Words names = names_of(plant_.channels);
    const toml::node& node = needed("channel", fmt::format("{}", fmt::join(names, ", ")));
    const std::string name = source_.text(node, prefix_ + "channel");
    const auto found = std::find_if(plant_.channels.begin(), plant_.channels.end(),
                                    [&](const ModelChannel& channel) { return channel.name == name; });
    if (found == plant_.channels.end()) {
      source_.refuse(node, prefix_ + "channel", suggestion(name, names));
    }
    line("channel", name);
    return *found;
  }

  static std::string exact(double value) { return fmt::format("{:a}", value); }

  void line(std::string_view key, const std::string& value) { text_ += fmt::format("{}{} {}\n", prefix_, key, value); }

  const TomlSource& source_;
  const toml::table& table_;
  const FaultyPlant& plant_;
  std::string prefix_;
  std::string text_;
};

}  // namespace

FaultyPlant faulty_plant(const ModelFile& model) {
  ModelFile copy = model;
  return {layout_of(copy).channels, std::holds_alternative<SimplexParameters>(model.parameters)};
}

std::string load_faults(const std::filesystem::path& path, const FaultyPlant& plant) {
  const TomlSource source(path);
  refuse_unknown_keys(source, source.root(), "", {"schema", "fault"});
  require_schema(source);
  const toml::node* node = source.root().get("fault");
  const toml::array* tables = node != nullptr ? node->as_array() : nullptr;
  if (tables == nullptr) {
    source.refuse_missing(source.root(), "fault", "missing; declare at least one: [[fault]]");
  }
  std::string lines;
  std::size_t index = 0;
  for (const toml::node& one : *tables) {
    const std::string key = fmt::format("fault.{}", index);
    lines += FaultTable(source, source.table(one, key), plant, index).lines();
    ++index;
  }
  return lines;
}

}  // namespace hotfire
