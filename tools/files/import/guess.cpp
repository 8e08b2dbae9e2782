// SPDX-License-Identifier: Apache-2.0
#include "tools/files/import/guess.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "tools/files/import/foreign.hpp"
#include "tools/files/model/toml_text.hpp"
#include "tools/files/text/csv_cells.hpp"
#include "tools/files/text/csv_lines.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/units.hpp"

namespace hotfire {

namespace {

/// Lines that are looked at: a guess need not read a gigabyte.
constexpr std::size_t kGuessedLines = 5000;
/// Rows below a header that have to look like its own.
constexpr std::size_t kRowsBelow = 5;
/// Relative deviation of an interval from the median up to which a column may be a time.
constexpr double kEvenTime = 0.9;

using Row = std::vector<std::string_view>;

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

bool has_word(const std::string& name, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(words, [&](std::string_view word) { return name.find(word) != std::string::npos; });
}

/// A column by what its rows say.
struct Column {
  std::string name;
  std::vector<double> values;   ///< empty: not of numbers
  std::string given_unit = "";  ///< where the file says it beside the name
  bool is_time = false;         ///< where the file says so

  bool is_numeric() const { return !values.empty(); }
  /// "mm" of "stroke [mm]" or "stroke (mm)"; empty if that is no unit.
  std::string unit() const {
    if (!given_unit.empty() && is_known(given_unit)) {
      return given_unit;
    }
    for (const char* brackets : {"[]", "()"}) {
      const std::size_t open = name.find(brackets[0]);
      const std::size_t close = name.find(brackets[1], open == std::string::npos ? 0 : open);
      if (open == std::string::npos || close == std::string::npos) {
        continue;
      }
      std::string unit = name.substr(open + 1, close - open - 1);
      if (is_known(unit)) {
        return unit;
      }
    }
    return "";
  }

 private:
  static bool is_known(const std::string& unit) {
    try {
      require_known_unit(unit);
      return true;
    } catch (const UnitError&) {
      return false;
    }
  }
};

/// A log as one delimiter cuts it.
struct Layout {
  char delimiter = ',';
  std::size_t header = 0;  ///< line
  bool has_events = false;
  std::vector<Column> columns;

  std::size_t numeric() const {
    return static_cast<std::size_t>(std::ranges::count_if(columns, [](const Column& c) { return c.is_numeric(); }));
  }
};

/// The columns below line `at`, if it is a header by this delimiter.
std::optional<Layout> layout_below(const std::vector<std::string>& lines, std::size_t at, char delimiter) {
  const Row names = csv_cells(lines[at], delimiter);
  if (names.size() < 2 || lines.size() <= at + 1 ||
      std::ranges::any_of(names, [](std::string_view name) { return name.empty() || csv_number(name); })) {
    return std::nullopt;
  }
  Layout layout{delimiter, at, false, {}};
  std::vector<Row> rows;
  for (std::size_t i = at + 1; i < lines.size(); ++i) {
    if (csv_trimmed(lines[i]).empty()) {
      continue;
    }
    rows.push_back(csv_cells(lines[i], delimiter));
    if (rows.back().size() + 1 < names.size() || (rows.size() <= kRowsBelow && rows.back().size() > names.size() + 3)) {
      return std::nullopt;
    }
    layout.has_events = layout.has_events || rows.back().size() != names.size();
  }
  for (std::size_t c = 0; c < names.size(); ++c) {
    Column column{std::string(names[c]), {}};
    for (const Row& row : rows) {
      const auto value = c < row.size() ? csv_number(row[c]) : std::nullopt;
      if (!value) {
        column.values.clear();
        break;
      }
      column.values.push_back(*value);
    }
    layout.columns.push_back(std::move(column));
  }
  if (layout.has_events && layout.columns.back().is_numeric()) {
    return std::nullopt;
  }
  return layout.numeric() > 0 ? std::optional(layout) : std::nullopt;
}

bool rises_evenly(const std::vector<double>& values) {
  if (values.size() < 4) {
    return false;
  }
  std::vector<double> intervals;
  for (std::size_t i = 1; i < values.size(); ++i) {
    intervals.push_back(values[i] - values[i - 1]);
  }
  std::vector<double> sorted = intervals;
  std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
  const double median = sorted[sorted.size() / 2];
  return median > 0.0 && std::ranges::all_of(intervals, [&](double interval) {
           return interval > 0.0 && std::abs(interval - median) <= kEvenTime * median;
         });
}

/// What a channel is called in a record, by a column's name; empty if that says nothing.
std::string channel_of(const std::string& column) {
  const std::string name = lower(column);
  if (has_word(name, {"cmd", "command", "setpoint", "reference", "demand"})) {
    return "command";
  }
  if (has_word(name, {"current"})) {
    return "current";
  }
  if (has_word(name, {"pressure"})) {
    return "load_pressure";
  }
  if (has_word(name, {"torque"})) {
    return "torque";
  }
  if (has_word(name, {"force", "load"})) {
    return "force";
  }
  if (has_word(name, {"stroke", "piston", "displacement", "disp", "lvdt", "xp"})) {
    return "piston";
  }
  if (has_word(name, {"angle", "beta", "gimbal", "engine"})) {
    return "engine";
  }
  if (has_word(name, {"velocity", "speed", "tacho", "tachometer"})) {
    return "velocity";
  }
  if (has_word(name, {"acceleration", "accelerometer", "accel", "acc"})) {
    return "acceleration";
  }
  return has_word(name, {"position"}) ? "position" : "";
}

/// `period = "1 ms"` by a line that says an interval or a rate, such as "Sampling Interval:  0.001".
std::string period_by(const std::vector<std::string>& before) {
  for (const std::string& line : before) {
    const std::string text = lower(line);
    const std::size_t colon = text.find_first_of(":=");
    const auto value = colon == std::string::npos ? std::nullopt : csv_number(csv_trimmed(text.substr(colon + 1)));
    if (!value || !(*value > 0.0)) {
      continue;
    }
    const bool is_rate = has_word(text, {"rate", "frequency"});
    if (is_rate || has_word(text, {"interval", "period"})) {
      return fmt::format("period = \"{:.9g} ms\"             # \"{}\"\n", 1e3 * (is_rate ? 1.0 / *value : *value),
                         csv_trimmed(line));
    }
  }
  return "# period = \"1 ms\"             # the file has no period: write it here\n";
}

std::string range_of(const Column& column) {
  const auto [low, high] = std::ranges::minmax(column.values);
  return fmt::format("{:.4g} to {:.4g}", low, high);
}

/// The first lines of a file.
std::vector<std::string> first_lines(const std::filesystem::path& source) {
  CsvLines reader(source);
  std::vector<std::string> lines;
  for (std::string_view line; lines.size() < kGuessedLines && reader.next(line);) {
    lines.emplace_back(line);
  }
  return lines;
}

/// The first header that this delimiter gives.
std::optional<Layout> layout_by(const std::vector<std::string>& lines, char delimiter) {
  constexpr std::size_t kLatestHeader = 100;
  for (std::size_t at = 0; at + 1 < std::min(lines.size(), kLatestHeader); ++at) {
    if (auto layout = layout_below(lines, at, delimiter)) {
      return layout;
    }
  }
  return std::nullopt;
}

/// The layout with the most columns of numbers.
Layout layout_of(const std::vector<std::string>& lines, const std::filesystem::path& source) {
  std::optional<Layout> best;
  for (const char delimiter : {',', ';', '\t'}) {
    auto layout = layout_by(lines, delimiter);
    if (layout && (!best || layout->numeric() > best->numeric())) {
      best = std::move(layout);
    }
  }
  if (!best) {
    throw FileError(fmt::format(
        "{}: no line of names above rows of numbers, cut by \",\", \";\" or a tab; write a map by hand (docs/contract.md)",
        source.string()));
  }
  return std::move(*best);
}

std::string time_section(const Column& column) {
  const std::string unit = column.unit();
  return fmt::format("[time]\ncolumn = {}\nunit = \"{}\"{}\n", toml_string(column.name), unit.empty() ? "s" : unit,
                     unit.empty() ? "                      # a guess" : "");
}

/// A section of a channel; a comment, unless the name says which channel and the unit is known.
std::string channel_section(const Column& column, const std::string& channel) {
  const std::string unit = column.unit();
  const char* mark = channel.empty() || unit.empty() ? "# " : "";
  return fmt::format("{}[channels.{}]\n{}column = {}              # {}\n{}unit = \"{}\"\n", mark,
                     channel.empty() ? "NAME" : channel, mark, toml_string(column.name), range_of(column), mark,
                     unit.empty() ? "?" : unit);
}

/// What the columns are: sections of time and of channels.
struct Sections {
  std::string time;
  std::string channels;
};

Sections sections_of(const std::vector<Column>& columns) {
  Sections sections;
  std::vector<std::string> taken;
  for (const Column& column : columns) {
    if (!column.is_numeric()) {
      continue;
    }
    const std::string name = lower(column.name);
    const bool counts = has_word(name, {"sample", "index", "number", "no.", "row"}) || name == "no" || name == "n";
    if (column.is_time || (rises_evenly(column.values) && (counts || sections.time.empty()))) {
      if (column.is_time || !counts) {
        sections.time = time_section(column);
      }
      continue;
    }
    std::string channel = channel_of(column.name);
    if (std::ranges::find(taken, channel) != taken.end()) {
      channel.clear();
    }
    sections.channels += channel_section(column, channel);
    if (!channel.empty()) {
      taken.push_back(channel);
    }
  }
  return sections;
}

/// How the file is cut, where that is not as by default.
std::string csv_section(const Layout& layout) {
  if (layout.delimiter == ',' && layout.header == 0 && !layout.has_events) {
    return "";
  }
  std::string text = "[csv]\n";
  if (layout.delimiter != ',') {
    text += fmt::format("delimiter = \"{}\"\n", layout.delimiter == '\t' ? "\\t" : std::string(1, layout.delimiter));
  }
  if (layout.header > 0) {
    text += fmt::format("skip_lines = {}\n", layout.header);
  }
  if (layout.has_events) {
    text += fmt::format("events = {}\n", toml_string(layout.columns.back().name));
  }
  return text;
}

std::string head_of(const std::filesystem::path& source) {
  return fmt::format("# A proposal for {}: check every unit, sign and scale, and the zero of every channel.\nschema = 1\n",
                     source.filename().string());
}

constexpr const char* kChannelsComment =
    "# A channel is one of command, current, piston, engine, load_pressure, torque, force, position.\n";

/// Of a file with channels of its own: the group with the most channels, and a comment on each other one, since channels of
/// several groups were sampled apart.
std::string map_of_groups(const std::filesystem::path& source) {
  const std::vector<ForeignGroup> groups = foreign_groups(source);
  const auto has_numbers = [](const ForeignChannel& channel) { return !channel.values.empty(); };
  const auto numbers = [&](const ForeignGroup& group) { return std::ranges::count_if(group.channels, has_numbers); };
  const auto most = std::ranges::max_element(groups, {}, numbers);
  if (most == groups.end() || numbers(*most) == 0) {
    throw FileError(fmt::format("{}: no channel with numbers", source.string()));
  }
  std::string others;
  std::vector<Column> columns;
  for (const ForeignGroup& group : groups) {
    for (const ForeignChannel& channel : group.channels) {
      const std::string name = group.name.empty() ? channel.name : group.name + "/" + channel.name;
      if (&group == &*most && channel.problem.empty()) {
        columns.push_back({name, channel.values, channel.unit, channel.is_time});
      } else {
        others += fmt::format("# not proposed: {} [{}]{}\n", toml_string(name), toml_string(channel.unit),
                              channel.problem.empty() ? ", of another group" : ": " + channel.problem);
      }
    }
  }
  // A time that the file declares is the time, wherever it is.
  std::ranges::stable_sort(columns, std::greater<>(), &Column::is_time);
  const Sections sections = sections_of(columns);
  return head_of(source) + (sections.time.empty() ? period_by({}) : sections.time) + kChannelsComment + sections.channels +
         others;
}

}  // namespace

std::string guessed_map(const std::filesystem::path& source) {
  if (is_foreign(source)) {
    return map_of_groups(source);
  }
  const std::vector<std::string> lines = first_lines(source);
  const Layout layout = layout_of(lines, source);
  const Sections sections = sections_of(layout.columns);
  std::string text = head_of(source);
  if (sections.time.empty()) {
    text += period_by({lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(layout.header)});
  }
  text += sections.time + csv_section(layout);
  return text + kChannelsComment + sections.channels;
}

}  // namespace hotfire
