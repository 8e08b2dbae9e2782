// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string_view>

#include "tools/files/exchange/apart.hpp"
#include "tools/files/import/columns.hpp"
#include "tools/files/import/import.hpp"
#include "tools/files/import/matlab_layout.hpp"
#include "tools/files/import/matlab_reader.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

std::vector<std::vector<double>> columns_of(std::string_view text) {
  std::vector<std::vector<double>> columns;
  while (text.size() >= sizeof(std::uint64_t)) {
    std::uint64_t rows = 0;
    std::memcpy(&rows, text.data(), sizeof rows);
    text.remove_prefix(sizeof rows);
    std::vector<double>& values = columns.emplace_back(std::min<std::size_t>(rows, text.size() / sizeof(double)));
    if (!values.empty()) {
      std::memcpy(values.data(), text.data(), values.size() * sizeof(double));
    }
    text.remove_prefix(values.size() * sizeof(double));
  }
  return columns;
}

// What matio does with a damaged file is its own affair: it has crashed on damaged structs.
std::string read_apart(const std::filesystem::path& path, std::size_t most_bytes, const std::function<std::string()>& read) {
  if (!std::filesystem::is_regular_file(path)) {
    throw FileError(fmt::format("{}: is not a file; allowed: a MATLAB file", path.string()));
  }
  require_matlab_layout(path);
  try {
    return run_apart(read, limits_of_a_reader(most_bytes));
  } catch (const ApartError& error) {
    throw FileError(fmt::format("{}: cannot be read as a MATLAB file: {}; it is damaged: save it again with -v7",
                                path.string(), error.what()));
  }
}

}  // namespace

std::vector<MatlabVariable> read_matlab_variables(const std::filesystem::path& path) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 20U;
  const std::string text = read_apart(path, kMostBytes, [&] { return matlab_variables_text(path); });
  std::vector<MatlabVariable> variables;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    const std::size_t tab = line.find('\t');
    variables.push_back({std::string(line.substr(0, tab)), std::string(line.substr(std::min(tab, line.size() - 1) + 1))});
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
  }
  return variables;
}

std::vector<std::vector<double>> read_matlab_columns(const std::filesystem::path& path, const ImportMap& map) {
  const std::size_t most_bytes = map.columns.size() * sizeof(double) * (kMostRows + 1);
  std::vector<std::vector<double>> values =
      columns_of(read_apart(path, most_bytes, [&] { return matlab_columns_text(path, map); }));
  if (values.size() != map.columns.size()) {
    throw FileError(fmt::format("{}: cannot be read as a MATLAB file: {} columns came of {}", path.string(), values.size(),
                                map.columns.size()));
  }
  require_equal_rows(path, map, values);
  return values;
}

}  // namespace hotfire
