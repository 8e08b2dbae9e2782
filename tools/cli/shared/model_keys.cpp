// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/shared/model_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string_view>
#include <variant>

#include "tools/files/model/key_groups.hpp"
#include "tools/files/model/plant_of.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire {

namespace {

constexpr std::string_view kEffects = "effects.";

std::vector<std::string> texts(const std::vector<std::string_view>& words) { return {words.begin(), words.end()}; }

/// The options whose bits are set; empty if these are all.
std::vector<std::string> options_of(const KeyGroup& group, unsigned bits) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < group.options.size(); ++i) {
    if (model::is_used(bits, static_cast<int>(i))) {
      names.emplace_back(group.options[i]);
    }
  }
  return names.size() == group.options.size() ? std::vector<std::string>{} : names;
}

ModelKey word_key(std::string_view name, const std::vector<std::string_view>& words) {
  ModelKey key;
  key.name = name;
  key.words = texts(words);
  key.meaning = fmt::format("selects the {}", name);
  return key;
}

KeyTable table_of(const KeyGroup& group, const std::string& path) {
  KeyTable table{path, std::string(group.site), {}};
  if (!group.option_key.empty()) {
    table.keys.push_back(word_key(group.option_key, group.options));
  }
  for (const ChoiceKey& choice : group.choices) {
    table.keys.push_back(word_key(choice.key, choice.names));
  }
  for (const NumberKey& number : group.numbers) {
    ModelKey key{
        std::string(number.name), std::string(number.unit), number.lower, number.upper, *number.value, 0, {}, {}, {}};
    key.of_options = options_of(group, number.options);
    key.meaning = number.meaning;
    table.keys.push_back(std::move(key));
  }
  for (const CurveKey& curve : group.curves) {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    ModelKey x{std::string(curve.x_name), std::string(curve.x_unit), -kAny, kAny, std::nullopt, curve.capacity, {}, {}, {}};
    x.of_options = options_of(group, curve.options);
    x.meaning = fmt::format("points of the curve, each above the one before: {}", curve.meaning);
    ModelKey y = x;
    y.name = curve.y_name;
    y.unit = curve.y_unit;
    y.lower = curve.y_lower;
    y.upper = curve.y_upper;
    y.meaning = fmt::format("values at these points: {}", curve.meaning);
    table.keys.push_back(std::move(x));
    table.keys.push_back(std::move(y));
  }
  return table;
}

void add_layout(const ModelLayout& layout, std::vector<KeyTable>& tables) {
  for (const KeyGroup& part : layout.parts) {
    tables.push_back(table_of(part, std::string(part.name)));
  }
  KeyTable sensors{"sensors", "", {}};
  for (const ModelChannel& channel : layout.channels) {
    ModelKey noise;
    noise.name = fmt::format("{}_noise", channel.name);
    noise.unit = channel.unit;
    noise.upper = std::numeric_limits<double>::infinity();
    noise.meaning = "rms noise of the channel in a record; left out: estimated from the record";
    sensors.keys.push_back(std::move(noise));
  }
  tables.push_back(std::move(sensors));
  for (const KeyGroup& effect : layout.effects) {
    tables.push_back(table_of(effect, std::string(kEffects) + std::string(effect.name)));
  }
}

template <class Parameters>
std::vector<KeyTable> tables_of() {
  Parameters parameters;
  std::vector<KeyTable> tables;
  add_layout(layout_of_plant<PlantOf<Parameters, double>>(parameters), tables);
  return tables;
}

/// The tables of every axis, and what a vehicle has besides.
template <class Plant>
std::vector<KeyTable> tables_of_vehicle() {
  typename Plant::Parameters parameters;
  std::vector<KeyTable> tables;
  add_layout(layout_of_plant<model::Simplex<double, typename Plant::Effects>>(parameters.axes.front()), tables);
  model::GimbalParameters<double> gimbal;
  VehicleSensors sensors;
  const std::string ends = Plant::kEngines == 1 ? "attach.pitch" : "attach.pitch1";
  tables.push_back(table_of(part_group(parameters.attach.front()), ends));
  tables.push_back(table_of(part_group(gimbal.bearing), "gimbal"));
  tables.push_back(table_of(part_group(gimbal.friction), "gimbal.friction"));
  tables.push_back(table_of(part_group(gimbal.vibration), "gimbal.vibration"));
  tables.push_back(table_of(part_group(sensors.piston), "sensors.piston"));
  tables.push_back(table_of(part_group(sensors.string), "strings"));
  return tables;
}

struct Topology {
  std::string_view name;
  std::vector<KeyTable> (*tables)();
};

template <class Plant>
Topology of_vehicle() {
  return {Plant::topology, tables_of_vehicle<Plant>};
}

/// Those of model files, which are the alternatives of their parameters, and of vehicle files.
template <class... Parameters>
std::vector<Topology> all_topologies(const std::variant<Parameters...>*) {
  return {Topology{PlantOf<Parameters, double>::topology, tables_of<Parameters>}..., of_vehicle<model::Taos<double>>(),
          of_vehicle<model::Masv<double>>()};
}

std::vector<Topology> all_topologies() { return all_topologies(static_cast<decltype(ModelFile::parameters)*>(nullptr)); }

}  // namespace

std::vector<std::string> topologies() {
  std::vector<std::string> names;
  for (const Topology& topology : all_topologies()) {
    names.emplace_back(topology.name);
  }
  return names;
}

std::vector<KeyTable> key_tables(const std::string& topology) {
  for (const Topology& known : all_topologies()) {
    if (known.name == topology) {
      return known.tables();
    }
  }
  const std::vector<std::string> known = topologies();
  throw UsageError(fmt::format("--topology {}: {}", topology, suggestion(topology, {known.begin(), known.end()})));
}

std::vector<std::string> key_words() {
  std::set<std::string> words;
  for (const std::string& topology : topologies()) {
    for (const KeyTable& table : key_tables(topology)) {
      words.insert(table.path.starts_with(kEffects) ? table.path.substr(kEffects.size()) : table.path);
      for (const ModelKey& key : table.keys) {
        words.insert(table.path + "." + key.name);
      }
    }
  }
  return {words.begin(), words.end()};
}

}  // namespace hotfire
