// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace hotfire {

/// Exponents of the SI base units in the order of FMI's BaseUnit: kg, m, s, A, K, mol, cd, rad.
using BaseUnit = std::array<int, 8>;
inline constexpr std::array<std::string_view, 8> kBaseUnits{"kg", "m", "s", "A", "K", "mol", "cd", "rad"};

/// The base unit of a coherent SI unit as the model's fields write it, "N.m.s/rad"; none for a unit that follows the
/// record's own, "force/position".
std::optional<BaseUnit> base_unit_of(std::string_view unit);

}  // namespace hotfire
