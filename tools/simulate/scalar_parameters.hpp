// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tuple>
#include <vector>

#include "model/keys.hpp"

namespace hotfire {

/// Copies what is not a scalar field of an effect: its option, its further choices and its tables.
template <class FromValues, class ToValues>
void copy_choices(const FromValues& from, ToValues& to) {
  to.option = from.option;
  if constexpr (requires { FromValues::choices(); }) {
    for (std::size_t i = 0; i < FromValues::choices().size(); ++i) {
      to.*ToValues::choices()[i].member = from.*FromValues::choices()[i].member;
    }
  }
  if constexpr (requires { FromValues::tables(); }) {
    const auto from_tables = FromValues::tables();
    const auto to_tables = ToValues::tables();
    for (std::size_t t = 0; t < from_tables.size(); ++t) {
      const auto& source = from.*from_tables[t].member;
      auto& target = to.*to_tables[t].member;
      target.points = source.points;
      for (std::size_t k = 0; k < source.x.size(); ++k) {
        target.x[k] = typename ToValues::Scalar(source.x[k]);
        target.y[k] = typename ToValues::Scalar(source.y[k]);
      }
    }
  }
}

/// Parameters in another scalar: every field by value, options, tables and activity as they are. The derivatives of a dual
/// number are left at zero.
template <class To, class From>
To with_scalar(const From& from) {
  To to;
  std::vector<double> values;
  model::visit_parameters(from, [&](const model::Key&, const auto&, const auto& value) { values.push_back(value); });
  std::size_t next = 0;
  model::visit_parameters(to, [&](const model::Key&, const auto&, auto& value) {
    value = std::remove_cvref_t<decltype(value)>(values[next++]);
  });
  to.effects.active = from.effects.active;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    ((copy_choices(std::get<I>(from.effects.values), std::get<I>(to.effects.values))), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<decltype(from.effects.values)>>{});
  return to;
}

}  // namespace hotfire
