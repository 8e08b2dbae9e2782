#include "tools/files/import/import.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "tools/files/text/error.hpp"
#include "tools/files/text/whole_file.hpp"

namespace hotfire {

namespace {

void write_columns(const std::vector<ImportColumn>& columns, const std::vector<std::vector<double>>& values, double period,
                   const std::filesystem::path& output) {
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
      append(static_cast<double>(row) * period);
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
      append(values[c][row] * columns[c].factor);
    }
    text += '\n';
    file.write_block(text);
  }
  file.write(text);
  file.commit();
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
    throw UsageError(fmt::format(
        "{}: is a candump log; say what its frames carry, --dbc rig.dbc (a log of Hotfire's own CAN map needs no "
        "map: hotfire convert {} record.csv)",
        source.string(), source.string()));
  }
  return ImportSource::table;
}

Record import_record(const std::filesystem::path& source, const ImportMap& map, const std::filesystem::path& output,
                     const std::filesystem::path& dbc, const std::vector<DropOut>& drop_outs) {
  if (import_source(source, dbc) == ImportSource::candump_log) {
    if (!drop_outs.empty()) {
      throw UsageError(
          "--exclude: a log is read frame by frame and has no cells to lack; leave it out, and cut the log where frames are "
          "lost");
    }
    const ImportedColumns log = read_candump_columns(source, load_dbc(dbc), map);
    write_columns(log.columns, log.values, 0.0, output);
  } else {
    const bool is_matlab = source.extension() == ".mat";
    write_columns(map.columns, is_matlab ? read_matlab_columns(source, map) : read_csv_columns(source, map), map.period,
                  output);
  }
  try {
    return load_record(output, drop_outs);
  } catch (const FileError& error) {
    std::filesystem::remove(output);
    throw FileError(fmt::format("{}: does not make a record (line 2 is its first row): {}", source.string(), error.what()));
  }
}

}  // namespace hotfire
