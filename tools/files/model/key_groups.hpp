// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "model/keys.hpp"
#include "tools/files/model/model_layout.hpp"

namespace hotfire {

// Key groups from the fields of the model's parts and effects: the one place where the keys of a model file come from.

template <class Values>
std::vector<NumberKey> number_keys(Values& values) {
  std::vector<NumberKey> keys;
  for (const auto& field : Values::fields()) {
    keys.push_back({field.name, field.unit, field.lower, field.upper, field.meaning, &(values.*field.member), field.options,
                    field.typical == 0.0});
  }
  return keys;
}

template <class Values>
std::vector<CurveKey> curve_keys(Values& values) {
  std::vector<CurveKey> keys;
  if constexpr (requires { Values::tables(); }) {
    for (const auto& field : Values::tables()) {
      auto& table = values.*field.member;
      keys.push_back({field.x_name, field.x_unit, field.y_name, field.y_unit, field.y_lower, field.y_upper, field.meaning,
                      table.x.data(), table.y.data(), &table.points, table.x.size(), field.options, field.is_optional});
    }
  }
  return keys;
}

template <class Owner, class Values>
std::function<std::string_view()> relation_of(Values& values) {
  if constexpr (requires { Owner::broken_relation(values); }) {
    return [&values] { return Owner::broken_relation(values); };
  } else {
    return [] { return std::string_view{}; };
  }
}

template <class Effect, class Values>
KeyGroup effect_group(Values& values, bool& active) {
  KeyGroup group;
  group.name = Effect::name;
  group.numbers = number_keys(values);
  group.curves = curve_keys(values);
  if constexpr (requires { Effect::option_key; }) {
    group.option_key = Effect::option_key;
    group.options.assign(Effect::options.begin(), Effect::options.end());
  }
  group.option = &values.option;
  if constexpr (requires { Values::choices(); }) {
    for (const auto& choice : Values::choices()) {
      group.choices.push_back({choice.key, {choice.names.begin(), choice.names.end()}, &(values.*choice.member)});
    }
  }
  group.active = &active;
  group.site = model::site_name(Effect::site);
  group.needs_other_axis = model::needs_other_axis<Effect>();
  group.broken_relation = relation_of<Effect>(values);
  return group;
}

/// A declared part, with the choice of its law if it has one.
template <class Part>
KeyGroup part_group(Part& part) {
  KeyGroup group;
  group.name = Part::name;
  group.numbers = number_keys(part);
  if constexpr (requires { Part::option_key; }) {
    group.option_key = Part::option_key;
    group.options.assign(Part::options.begin(), Part::options.end());
    group.option = &part.option;
  }
  group.broken_relation = relation_of<Part>(part);
  return group;
}

template <class Plant>
std::vector<ModelChannel> channels_of_plant() {
  std::vector<ModelChannel> channels;
  for (std::size_t channel = 0; channel < Plant::channels.size(); ++channel) {
    channels.push_back({Plant::channels[channel], Plant::channel_units[channel]});
  }
  return channels;
}

template <class Plant>
ModelLayout layout_of_plant(typename Plant::Parameters& parameters) {
  ModelLayout layout;
  layout.topology = Plant::topology;
  layout.input_channel = Plant::input_channel;
  layout.channels = channels_of_plant<Plant>();
  Plant::Parameters::for_each_part(parameters, [&layout](auto& part) { layout.parts.push_back(part_group(part)); });
  model::visit_effects(parameters, [&]<class Effect>(std::size_t index, auto& values) {
    layout.effects.push_back(effect_group<Effect>(values, parameters.effects.active[index]));
  });
  return layout;
}

}  // namespace hotfire
