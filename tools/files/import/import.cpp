// SPDX-License-Identifier: Apache-2.0
#include "tools/files/import/import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "tools/files/import/foreign.hpp"
#include "tools/files/import/resample.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/units.hpp"
#include "tools/files/text/whole_file.hpp"

namespace hotfire {

namespace {

/// Values in their units: times factor, plus offset.
void scale(const std::vector<ImportColumn>& columns, std::vector<std::vector<double>>& values) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].factor != 1.0 || columns[c].offset != 0.0) {
      std::ranges::for_each(values[c], [&](double& value) { value = value * columns[c].factor + columns[c].offset; });
    }
  }
}

/// Puts the columns on the even grid that the map asks for. What is left has no time column.
std::string put_on_grid(const std::filesystem::path& source, ImportMap& map, std::vector<std::vector<double>>& values,
                        double& start) {
  std::vector<double> times;
  if (map.period > 0.0) {
    for (std::size_t row = 0; row < values.front().size(); ++row) {
      times.push_back(static_cast<double>(row) * map.period);
    }
  } else {
    const UnitConverter seconds(map.columns.front().unit, "s");
    times = std::move(values.front());
    std::ranges::for_each(times, [&](double& time) { time = seconds(time); });
    values.erase(values.begin());
    map.columns.erase(map.columns.begin());
  }
  std::vector<bool> held;
  for (const ImportColumn& column : map.columns) {
    held.push_back(is_held_input(column.channel));
  }
  try {
    Resampled even = resampled(times, values, held, map.resampling_period);
    values = std::move(even.values);
    map.period = even.period;
    start = even.start;
    return even.note;
  } catch (const std::invalid_argument& error) {
    throw FileError(fmt::format("{}: {}", source.string(), error.what()));
  }
}

void write_columns(const std::vector<ImportColumn>& columns, const std::vector<std::vector<double>>& values, double start,
                   double period, const std::filesystem::path& output) {
  WholeFile file(output);
  std::string text = period > 0.0 ? "time[s]" : "";
  for (const ImportColumn& column : columns) {
    text += fmt::format("{}{}[{}]", text.empty() ? "" : ",", column.channel, column.unit);
  }
  text += '\n';
  for (std::size_t row = 0; row < values.front().size(); ++row) {
    bool first = true;
    const auto append = [&](double value) {
      fmt::format_to(std::back_inserter(text), "{}{}", first ? "" : ",", value);
      first = false;
    };
    if (period > 0.0) {
      append(start + static_cast<double>(row) * period);
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
      append(values[c][row]);
    }
    text += '\n';
    file.write_block(text);
  }
  file.write(text);
  file.commit();
}

std::vector<std::vector<double>> read_table(const std::filesystem::path& source, const ImportMap& map) {
  return is_foreign(source) ? read_foreign_columns(source, map) : read_csv_columns(source, map);
}

/// What was written, read as any record is; no file is left behind if that refuses it.
Record checked_record(const std::filesystem::path& source, const std::filesystem::path& output,
                      const std::vector<DropOut>& drop_outs) {
  try {
    return load_record(output, drop_outs);
  } catch (const FileError& error) {
    std::filesystem::remove(output);
    throw FileError(fmt::format("{}: does not make a record (line 2 is its first row): {}", source.string(), error.what()));
  }
}

}  // namespace

ImportSource import_source(const std::filesystem::path& source, const std::filesystem::path& dbc) {
  if (!dbc.empty()) {
    return ImportSource::candump_log;
  }
  constexpr std::size_t kFrame = 100;  // characters that hold stamp, interface and id
  std::string start(kFrame, '\0');
  std::ifstream(source, std::ios::binary).read(start.data(), kFrame);
  if (start.starts_with('(') && start.find_first_of("0123456789") == 1 && start.find(") ") < start.find('#') &&
      start.find('#') < start.find('\n')) {
    throw UsageError(
        fmt::format("{}: is a candump log; describe its frames by --dbc rig.dbc (a log of Hotfire's own CAN map needs no "
                    "map: hotfire convert {} record.csv)",
                    source.string(), source.string()));
  }
  return ImportSource::table;
}

Record import_record(const std::filesystem::path& source, const ImportMap& map, const std::filesystem::path& output,
                     const std::filesystem::path& dbc, const std::vector<DropOut>& drop_outs,
                     std::vector<std::string>* notes) {
  if (import_source(source, dbc) == ImportSource::candump_log) {
    if (!drop_outs.empty()) {
      throw UsageError(
          "--exclude: a log is read frame by frame and has no empty cells; leave it out, and cut the log where frames are "
          "lost");
    }
    ImportedColumns log = read_candump_columns(source, load_dbc(dbc), map);
    scale(log.columns, log.values);
    write_columns(log.columns, log.values, 0.0, 0.0, output);
  } else {
    ImportMap grid = map;
    std::vector<std::vector<double>> values = read_table(source, map);
    scale(map.columns, values);
    double start = 0.0;
    if (map.resampling_period > 0.0) {
      if (!drop_outs.empty()) {
        throw UsageError("--exclude: a column with missing values is not resampled; leave out --exclude or [resample]");
      }
      const std::string note = put_on_grid(source, grid, values, start);
      if (notes != nullptr) {
        notes->push_back(note);
      }
    }
    write_columns(grid.columns, values, start, grid.period, output);
  }
  return checked_record(source, output, drop_outs);
}

Record record_of_columns(const std::filesystem::path& source, const ImportMap& map,
                         const std::vector<std::vector<double>>& values, const std::filesystem::path& output) {
  write_columns(map.columns, values, 0.0, map.period, output);
  return checked_record(source, output, {});
}

}  // namespace hotfire
