// SPDX-License-Identifier: Apache-2.0
#include "tools/files/import/foreign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
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

/// The extension in small letters: a logger may write "0001.MF4".
std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool is_matlab(const std::filesystem::path& path) { return extension_of(path) == ".mat"; }
bool is_mdf4(const std::filesystem::path& path) { return extension_of(path) == ".mf4" || extension_of(path) == ".mdf"; }

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

/// How a map names a channel: "GROUP/CHANNEL", where the group has a name.
std::string full_name(const ForeignGroup& group, const ForeignChannel& channel) {
  return group.name.empty() ? channel.name : group.name + "/" + channel.name;
}

/// The one group that has a time; of a file without, the one that has channels. Null if there is none.
const ForeignGroup* group_of_record(const std::filesystem::path& path, const std::vector<ForeignGroup>& groups) {
  const ForeignGroup* used = nullptr;
  for (const bool has_time : {true, false}) {
    for (const ForeignGroup& group : groups) {
      const bool is_usable =
          has_time ? std::ranges::any_of(group.channels, &ForeignChannel::is_time) : !group.channels.empty();
      if (is_usable && used != nullptr) {
        throw FileError(
            fmt::format("{}: several groups of channels, \"{}\" and \"{}\"; a record has one: choose with a map, "
                        "'hotfire import {} --guess' begins one",
                        path.string(), used->name, group.name, path.string()));
      }
      used = is_usable ? &group : used;
    }
    if (used != nullptr) {
      break;
    }
  }
  return used;
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
  if (const ForeignGroup* used = group_of_record(path, groups)) {
    for (const ForeignChannel& channel : used->channels) {
      map.columns.push_back({channel.is_time ? kTime : channel.name, full_name(*used, channel), known_unit(channel.unit)});
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
      const std::string full = full_name(group, channel);
      names.push_back(column.column.find('/') == std::string::npos ? channel.name : full);
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
    if (!found.channel->problem.empty()) {
      throw FileError(fmt::format("{}: channel \"{}\" for {}: {}", path.string(), column.column, column.channel,
                                  found.channel->problem));
    }
    values.push_back(found.channel->values);
  }
  require_equal_rows(path, map, values);
  return values;
}

}  // namespace

std::vector<std::string> foreign_extensions() { return {".mf4", ".mdf", ".h5", ".hdf5", ".mat"}; }

bool is_foreign(const std::filesystem::path& path) {
  const std::vector<std::string> known = foreign_extensions();
  return std::ranges::find(known, extension_of(path)) != known.end();
}

std::vector<std::vector<double>> read_foreign_columns(const std::filesystem::path& path, const ImportMap& map) {
  return is_matlab(path) ? read_matlab_columns(path, map) : columns_of(path, groups_of(path), map);
}

std::vector<ForeignGroup> foreign_groups(const std::filesystem::path& path) {
  if (!is_matlab(path)) {
    return groups_of(path);
  }
  ForeignGroup group;
  for (const MatlabVariable& variable : read_matlab_variables(path)) {
    ImportMap map;
    map.columns.push_back({variable.name, variable.name, known_unit(variable.unit)});
    group.channels.push_back(
        {variable.name, variable.unit, variable.name == kTime, read_matlab_columns(path, map).front(), {}});
  }
  return {std::move(group)};
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
