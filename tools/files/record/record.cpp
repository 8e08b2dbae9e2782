// SPDX-License-Identifier: Apache-2.0
#include "tools/files/record/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "tools/files/record/record_channels.hpp"
#include "tools/files/record/recording.hpp"
#include "tools/files/record/time_grid.hpp"
#include "tools/files/text/csv_lines.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/units.hpp"

namespace hotfire {

namespace {

/// The columns of a record while it is read.
struct Rows {
  std::vector<Column> columns;
  std::vector<std::vector<double>> values = {};
  std::size_t time_column = 0;
  std::size_t first_line = 0;  ///< line of the first row
  PrintedDigits time_digits = {};
};

/// A cell of the row being read that holds no number.
struct BadCell {
  std::size_t column;
  std::string_view text;
};

bool is_blank(char letter) { return letter == ' ' || letter == '\t'; }

[[noreturn]] void refuse_cell(const CsvLines& lines, const Column& column, std::string_view cell) {
  constexpr std::size_t kMost = 40;
  const std::string_view shown = cell.substr(0, std::min(cell.find(','), kMost));
  lines.refuse(
      fmt::format("column {}: \"{}\" is not a finite number; allowed: decimal numbers like -1.5e-3 (explain and import take "
                  "what --exclude names without them)",
                  column.name, shown));
}

/// Reads the cell at `cursor` and moves to its end. `cell` becomes its text. NaN if that is no finite number.
double read_cell(const Column& column, const char*& cursor, const char* end, std::string_view& cell) {
  while (cursor != end && is_blank(*cursor)) {
    ++cursor;
  }
  const char* start = cursor;
  const bool plus = end - start > 1 && start[0] == '+' && start[1] != '-';
  const char* digits = plus ? start + 1 : start;
  double value = 0.0;
  const auto [stop, error] = std::from_chars(digits, end, value);
  cursor = stop;
  while (cursor != end && is_blank(*cursor)) {
    ++cursor;
  }
  if (error != std::errc{} || !std::isfinite(value) || (cursor != end && *cursor != ',')) {
    cell = std::string_view(start, static_cast<std::size_t>(end - start));
    cursor = std::find(start, end, ',');
    return std::numeric_limits<double>::quiet_NaN();
  }
  cell = std::string_view(start, static_cast<std::size_t>(stop - start));
  return column.convert(value);
}

[[noreturn]] void refuse_ragged(const CsvLines& lines, std::string_view line, std::size_t columns) {
  lines.refuse(fmt::format("ragged row: {} cells; allowed: {}, as many as the header names",
                           1 + std::count(line.begin(), line.end(), ','), columns));
}

bool is_in_any(const std::vector<DropOut>& drop_outs, double time) {
  return std::any_of(drop_outs.begin(), drop_outs.end(), [time](const DropOut& out) { return out.holds(time); });
}

void read_row(const CsvLines& lines, std::string_view line, const std::vector<DropOut>& drop_outs, Rows& rows) {
  const char* cursor = line.data();
  const char* end = line.data() + line.size();
  std::string_view cell;
  std::optional<BadCell> bad;
  for (std::size_t i = 0; i < rows.columns.size(); ++i) {
    if (i > 0) {
      if (cursor == end) {
        refuse_ragged(lines, line, rows.columns.size());
      }
      ++cursor;
    }
    rows.values[i].push_back(read_cell(rows.columns[i], cursor, end, cell));
    if (std::isnan(rows.values[i].back()) && (!bad || i == rows.time_column)) {
      bad = BadCell{i, cell};
    }
    if (i == rows.time_column) {
      rows.time_digits.see(cell);
    }
  }
  if (bad && !is_in_any(drop_outs, rows.values[rows.time_column].back())) {
    refuse_cell(lines, rows.columns[bad->column], bad->text);
  }
  if (cursor != end) {
    refuse_ragged(lines, line, rows.columns.size());
  }
}

bool is_blank_line(std::string_view line) { return std::all_of(line.begin(), line.end(), is_blank); }

std::string_view header_line(CsvLines& lines) {
  std::string_view line;
  while (lines.next(line)) {
    if (!line.starts_with('#') && !is_blank_line(line)) {
      return line;
    }
  }
  lines.refuse("no header; a record begins with a line like time[s],command[rad],piston[m]");
}

/// Blank lines are allowed at the end of the file alone.
void require_end(CsvLines& lines) {
  const std::size_t blank = lines.number();
  std::string_view line;
  while (lines.next(line)) {
    if (!is_blank_line(line)) {
      lines.refuse(fmt::format("a row after blank line {}; allowed: rows without blank lines between them", blank));
    }
  }
}

Rows read_rows(CsvLines& lines, const std::vector<DropOut>& drop_outs) {
  Rows rows{read_header(lines, header_line(lines))};
  rows.first_line = lines.number() + 1;
  rows.values.resize(rows.columns.size());
  const auto time = std::find_if(rows.columns.begin(), rows.columns.end(), [](const Column& c) { return c.name == "time"; });
  rows.time_column = static_cast<std::size_t>(time - rows.columns.begin());
  std::string_view line;
  while (lines.next(line)) {
    if (is_blank_line(line)) {
      require_end(lines);
      break;
    }
    if (rows.values.front().size() == kMostRows) {
      lines.refuse(fmt::format("more than {} rows; cut the record into parts", kMostRows));
    }
    read_row(lines, line, drop_outs, rows);
  }
  if (rows.values.front().size() < 2) {
    lines.refuse(fmt::format("{} rows; allowed: at least 2", rows.values.front().size()));
  }
  return rows;
}

}  // namespace

const Channel* Record::find(const std::string& channel) const {
  const auto found =
      std::find_if(channels.begin(), channels.end(), [&channel](const Channel& c) { return c.name == channel; });
  return found == channels.end() ? nullptr : &*found;
}

std::string Record::place_of(std::size_t row) const {
  return first_line != 0 ? fmt::format("{}:{}", path.string(), first_line + row)
                         : fmt::format("{}: row {}", path.string(), row + 1);
}

Record load_record(const std::filesystem::path& path, const std::vector<DropOut>& drop_outs) {
  if (is_recording(path)) {
    return load_recording(path);
  }
  CsvLines lines(path);
  Rows rows = read_rows(lines, drop_outs);
  RowLines row_lines(rows.first_line);
  put_lost_rows(drop_outs, rows.time_column, rows.values, row_lines);
  const std::vector<double>& times = rows.values[rows.time_column];
  const TimeGrid grid = uniform_grid(times, rows.time_digits, rows.columns[rows.time_column].convert(1.0), path, row_lines);

  Record record{
      path, path.filename().string(), grid.start, grid.period, times.size(), {}, drop_outs.empty() ? rows.first_line : 0};
  for (std::size_t i = 0; i < rows.columns.size(); ++i) {
    if (i != rows.time_column) {
      record.channels.push_back({rows.columns[i].name, rows.columns[i].unit, std::move(rows.values[i])});
    }
  }
  return record;
}

void require_units_of_one_motion(const Record& record) {
  const Channel* reference = nullptr;
  std::string expected;  // of the next channel, the rate of the one before
  for (const char* name : {"position", "velocity", "acceleration"}) {
    const Channel* channel = record.find(name);
    // Without a unit it may be any.
    if (channel != nullptr && reference != nullptr && channel->unit != "1" && reference->unit != "1") {
      try {
        if (std::abs(convert_unit(1.0, channel->unit, expected) - 1.0) > 1e-9) {
          throw UnitError(fmt::format("unit \"{}\" is not {}", channel->unit, expected));
        }
      } catch (const UnitError& error) {
        throw FileError(fmt::format("{}:1: {}: {}: a mass has one unit of length in all its channels, here that of {} [{}]",
                                    record.path.string(), name, error.what(), reference->name, reference->unit));
      }
    }
    if (channel != nullptr) {
      reference = channel;
      expected = channel->unit;
    }
    expected += reference != nullptr ? "/s" : "";
  }
}

void require_same_unit(const Record& record, const std::string& channel, const std::string& other) {
  const Channel* one = record.find(channel);
  const Channel* two = record.find(other);
  if (one != nullptr && two != nullptr && one->unit != two->unit && one->unit != "1" && two->unit != "1") {
    throw FileError(
        fmt::format("{}:1: {} has the unit {} and {} the unit {}: the model compares their numbers; convert one, "
                    "for example with hotfire import",
                    record.path.string(), channel, one->unit, other, two->unit));
  }
}

void require_channel(const Record& record, const std::string& channel, const std::string& reason) {
  if (record.find(channel) != nullptr) {
    return;
  }
  std::string has;
  for (const Channel& own : record.channels) {
    has += fmt::format("{}{}[{}]", has.empty() ? "" : ", ", own.name, own.unit);
  }
  const bool has_current = channel == "command" && record.find("current") != nullptr;
  throw FileError(fmt::format("{}:1: no column {}: {}; the record has {}{}", record.path.string(), channel, reason, has,
                              has_current ? "; --command-per-current gives the command that a current represents" : ""));
}

}  // namespace hotfire
