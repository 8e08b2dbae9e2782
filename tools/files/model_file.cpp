#include "tools/files/model_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/files/error.hpp"
#include "tools/files/model_group.hpp"
#include "tools/files/model_layout.hpp"
#include "tools/files/suggestion.hpp"
#include "tools/files/toml_source.hpp"

namespace hotfire {

namespace {

/// True if no value can stand for a parameter that is left out: it is in the record's own units and zero is not allowed.
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
      model.left_out.push_back(key);
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
      read_group(source, source.table(*own, key), effect, key + ".");
      *effect.active = true;
    }
  }
}

void read_sensors(const TomlSource& source, const ModelLayout& layout, ModelFile& model) {
  const toml::node* node = source.root().get("sensors");
  if (node == nullptr) {
    return;
  }
  const toml::table& sensors = source.table(*node, "sensors");
  std::vector<std::string> keys;
  for (const ModelChannel& channel : layout.channels) {
    keys.push_back(fmt::format("{}_noise", channel.name));
  }
  refuse_unknown_keys(source, sensors, "sensors.", Words(keys.begin(), keys.end()));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (const toml::node* noise = sensors.get(keys[i])) {
      const double rms = source.number(*noise, "sensors." + keys[i], layout.channels[i].unit);
      if (!(rms > 0.0)) {
        source.refuse(*noise, "sensors." + keys[i], "an rms noise; allowed: above 0 (leave it out to have it estimated)");
      }
      model.noise[std::string{layout.channels[i].name}] = rms;
    }
  }
}

/// Reads `servovalve.position_gain = 0.03`, which TOML nests, and the same key in quotes.
void read_tolerances(const TomlSource& source, const toml::table& table, const std::string& prefix, const Words& declared,
                     ModelFile& model) {
  for (const auto& [own_key, node] : table) {
    const std::string key = prefix + std::string{own_key.str()};
    if (const toml::table* nested = node.as_table()) {
      read_tolerances(source, *nested, key + ".", declared, model);
      continue;
    }
    if (std::find(declared.begin(), declared.end(), key) == declared.end()) {
      source.refuse_key(own_key, "tolerance of " + key, "no such declared parameter; " + suggestion(key, declared));
    }
    const double relative = source.number(node, "tolerance of " + key, "1");
    if (!(relative > 0.0 && relative <= 1.0)) {
      source.refuse(node, "tolerance of " + key,
                    "a relative one-sigma; allowed: above 0, at most 1 (leave it out if exact)");
    }
    model.tolerance[key] = relative;
  }
}

void read_tolerances(const TomlSource& source, const ModelLayout& layout, ModelFile& model) {
  const toml::node* node = source.root().get("tolerance");
  if (node == nullptr) {
    return;
  }
  std::vector<std::string> declared;
  for (const KeyGroup& part : layout.parts) {
    for (const NumberKey& number : part.numbers) {
      declared.push_back(fmt::format("{}.{}", part.name, number.name));
    }
  }
  read_tolerances(source, source.table(*node, "tolerance"), "", Words(declared.begin(), declared.end()), model);
}

void choose_topology(const TomlSource& source, ModelFile& model) {
  const std::string allowed = fmt::format("allowed where one axis is asked for: \"{}\", \"{}\"",
                                          model::Simplex<double>::topology, model::Direct<double>::topology);
  const toml::node* node = source.root().get("topology");
  if (node == nullptr) {
    source.refuse_missing(source.root(), "topology", "missing; " + allowed);
  }
  const std::string topology = source.text(*node, "topology");
  if (topology == model::Simplex<double>::topology) {
    model.parameters = SimplexParameters{};
  } else if (topology == model::Direct<double>::topology) {
    model.parameters = DirectParameters{};
  } else {
    source.refuse(*node, "topology", "not a topology that this takes; " + allowed);
  }
}

}  // namespace

ModelFile load_model(const std::filesystem::path& path) {
  const TomlSource source(path);
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
  read_sensors(source, layout, model);
  read_tolerances(source, layout, model);
  return model;
}

}  // namespace hotfire
