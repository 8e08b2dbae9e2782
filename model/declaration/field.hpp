// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>

namespace hotfire::model {

/// The one description of a parameter. The configuration key and its check, the documentation, the words of the report and
/// the fit all read it, so that no number is described twice.
///
/// `unit` is a UDUNITS-2 string ("1" for none, "" for a unit that follows the record's own). Bounds are inclusive. `typical`
/// is the start of a search, in the region where the parameter acts, because a neutral value has no gradient; 0: no search
/// moves it. `options` has one bit for each option (law, channel) of the owner that uses the field.
template <class Owner>
struct Field {
  std::string_view name;
  std::string_view unit;
  double lower = 0.0;
  double upper = 0.0;
  double typical = 0.0;
  std::string_view meaning;
  typename Owner::Scalar Owner::*member;
  unsigned options = ~0U;
};

/// A curve given by points: `x_name` strictly increasing, `y_name` one value a point, at most `Owner::kTablePoints`.
template <class Owner, class Table>
struct TableField {
  std::string_view x_name;
  std::string_view x_unit;
  std::string_view y_name;
  std::string_view y_unit;
  double y_lower = 0.0;
  double y_upper = 0.0;
  std::string_view meaning;
  Table Owner::*member;
  unsigned options = ~0U;
  double y_typical = 0.0;    ///< size of what a fit looks for; 0 where no fit moves the points
  bool is_optional = false;  ///< a file may leave the curve out: it has no points then
};

/// A further choice of an effect in addition to its option: its key, its allowed values, and the member that stores it.
template <class Owner>
struct Choice {
  std::string_view key;
  std::span<const std::string_view> names;
  int Owner::*member;
};

/// The `options` of a field that belongs to some laws or channels of its owner: `only(Law::dahl, Law::lugre)`.
template <class Law, class... Laws>
constexpr unsigned only(Law law, Laws... laws) {
  return ((1U << static_cast<unsigned>(law)) | ... | (1U << static_cast<unsigned>(laws)));
}

/// The law, or the channel, that the parameters of effect E have chosen.
template <class E, class Params>
constexpr typename E::Law law_of(const Params& params) noexcept {
  return static_cast<typename E::Law>(params.option);
}

/// True if the law or channel `option` of the owner uses a field or a curve with these options.
constexpr bool is_used(unsigned options, int option) { return (options >> static_cast<unsigned>(option) & 1U) != 0; }

/// True if a search moves the field under an option: one without a typical value it does not.
template <class Owner>
constexpr bool is_searched(const Field<Owner>& field, int option) {
  return field.typical != 0.0 && is_used(field.options, option);
}

/// A bounded field whose range does not include negative values is searched in logarithms, others linearly.
template <class Owner>
constexpr bool searched_in_logarithms(const Field<Owner>& field) {
  return field.lower >= 0.0;
}

}  // namespace hotfire::model
