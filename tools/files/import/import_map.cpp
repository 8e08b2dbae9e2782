// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tools/files/import/import.hpp"
#include "tools/files/model/model_group.hpp"
#include "tools/files/text/toml_source.hpp"

namespace hotfire {

namespace {

constexpr double kShortestPeriod = 5e-5;
constexpr double kLongestPeriod = 2e-2;
constexpr double kLongestResampled = 0.1;

/// Where a key of a map belongs; empty for a word that none has.
std::string_view home_of(std::string_view key) {
  if (key == "period" || key == "schema") {
    return "it belongs before the first [table] of the map";
  }
  if (key == "column" || key == "unit" || key == "factor" || key == "offset") {
    return "it belongs into [time] or a [channels.NAME]";
  }
  if (key == "delimiter" || key == "skip_lines" || key == "events") {
    return "it belongs into [csv]";
  }
  if (key == "rows") {
    return "it belongs into [can]";
  }
  return "";
}

/// Refuses a key that is not of this table, and says where it belongs if it is of another.
[[noreturn]] void refuse_stranger(const TomlSource& source, const toml::key& at, const std::string& key,
                                  std::string_view allowed) {
  const std::string_view home = home_of(at.str());
  source.refuse_key(at, key, home.empty() ? fmt::format("unknown key; allowed: {}", allowed) : std::string(home));
}

ImportColumn read_column(const TomlSource& source, const toml::node& node, const std::string& key, std::string channel,
                         ImportSource kind) {
  const toml::table& table = source.table(node, key);
  ImportColumn column;
  column.channel = std::move(channel);
  column.line = table.source().begin.line;
  for (const auto& [name, value] : table) {
    const std::string own = key + "." + std::string(name.str());
    if (name.str() == "column") {
      column.column = source.text(value, own);
    } else if (name.str() == "unit") {
      column.unit = source.text(value, own);
    } else if (name.str() == "factor") {
      column.factor = source.number(value, own, "1");
      if (column.factor == 0.0) {
        source.refuse(value, own, "a channel times nothing; allowed: any other number, -1 turns a sign");
      }
    } else if (name.str() != "offset") {
      refuse_stranger(source, name, own, "column, unit, factor, offset");
    }
  }
  if (const toml::node* offset = table.get("offset")) {
    column.offset = source.number(*offset, key + ".offset", column.unit.empty() ? "1" : column.unit);
  }
  for (const std::string_view needed : {"column", "unit"}) {
    const bool is_in_dbc = kind == ImportSource::candump_log && needed == "unit";
    if (!table.contains(needed) && !is_in_dbc) {
      source.refuse_missing(table, fmt::format("{}.{}", key, needed),
                            "missing; write for example column = \"BETA_CMD\", unit = \"deg\"");
    }
  }
  return column;
}

void read_csv_settings(const TomlSource& source, const toml::node& node, ImportMap& map) {
  for (const auto& [name, value] : source.table(node, "csv")) {
    const std::string key = "csv." + std::string(name.str());
    if (name.str() == "delimiter") {
      const std::string text = source.text(value, key);
      if (text.size() != 1 || text.find_first_of("0123456789.+-eE\"") != std::string::npos) {
        source.refuse(value, key, "allowed: one character that no number has, such as \",\", \";\" or \"\\t\"");
      }
      map.delimiter = text.front();
    } else if (name.str() == "skip_lines") {
      const double lines = source.number(value, key, "1");
      if (lines < 0.0 || lines > 1000.0 || lines != static_cast<double>(static_cast<std::size_t>(lines))) {
        source.refuse(value, key, "allowed: a whole number from 0 to 1000");
      }
      map.skip_lines = static_cast<std::size_t>(lines);
    } else if (name.str() == "events") {
      map.events = source.text(value, key);
    } else {
      refuse_stranger(source, name, key, "delimiter, skip_lines, events");
    }
  }
}

void read_resampling(const TomlSource& source, const toml::node& node, ImportMap& map) {
  const toml::table& table = source.table(node, "resample");
  refuse_unknown_keys(source, table, "resample.", {"period"});
  const toml::node* period = table.get("period");
  if (period == nullptr) {
    source.refuse_missing(table, "resample.period", "missing; write the period of the record, such as period = \"2 ms\"");
  }
  map.resampling_period = source.number(*period, "resample.period", "s");
  if (!(map.resampling_period >= kShortestPeriod && map.resampling_period <= kLongestPeriod)) {
    source.refuse(*period, "resample.period", "allowed: 50 us to 20 ms (20 kHz to 50 Hz)");
  }
}

void read_time(const TomlSource& source, ImportMap& map) {
  const toml::table& root = source.root();
  if (const toml::node* node = root.get("resample")) {
    read_resampling(source, *node, map);
  }
  if (const toml::node* node = root.get("time")) {
    map.columns.push_back(read_column(source, *node, "time", "time", ImportSource::table));
  }
  if (const toml::node* node = root.get("period")) {
    if (!map.columns.empty()) {
      source.refuse(*node, "period", "there is a time column too; give one of the two");
    }
    map.period = source.number(*node, "period", "s");
    const double longest = map.resampling_period > 0.0 ? kLongestResampled : kLongestPeriod;
    if (!(map.period >= kShortestPeriod && map.period <= longest)) {
      source.refuse(
          *node, "period",
          map.resampling_period > 0.0
              ? "allowed: 50 us to 100 ms (20 kHz to 10 Hz)"
              : "allowed: 50 us to 20 ms (20 kHz to 50 Hz); with [resample] period = \"10 ms\", say, up to 100 ms");
    }
  } else if (map.columns.empty()) {
    source.refuse_missing(root, "time", "missing; write [time] column = \"t\", unit = \"s\", or period = \"2 ms\"");
  }
}

void read_can_settings(const TomlSource& source, ImportMap& map) {
  for (const auto& [name, node] : source.root()) {
    if (name.str() == "time" || name.str() == "period" || name.str() == "csv" || name.str() == "resample") {
      source.refuse_key(name, name.str(), "not of a candump log, whose frames have their times; leave it out");
    }
  }
  if (const toml::node* node = source.root().get("can")) {
    const toml::table& table = source.table(*node, "can");
    refuse_unknown_keys(source, table, "can.", {"rows"});
    if (const toml::node* rows = table.get("rows")) {
      map.rows = source.text(*rows, "can.rows");
    }
  }
}

}  // namespace

ImportMap load_import_map(const std::filesystem::path& path, ImportSource kind) {
  const TomlSource source(path);
  const toml::table& root = source.root();
  for (const auto& [name, node] : root) {
    if (!home_of(name.str()).empty() && name.str() != "period" && name.str() != "schema") {
      source.refuse_key(name, name.str(), home_of(name.str()));
    }
  }
  refuse_unknown_keys(source, root, "", {"schema", "period", "time", "channels", "csv", "can", "resample"});
  source.require_schema();
  ImportMap map;
  map.path = path;
  // Channels before the time: a period below one of their headings is then known from a missing one.
  const toml::node* channels = root.get("channels");
  if (channels == nullptr || source.table(*channels, "channels").empty()) {
    source.refuse_missing(root, "channels", "missing; write [channels.command] column = \"BETA_CMD\", unit = \"deg\"");
  }
  std::vector<ImportColumn> found;
  for (const auto& [name, node] : source.table(*channels, "channels")) {
    found.push_back(read_column(source, node, "channels." + std::string(name.str()), std::string(name.str()), kind));
  }
  if (kind == ImportSource::candump_log) {
    read_can_settings(source, map);
  } else {
    read_time(source, map);
    for (const auto& [name, node] : root) {
      if (name.str() == "can") {
        source.refuse_key(name, "can", "of a candump log only, which is imported with --dbc; leave it out");
      }
    }
  }
  map.columns.insert(map.columns.end(), found.begin(), found.end());
  if (const toml::node* node = root.get("csv")) {
    read_csv_settings(source, *node, map);
  }
  return map;
}

}  // namespace hotfire
