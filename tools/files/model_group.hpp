#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/files/model_layout.hpp"
#include "tools/files/toml_source.hpp"

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

/// Refuses every key of a table that is not in `known`. `prefix` is where the table stands, "actuator." say.
void refuse_unknown_keys(const TomlSource& source, const toml::table& table, std::string_view prefix, const Words& known);

/// Reads one table of a model file into the parameters its group leads to, and checks it. Returns the numbers it does not
/// give. Keys in `others` may stand there too and are left to who knows them. Throws FileError.
std::vector<const NumberKey*> read_group(const TomlSource& source, const toml::table& table, const KeyGroup& group,
                                         const std::string& prefix, const Words& others = {});

}  // namespace hotfire
