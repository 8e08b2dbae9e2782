// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <type_traits>

#include "model/keys.hpp"

namespace hotfire::model {

/// The full name of a parameter in plant images and messages: "engine.inertia", "effects.gimbal_friction.coulomb_torque",
/// "pitch2.engine.inertia". It needs no heap, so the model can return it.
class KeyText {
 public:
  /// `prefix` is of the caller that has several of such sections, "pitch2." say, or empty.
  constexpr KeyText(std::string_view prefix, bool is_effect, std::string_view section, std::string_view name) {
    append(prefix);
    append(is_effect ? "effects." : "");
    append(section);
    append(".");
    append(name);
  }

  constexpr KeyText(const Key& owner, std::string_view name) : KeyText({}, owner.is_effect, owner.section, name) {}

  /// A name with a number from 0 to 99, "string1", and what follows it.
  constexpr KeyText(std::string_view name, int number, std::string_view end) {
    append(name);
    if (number >= 10) {
      text_.at(size_++) = static_cast<char>('0' + number / 10);
    }
    text_.at(size_++) = static_cast<char>('0' + number % 10);
    append(end);
  }

  constexpr std::string_view view() const noexcept { return {text_.data(), size_}; }

 private:
  constexpr void append(std::string_view part) {
    for (const char letter : part) {
      text_.at(size_++) = letter;
    }
  }

  std::array<char, 96> text_{};
  std::size_t size_ = 0;
};

namespace detail {

template <class Owner, class Visitor>
constexpr void visit_owner(std::string_view prefix, bool is_effect, std::string_view section, Owner& owner,
                           Visitor& visitor) {
  for (const auto& field : std::remove_cvref_t<Owner>::fields()) {
    visitor.number(KeyText(prefix, is_effect, section, field.name), field, owner.*field.member);
  }
  if constexpr (requires { std::remove_cvref_t<Owner>::tables(); }) {
    for (const auto& field : std::remove_cvref_t<Owner>::tables()) {
      visitor.table(KeyText(prefix, is_effect, section, field.x_name), KeyText(prefix, is_effect, section, field.y_name),
                    field, owner.*field.member);
    }
  }
}

}  // namespace detail

/// Shows everything that makes a plant to a visitor, under its full key: the parts, then the effects that are wanted.
/// - `number(key, field, value)`: a parameter and its description;
/// - `table(x_key, y_key, field, table)`: a curve; its point i has the keys followed by ".i";
/// - `effect<E>(prefix, active)`: before an effect's own parameters, which are shown if it returns true; `prefix` is
///   "effects.gimbal_friction.";
/// - `option(key, options, option)`: an effect's law or channel, and its further choices.
/// Set-up only. The values that the visitor sees are const if `parameters` is. Every key begins with `prefix`.
template <class Parameters, class Visitor>
constexpr void visit_keys(Parameters& parameters, Visitor& visitor, std::string_view prefix = {}) {
  std::remove_const_t<Parameters>::for_each_part(
      parameters, [&](auto& part) { detail::visit_owner(prefix, false, part.name, part, visitor); });
  visit_effects(parameters, [&]<class E>(std::size_t index, auto& values) {
    if (!visitor.template effect<E>(KeyText(prefix, true, E::name, ""), parameters.effects.active[index])) {
      return;
    }
    if constexpr (E::options.size() > 0) {
      visitor.option(KeyText(prefix, true, E::name, E::option_key), E::options, values.option);
    }
    if constexpr (requires { std::remove_cvref_t<decltype(values)>::choices(); }) {
      for (const auto& choice : std::remove_cvref_t<decltype(values)>::choices()) {
        visitor.option(KeyText(prefix, true, E::name, choice.key), choice.names, values.*choice.member);
      }
    }
    detail::visit_owner(prefix, true, E::name, values, visitor);
  });
}

}  // namespace hotfire::model
