// SPDX-License-Identifier: Apache-2.0
#include "tools/files/record/record_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tools/files/record/axis_names.hpp"
#include "tools/files/text/csv_cells.hpp"
#include "tools/files/text/suggestion.hpp"

namespace hotfire {

namespace {

struct KnownChannel {
  std::string_view name;
  std::string_view unit;  ///< empty: the channel keeps the unit it has
};

constexpr std::array<KnownChannel, 26> kKnownChannels{{{"time", "s"},
                                                       {"command", "rad"},
                                                       {"current", "A"},
                                                       {"piston", "m"},
                                                       {"engine", "rad"},
                                                       {"load_pressure", "Pa"},
                                                       {"force", ""},
                                                       {"position", ""},
                                                       {"velocity", ""},
                                                       {"acceleration", ""},
                                                       {"position2", ""},
                                                       {"velocity2", ""},
                                                       {"acceleration2", ""},
                                                       {"position3", ""},
                                                       {"velocity3", ""},
                                                       {"acceleration3", ""},
                                                       {"string1", "m"},
                                                       {"string2", "m"},
                                                       {"string3", "m"},
                                                       {"string4", "m"},
                                                       {"vibration", "m/s^2"},
                                                       {"torque", "N.m"},
                                                       {"thrust", "N"},
                                                       {"setpoint", ""},
                                                       {"motor_position", "rad"},
                                                       {"motor_velocity", "rad/s"}}};

std::vector<std::string_view> known_names() {
  std::vector<std::string_view> names;
  names.reserve(kKnownChannels.size());
  for (const KnownChannel& channel : kKnownChannels) {
    names.push_back(channel.name);
  }
  return names;
}

/// A header of a file that is not CSV can be long and strange: a message shows
/// its beginning.
std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 60;
  return text.size() <= kMost ? std::string{text} : std::string{text.substr(0, kMost)} + "...";
}

/// The number of an engine, where there are several.
bool is_engine(std::string_view text) { return text.size() == 1 && text[0] >= '1' && text[0] <= '9'; }

/// What follows the point in `piston.pitch`, `piston.yaw3`: an axis, of an
/// engine where there are several.
bool is_axis(std::string_view text) {
  for (const std::string_view axis : {"pitch", "yaw"}) {
    if (text.starts_with(axis)) {
      return text.size() == axis.size() || is_engine(text.substr(axis.size()));
    }
  }
  return false;
}

/// What follows the point in `force.x`, `force.z3`: a direction, of an engine where there are several.
bool is_direction(std::string_view text) {
  return !text.empty() && text[0] >= 'x' && text[0] <= 'z' && (text.size() == 1 || is_engine(text.substr(1)));
}

/// Refuses what follows the point in a channel's name if it is neither an axis nor, of a string or a thrust, an engine, nor,
/// of a force, a direction.
void require_place(const CsvLines& lines, std::size_t column, std::string_view name, std::size_t point) {
  constexpr std::string_view kEngine = "engine";
  const std::string_view own = name.substr(0, point);
  const std::string_view place = name.substr(point + 1);
  if (own == "force") {
    if (!is_direction(place)) {
      lines.refuse(fmt::format(
          "column {} \"{}\": no direction; allowed after {}: .x, .y, .z, or .x1, .y1, .z1, .x2 ... of several engines",
          column, shown(name), own));
    }
  } else if (own.starts_with("string") || own == "thrust") {
    if (!place.starts_with(kEngine) || !is_engine(place.substr(kEngine.size()))) {
      lines.refuse(
          fmt::format("column {} \"{}\": no engine; allowed after {}: "
                      ".engine1, .engine2 ... of several engines",
                      column, shown(name), own));
    }
  } else if (own == "time" || !is_axis(place)) {
    lines.refuse(
        fmt::format("column {} \"{}\": no axis; allowed after {}: .pitch, "
                    ".yaw, or .pitch1, .yaw1, .pitch2 ... of several "
                    "engines",
                    column, shown(name), own));
  }
}

KnownChannel known_channel(const CsvLines& lines, std::size_t column, std::string_view name) {
  const std::size_t point = name.find('.');
  const std::string_view own = own_name(name);
  const auto* found =
      std::find_if(kKnownChannels.begin(), kKnownChannels.end(), [own](const auto& c) { return c.name == own; });
  if (found != kKnownChannels.end() && point != std::string_view::npos) {
    require_place(lines, column, name, point);
  }
  // Of an axis it is the slip of a bearing.
  if (found != kKnownChannels.end() && own == "vibration" && point != std::string_view::npos) {
    return {"vibration", "rad/s"};
  }
  // Of a vehicle it is in SI.
  if (found != kKnownChannels.end() && own == "force" && point != std::string_view::npos) {
    return {"force", "N"};
  }
  if (found != kKnownChannels.end()) {
    return *found;
  }
  const std::vector<std::string_view> names = known_names();
  lines.refuse(fmt::format(
      "column {} \"{}\": unknown channel; {}. 'hotfire import FILE --guess' begins a map of a file with other names", column,
      shown(name), suggestion(shown(name), names)));
}

Column read_column(const CsvLines& lines, std::size_t number, std::string_view cell) {
  const std::size_t open = cell.find('[');
  const std::string_view name = trimmed(cell.substr(0, open));
  const KnownChannel known = known_channel(lines, number, name);
  if (open == std::string_view::npos || !cell.ends_with(']')) {
    lines.refuse(fmt::format("column {} \"{}\": its unit is missing; write {}[{}]", number, shown(cell), name,
                             known.unit.empty() ? "unit" : known.unit));
  }
  const std::string unit{trimmed(cell.substr(open + 1, cell.size() - open - 2))};
  const std::string wanted = known.unit.empty() ? unit : std::string{known.unit};
  try {
    require_known_unit(unit);
    return Column{std::string{name}, wanted, UnitConverter(unit, wanted)};
  } catch (const UnitError& error) {
    lines.refuse(fmt::format("column {} \"{}\": {}; allowed: {}", number, shown(cell), error.what(),
                             known.unit.empty() ? "any unit of UDUNITS-2" : "units that convert to " + wanted));
  }
}

}  // namespace

bool is_record_channel(std::string_view name) {
  return std::any_of(kKnownChannels.begin(), kKnownChannels.end(),
                     [name](const KnownChannel& known) { return known.name == name; });
}

std::vector<Column> read_header(const CsvLines& lines, std::string_view header) {
  std::vector<Column> columns;
  const auto has = [&columns](std::string_view name) {
    return std::any_of(columns.begin(), columns.end(), [name](const Column& column) { return column.name == name; });
  };
  for (const std::string_view cell : parts_of(header, ',')) {
    Column column = read_column(lines, columns.size() + 1, cell);
    if (has(column.name)) {
      lines.refuse(
          fmt::format("column {} \"{}\": named twice; allowed: each channel once", columns.size() + 1, column.name));
    }
    columns.push_back(std::move(column));
  }
  if (!has("time")) {
    lines.refuse(
        "no time column; a record begins with a line like "
        "time[s],command[rad],piston[m]");
  }
  if (columns.size() < 2) {
    lines.refuse("no channel except time; allowed: " + fmt::format("{}", suggestion("", known_names())));
  }
  return columns;
}

}  // namespace hotfire
