// SPDX-License-Identifier: Apache-2.0
#include "tools/export/unit_definition.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

namespace hotfire {

namespace {

constexpr std::array<std::pair<std::string_view, BaseUnit>, 12> kUnits{{{"1", {}},
                                                                        {"kg", {1}},
                                                                        {"m", {0, 1}},
                                                                        {"s", {0, 0, 1}},
                                                                        {"rad", {0, 0, 0, 0, 0, 0, 0, 1}},
                                                                        {"N", {1, 1, -2}},
                                                                        {"Pa", {1, -1, -2}},
                                                                        {"Hz", {0, 0, -1}},
                                                                        {"J", {1, 2, -2}},
                                                                        {"A", {0, 0, 0, 1}},
                                                                        {"ohm", {1, 2, -3, -2}},
                                                                        {"H", {1, 2, -2, -2}}}};

/// Adds a factor with its exponent, "m^3"; false if it is not known.
bool add(std::string_view factor, int sign, BaseUnit& sum) {
  const std::size_t hat = factor.find('^');
  int exponent = 1;
  if (hat != std::string_view::npos) {
    const auto [end, error] = std::from_chars(factor.data() + hat + 1, factor.data() + factor.size(), exponent);
    if (error != std::errc{} || end != factor.data() + factor.size()) {
      return false;
    }
    factor = factor.substr(0, hat);
  }
  for (const auto& [name, base] : kUnits) {
    if (name == factor) {
      for (std::size_t i = 0; i < sum.size(); ++i) {
        sum[i] += sign * exponent * base[i];
      }
      return true;
    }
  }
  return false;
}

}  // namespace

std::optional<BaseUnit> base_unit_of(std::string_view unit) {
  BaseUnit sum{};
  int sign = 1;
  while (!unit.empty()) {
    const std::size_t end = std::min(unit.find_first_of("./"), unit.size());
    if (!add(unit.substr(0, end), sign, sum)) {
      return std::nullopt;
    }
    if (end == unit.size()) {
      return sum;
    }
    // A slash divides by the one factor behind it.
    sign = unit[end] == '/' ? -1 : 1;
    unit.remove_prefix(end + 1);
  }
  return std::nullopt;
}

}  // namespace hotfire
