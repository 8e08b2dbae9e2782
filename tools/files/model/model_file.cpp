// SPDX-License-Identifier: Apache-2.0
#include "tools/files/model/model_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "model/checks.hpp"
#include "tools/files/model/model_group.hpp"
#include "tools/files/model/model_layout.hpp"
#include "tools/files/model/plant_of.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"
#include "tools/files/text/toml_source.hpp"

namespace hotfire {

namespace {

/// True if no value can replace a parameter that is left out: it is in the record's own units and zero is not allowed.
bool has_no_reference(const NumberKey& number, bool own_units) { return own_units && number.lower > 0.0; }

void read_parts(const TomlSource& source, const ModelLayout& layout, ModelFile& model) {
  const bool own_units = layout.channels.front().unit.empty();
  const toml::table empty;
  for (const KeyGroup& part : layout.parts) {
    const toml::node* node = source.root().get(part.name);
    const toml::table& table = node != nullptr ? source.table(*node, part.name) : empty;
    const std::string prefix = fmt::format("{}.", part.name);
    for (const NumberKey* number : read_group(source, table, part, prefix)) {
      const std::string key = prefix + std::string{number->name};
      if (has_no_reference(*number, own_units)) {
        source.refuse_missing(
            node != nullptr ? table : source.root(), key,
            fmt::format("missing: topology \"{}\" needs it, in the record's own units, {}; allowed: {:g} to {:g}",
                        layout.topology, number->unit, number->lower, number->upper));
      }
      // A part in the record's own units that the file does not have is not there: its reference values are zero.
      if (!number->has_usual_value && (node != nullptr || !own_units)) {
        model.left_out.push_back(key);
      }
    }
  }
}

void read_effects(const TomlSource& source, const ModelLayout& layout) {
  const toml::node* node = source.root().get("effects");
  if (node == nullptr) {
    return;
  }
  const toml::table& effects = source.table(*node, "effects");
  refuse_unknown_keys(source, effects, "effects.", names_of(layout.effects));
  for (const KeyGroup& effect : layout.effects) {
    if (const toml::node* own = effects.get(effect.name)) {
      const std::string key = fmt::format("effects.{}", effect.name);
      if (effect.needs_other_axis) {
        source.refuse_missing(source.table(*own, key), key,
                              fmt::format("acts from the other axis of an engine, and topology \"{}\" has one axis; "
                                          "allowed with topology \"taos\" or \"masv\"",
                                          layout.topology));
      }
      read_group(source, source.table(*own, key), effect, key + ".");
      *effect.active = true;
    }
  }
}

/// Refuses an effect that acts where the plant has nothing, and values of an effect that contradict each other.
void refuse_broken_effect(const TomlSource& source, const ModelFile& model) {
  const model::Broken broken = std::visit([](const auto& plant) { return model::broken_effect(plant); }, model.parameters);
  if (!broken.relation.empty()) {
    const std::string key = fmt::format("effects.{}", broken.name);
    source.refuse_missing(source.table(*source.root().get("effects"), "effects"), key, std::string(broken.relation));
  }
}

/// The table of that name, if the file has one.
const toml::table* table_of(const TomlSource& source, std::string_view name) {
  const toml::node* node = source.root().get(name);
  return node != nullptr ? &source.table(*node, name) : nullptr;
}

/// Every topology of the variant, quoted.
template <class... Parameters>
std::string topologies_of(const std::variant<Parameters...>&) {
  std::string names;
  ((names += (names.empty() ? "\"" : ", \"") + std::string(PlantOf<Parameters, double>::topology) + "\""), ...);
  return names;
}

/// Gives the variant the reference parameters of a topology. False if it has no plant of that name.
template <class... Parameters>
bool choose(std::string_view topology, std::variant<Parameters...>& parameters) {
  return ((PlantOf<Parameters, double>::topology == topology && (parameters = Parameters{}, true)) || ...);
}

void choose_topology(const TomlSource& source, ModelFile& model) {
  const std::string allowed = "allowed for a model of one axis: " + topologies_of(model.parameters);
  const toml::node* node = source.root().get("topology");
  if (node == nullptr) {
    source.refuse_missing(source.root(), "topology", "missing; " + allowed);
  }
  if (!choose(source.text(*node, "topology"), model.parameters)) {
    source.refuse(*node, "topology", "not a topology that this takes; " + allowed);
  }
}

ModelFile read_model(const TomlSource& source, const std::filesystem::path& path) {
  source.require_schema();
  ModelFile model;
  model.path = path;
  choose_topology(source, model);
  const ModelLayout layout = layout_of(model);

  Words known{"schema", "name", "topology", "sensors", "tolerance", "effects"};
  const Words parts = names_of(layout.parts);
  known.insert(known.end(), parts.begin(), parts.end());
  refuse_unknown_keys(source, source.root(), "", known);

  const toml::node* name = source.root().get("name");
  model.name = name != nullptr ? source.text(*name, "name") : path.stem().string();
  read_parts(source, layout, model);
  read_effects(source, layout);
  refuse_broken_effect(source, model);
  if (const toml::table* sensors = table_of(source, "sensors")) {
    read_noise(source, *sensors, "sensors.", layout.channels, {}, model.noise);
  }
  if (const toml::table* tolerance = table_of(source, "tolerance")) {
    const std::vector<std::string> declared = declared_keys(layout);
    model.tolerance = read_tolerances(source, *tolerance, Words(declared.begin(), declared.end()));
  }
  return model;
}

}  // namespace

ModelFile load_model(const std::filesystem::path& path) { return read_model(TomlSource(path), path); }

ModelFile parse_model(std::string text, const std::filesystem::path& path) {
  return read_model(TomlSource(path, std::move(text)), path);
}

}  // namespace hotfire
