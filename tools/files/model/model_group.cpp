// SPDX-License-Identifier: Apache-2.0
#include "tools/files/model/model_group.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>

#include "model/checks.hpp"
#include "tools/files/text/suggestion.hpp"

namespace hotfire {

namespace {

double bounded_number(const TomlSource& source, const toml::node& node, const std::string& key, const NumberKey& field) {
  const double value = source.number(node, key, field.unit);
  if (!model::is_inside(value, field.lower, field.upper)) {
    source.refuse(node, key,
                  fmt::format("outside its bounds; allowed: {:g} to {:g} {}", field.lower, field.upper, field.unit));
  }
  return value;
}

/// The names of the options whose bits are set, for messages.
std::string options_using(const KeyGroup& group, unsigned bits) {
  std::string names;
  for (std::size_t i = 0; i < group.options.size(); ++i) {
    if (model::is_used(bits, static_cast<int>(i))) {
      names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", group.options[i]);
    }
  }
  return names;
}

void refuse_unused(const TomlSource& source, const toml::table& table, const KeyGroup& group, const std::string& prefix,
                   std::string_view name, unsigned bits) {
  const auto entry = table.find(name);
  if (entry != table.end() && !group.uses(bits)) {
    source.refuse_key(
        entry->first, prefix + std::string{name},
        fmt::format("has no meaning with {} = \"{}\"; it belongs to {}: remove it or change {}", group.option_key,
                    group.options[static_cast<std::size_t>(*group.option)], options_using(group, bits), group.option_key));
  }
}

void read_choice(const TomlSource& source, const toml::table& table, const std::string& prefix, const ChoiceKey& choice,
                 Extent extent) {
  const toml::node* node = table.get(choice.key);
  if (node == nullptr && extent == Extent::difference) {
    return;
  }
  const std::string key = prefix + std::string{choice.key};
  if (node == nullptr) {
    source.refuse_missing(table, key, fmt::format("missing; allowed: \"{}\"", fmt::join(choice.names, "\", \"")));
  }
  const std::string chosen = source.text(*node, key);
  const int option = model::option_named(choice.names, chosen);
  if (option < 0) {
    source.refuse(*node, key, suggestion(chosen, choice.names));
  }
  *choice.value = option;
}

std::vector<double> read_array(const TomlSource& source, const toml::table& table, const std::string& prefix,
                               std::string_view name, std::string_view unit, const CurveKey& curve) {
  const std::string key = prefix + std::string{name};
  const toml::node* node = table.get(name);
  if (node == nullptr) {
    source.refuse_missing(table, key, fmt::format("missing; a curve is given by {} and {}", curve.x_name, curve.y_name));
  }
  const toml::array* array = node->as_array();
  if (array == nullptr) {
    source.refuse(*node, key, fmt::format("must be an array of numbers in {}, one a point", unit));
  }
  if (array->size() > curve.capacity) {
    source.refuse(*node, key, fmt::format("has {} points; allowed: at most {}", array->size(), curve.capacity));
  }
  std::vector<double> values;
  for (const toml::node& element : *array) {
    values.push_back(source.number(element, fmt::format("{}[{}]", key, values.size()), unit));
  }
  return values;
}

void read_curve(const TomlSource& source, const toml::table& table, const std::string& prefix, const CurveKey& curve) {
  const std::vector<double> x = read_array(source, table, prefix, curve.x_name, curve.x_unit, curve);
  const std::vector<double> y = read_array(source, table, prefix, curve.y_name, curve.y_unit, curve);
  const toml::array& x_nodes = *table.get_as<toml::array>(curve.x_name);
  const toml::array& y_nodes = *table.get_as<toml::array>(curve.y_name);
  if (x.size() != y.size()) {
    source.refuse(y_nodes, prefix + std::string{curve.y_name},
                  fmt::format("has {} points where {} has {}; allowed: as many", y.size(), curve.x_name, x.size()));
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!model::rises(x, i)) {
      source.refuse(x_nodes[i], fmt::format("{}{}[{}]", prefix, curve.x_name, i), "must be above the value before it");
    }
    if (!model::is_inside(y[i], curve.y_lower, curve.y_upper)) {
      source.refuse(y_nodes[i], fmt::format("{}{}[{}]", prefix, curve.y_name, i),
                    fmt::format("outside its bounds; allowed: {:g} to {:g} {}", curve.y_lower, curve.y_upper, curve.y_unit));
    }
  }
  std::copy(x.begin(), x.end(), curve.x);
  std::copy(y.begin(), y.end(), curve.y);
  *curve.points = static_cast<int>(x.size());
}

void read_tolerances(const TomlSource& source, const toml::table& table, const std::string& prefix, const Words& declared,
                     std::map<std::string, double>& tolerances) {
  for (const auto& [own_key, node] : table) {
    const std::string key = prefix + std::string{own_key.str()};
    if (const toml::table* nested = node.as_table()) {
      read_tolerances(source, *nested, key + ".", declared, tolerances);
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
    tolerances[key] = relative;
  }
}

Words keys_of(const KeyGroup& group) {
  Words known = names_of(group.numbers);
  for (const CurveKey& curve : group.curves) {
    known.push_back(curve.x_name);
    known.push_back(curve.y_name);
  }
  if (!group.option_key.empty()) {
    known.push_back(group.option_key);
  }
  for (const ChoiceKey& choice : group.choices) {
    known.push_back(choice.key);
  }
  return known;
}

}  // namespace

void refuse_unknown_keys(const TomlSource& source, const toml::table& table, std::string_view prefix, const Words& known) {
  for (const auto& [key, node] : table) {
    if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
      source.refuse_key(key, fmt::format("{}{}", prefix, key.str()), "unknown key; " + suggestion(key.str(), known));
    }
  }
}

std::vector<const NumberKey*> read_group(const TomlSource& source, const toml::table& table, const KeyGroup& group,
                                         const std::string& prefix, const Words& others, Extent extent) {
  Words known = keys_of(group);
  known.insert(known.end(), others.begin(), others.end());
  refuse_unknown_keys(source, table, prefix, known);
  if (!group.options.empty()) {
    read_choice(source, table, prefix, {group.option_key, group.options, group.option}, extent);
  }
  for (const ChoiceKey& choice : group.choices) {
    read_choice(source, table, prefix, choice, extent);
  }
  std::vector<const NumberKey*> left_out;
  for (const NumberKey& number : group.numbers) {
    refuse_unused(source, table, group, prefix, number.name, number.options);
    if (const toml::node* node = table.get(number.name)) {
      *number.value = bounded_number(source, *node, prefix + std::string{number.name}, number);
    } else {
      left_out.push_back(&number);
    }
  }
  for (const CurveKey& curve : group.curves) {
    refuse_unused(source, table, group, prefix, curve.x_name, curve.options);
    refuse_unused(source, table, group, prefix, curve.y_name, curve.options);
    const bool said = table.contains(curve.x_name) || table.contains(curve.y_name);
    if (group.uses(curve.options) && (said || (extent == Extent::whole && !curve.is_optional))) {
      read_curve(source, table, prefix, curve);
    }
  }
  if (const std::string_view broken = group.broken_relation(); !broken.empty()) {
    source.refuse_missing(table, prefix.substr(0, prefix.size() - 1), broken);
  }
  return left_out;
}

void read_noise(const TomlSource& source, const toml::table& table, const std::string& prefix,
                const std::vector<ModelChannel>& channels, const Words& others, std::map<std::string, double>& noise) {
  std::vector<std::string> keys;
  keys.reserve(channels.size());
  for (const ModelChannel& channel : channels) {
    keys.push_back(fmt::format("{}_noise", channel.name));
  }
  Words known(keys.begin(), keys.end());
  known.insert(known.end(), others.begin(), others.end());
  refuse_unknown_keys(source, table, prefix, known);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (const toml::node* node = table.get(keys[i])) {
      const double rms = source.number(*node, prefix + keys[i], channels[i].unit);
      if (!(rms > 0.0)) {
        source.refuse(*node, prefix + keys[i], "an rms noise; allowed: above 0 (leave it out to have it estimated)");
      }
      noise[std::string{channels[i].name}] = rms;
    }
  }
}

std::map<std::string, double> read_tolerances(const TomlSource& source, const toml::table& table, const Words& declared) {
  std::map<std::string, double> tolerances;
  read_tolerances(source, table, "", declared, tolerances);
  return tolerances;
}

std::vector<std::string> declared_keys(const ModelLayout& layout) {
  std::vector<std::string> keys;
  for (const KeyGroup& part : layout.parts) {
    for (const NumberKey& number : part.numbers) {
      keys.push_back(fmt::format("{}.{}", part.name, number.name));
    }
  }
  for (const KeyGroup& effect : layout.effects) {
    for (const NumberKey& number : effect.numbers) {
      if (*effect.active && effect.uses(number.options)) {
        keys.push_back(fmt::format("effects.{}.{}", effect.name, number.name));
      }
    }
  }
  return keys;
}

void require_schema(const TomlSource& source) {
  const toml::node* schema = source.root().get("schema");
  if (schema == nullptr) {
    source.refuse_missing(source.root(), "schema", "missing; write schema = 1 on the first line");
  }
  if (schema->value_exact<std::int64_t>() != std::int64_t{1}) {
    source.refuse(*schema, "schema", "not read by this build; allowed: 1");
  }
}

}  // namespace hotfire
