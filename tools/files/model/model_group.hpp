// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tools/files/model/model_layout.hpp"
#include "tools/files/text/toml_source.hpp"

namespace hotfire {

using Words = std::vector<std::string_view>;

template <class Items>
Words names_of(const Items& items) {
  Words names;
  for (const auto& item : items) {
    names.push_back(item.name);
  }
  return names;
}

/// Refuses a file without `schema = 1`.
void require_schema(const TomlSource& source);

/// Refuses every key of a table that is not in `known`. `prefix` is the path of the table, such as "actuator.".
void refuse_unknown_keys(const TomlSource& source, const toml::table& table, std::string_view prefix, const Words& known);

/// What a table of a model file is: all that is said of its group, or what differs from what was said before.
enum class Extent { whole, difference };

/// Reads one table of a model file into the parameters its group leads to, and checks it. Returns the numbers it does not
/// give. Keys in `others` may be there too and are left to their own reader. Throws FileError.
std::vector<const NumberKey*> read_group(const TomlSource& source, const toml::table& table, const KeyGroup& group,
                                         const std::string& prefix, const Words& others = {}, Extent extent = Extent::whole);

/// Reads the rms noises ("piston_noise") that a `[sensors]` table gives of the channels, into `noise` by channel. Keys in
/// `others` are left to who knows them. Throws FileError.
void read_noise(const TomlSource& source, const toml::table& table, const std::string& prefix,
                const std::vector<ModelChannel>& channels, const Words& others, std::map<std::string, double>& noise);

/// The relative tolerances that a `[tolerance]` table gives, by key: `servovalve.position_gain = 0.03`, which TOML nests, or
/// the same key in quotes. Throws FileError for a key that is not in `declared` and for a value that is no tolerance.
std::map<std::string, double> read_tolerances(const TomlSource& source, const toml::table& table, const Words& declared);

/// The keys of the numbers of a layout's parts, "servovalve.position_gain", and of its active effects,
/// "effects.gimbal_friction.coulomb_torque".
std::vector<std::string> declared_keys(const ModelLayout& layout);

}  // namespace hotfire
