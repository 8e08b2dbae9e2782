#include "tools/files/import.hpp"

#include <fmt/format.h>

#include <charconv>

#include "tools/files/error.hpp"
#include "tools/files/whole_file.hpp"

namespace hotfire {

namespace {

void write_columns(const ImportMap& map, const std::vector<std::vector<double>>& values,
                   const std::filesystem::path& output) {
  WholeFile file(output);
  std::string text = map.period > 0.0 ? "time[s]" : "";
  for (const ImportColumn& column : map.columns) {
    text += fmt::format("{}{}[{}]", text.empty() ? "" : ",", column.channel, column.unit);
  }
  text += '\n';
  for (std::size_t row = 0; row < values.front().size(); ++row) {
    bool first = true;
    const auto append = [&](double value) {
      fmt::format_to(std::back_inserter(text), "{}{}", first ? "" : ",", value);
      first = false;
    };
    if (map.period > 0.0) {
      append(static_cast<double>(row) * map.period);
    }
    for (std::size_t c = 0; c < map.columns.size(); ++c) {
      append(values[c][row] * map.columns[c].factor);
    }
    text += '\n';
    file.write_block(text);
  }
  file.write(text);
  file.commit();
}

}  // namespace

Record import_record(const std::filesystem::path& source, const ImportMap& map, const std::filesystem::path& output) {
  const bool is_matlab = source.extension() == ".mat";
  write_columns(map, is_matlab ? read_matlab_columns(source, map) : read_csv_columns(source, map), output);
  try {
    return load_record(output);
  } catch (const FileError& error) {
    std::filesystem::remove(output);
    throw FileError(fmt::format("{}: does not make a record (line 2 is its first row): {}", source.string(), error.what()));
  }
}

}  // namespace hotfire
