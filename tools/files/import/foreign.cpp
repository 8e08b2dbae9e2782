// SPDX-License-Identifier: Apache-2.0
#include "tools/files/import/foreign.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

#include "tools/files/exchange/hdf5.hpp"
#include "tools/files/exchange/matlab_writer.hpp"
#include "tools/files/exchange/mdf4.hpp"
#include "tools/files/import/columns.hpp"
#include "tools/files/import/matlab_reader.hpp"
#include "tools/files/record/axis_names.hpp"
#include "tools/files/record/record_channels.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/private_folder.hpp"
#include "tools/files/text/suggestion.hpp"

namespace hotfire {

namespace {

constexpr const char* kTime = "time";

bool is_matlab(const std::filesystem::path& path) { return path.extension() == ".mat"; }
bool is_mdf4(const std::filesystem::path& path) { return path.extension() == ".mf4"; }

std::vector<ForeignGroup> groups_of(const std::filesystem::path& path) {
  return is_mdf4(path) ? read_mdf4(path) : read_hdf5(path);
}

/// What a channel without a unit is measured in.
std::string known_unit(const std::string& unit) { return unit.empty() ? "1" : unit; }

/// "piston.pitch" of the variable "piston_pitch"; "load_pressure" is a name of its own.
std::string channel_of_variable(std::string name) {
  const std::size_t last = name.rfind('_');
  if (!is_record_channel(own_name(name)) && last != std::string::npos) {
    name[last] = '.';
  }
  return name;
}

/// The map of a file whose channels have the names of a record.
ImportMap own_map(const std::filesystem::path& path, const std::vector<ForeignGroup>& groups) {
  ImportMap map;
  map.path = path;
  if (is_matlab(path)) {
    for (const MatlabVariable& variable : read_matlab_variables(path)) {
      map.columns.push_back({channel_of_variable(variable.name), variable.name, known_unit(variable.unit)});
    }
  }
  const ForeignGroup* used = nullptr;
  for (const ForeignGroup& group : groups) {
    if (group.channels.empty()) {
      continue;
    }
    if (used != nullptr) {
      throw FileError(
          fmt::format("{}: several groups of channels, \"{}\" and \"{}\"; a record has one: choose with a map, "
                      "'hotfire import --help'",
                      path.string(), used->name, group.name));
    }
    used = &group;
    for (const ForeignChannel& channel : group.channels) {
      map.columns.push_back({channel.is_time ? kTime : channel.name, channel.name, known_unit(channel.unit)});
    }
  }
  const auto time = std::ranges::find(map.columns, kTime, &ImportColumn::channel);
  if (time == map.columns.end()) {
    throw FileError(fmt::format("{}: no channel \"time\"; name it with a map, 'hotfire import --help'", path.string()));
  }
  std::rotate(map.columns.begin(), time, time + 1);
  for (const ImportColumn& column : map.columns) {
    if (column.channel != kTime && !is_record_channel(own_name(column.channel))) {
      throw FileError(
          fmt::format("{}: channel \"{}\" is none of a record; name the channels with a map, 'hotfire import "
                      "--help'",
                      path.string(), column.column));
    }
  }
  return map;
}

struct Found {
  const ForeignGroup* group = nullptr;
  const ForeignChannel* channel = nullptr;
};

Found find(const std::filesystem::path& path, const std::vector<ForeignGroup>& groups, const ImportColumn& column) {
  std::vector<Found> found;
  std::vector<std::string> names;
  for (const ForeignGroup& group : groups) {
    for (const ForeignChannel& channel : group.channels) {
      const std::string full = group.name + "/" + channel.name;
      names.push_back(channel.name);
      if (column.column == channel.name || column.column == full) {
        found.push_back({&group, &channel});
      }
    }
  }
  if (found.empty()) {
    throw FileError(fmt::format("{}: no channel \"{}\" for {}; {}", path.string(), column.column, column.channel,
                                suggestion(column.column, {names.begin(), names.end()})));
  }
  if (found.size() > 1) {
    throw FileError(fmt::format("{}: {} channels \"{}\" for {}; write GROUP/CHANNEL, such as \"{}/{}\"", path.string(),
                                found.size(), column.column, column.channel, found.front().group->name, column.column));
  }
  return found.front();
}

std::vector<std::vector<double>> columns_of(const std::filesystem::path& path, const std::vector<ForeignGroup>& groups,
                                            const ImportMap& map) {
  std::vector<std::vector<double>> values;
  const ForeignGroup* first = nullptr;
  for (const ImportColumn& column : map.columns) {
    const Found found = find(path, groups, column);
    if (first != nullptr && found.group != first) {
      throw FileError(
          fmt::format("{}: \"{}\" is of group \"{}\", and \"{}\" of group \"{}\": they were sampled apart; import "
                      "channels of one group",
                      path.string(), column.column, found.group->name, map.columns.front().column, first->name));
    }
    first = found.group;
    values.push_back(found.channel->values);
  }
  require_equal_rows(path, map, values);
  return values;
}

}  // namespace

std::vector<std::string> foreign_extensions() { return {".mf4", ".h5", ".hdf5", ".mat"}; }

bool is_foreign(const std::filesystem::path& path) {
  const std::vector<std::string> known = foreign_extensions();
  return std::ranges::find(known, path.extension().string()) != known.end();
}

std::vector<std::vector<double>> read_foreign_columns(const std::filesystem::path& path, const ImportMap& map) {
  return is_matlab(path) ? read_matlab_columns(path, map) : columns_of(path, groups_of(path), map);
}

Record load_foreign(const std::filesystem::path& path) {
  const std::vector<ForeignGroup> groups = is_matlab(path) ? std::vector<ForeignGroup>{} : groups_of(path);
  const ImportMap map = own_map(path, groups);
  const std::vector<std::vector<double>> values =
      is_matlab(path) ? read_matlab_columns(path, map) : columns_of(path, groups, map);
  const PrivateFolder folder;
  Record record = record_of_columns(path, map, values, folder.path() / "record.csv");
  record.path = path;
  record.name = path.filename().string();
  record.first_line = 0;
  return record;
}

void write_foreign(const Record& record, const std::filesystem::path& path) {
  if (is_matlab(path)) {
    write_matlab(record, path);
  } else if (is_mdf4(path)) {
    write_mdf4(record, path);
  } else {
    write_hdf5(record, path);
  }
}

}  // namespace hotfire
