// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include "tools/files/exchange/matlab_handles.hpp"
#include "tools/files/exchange/matlab_writer.hpp"
#include "tools/files/text/whole_file.hpp"

namespace hotfire {

namespace {

matvar_t* text_variable(std::string text) {
  std::array<std::size_t, 2> size{1, text.size()};
  return Mat_VarCreate(nullptr, MAT_C_CHAR, MAT_T_UTF8, 2, size.data(), text.data(), 0);
}

bool put_column(mat_t* file, const std::string& name, std::vector<double> values) {
  std::array<std::size_t, 2> size{values.size(), 1};
  const MatVariable variable(
      Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), values.data(), MAT_F_DONT_COPY_DATA));
  return variable && Mat_VarWrite(file, variable.get(), MAT_COMPRESSION_ZLIB) == 0;
}

/// `units.piston_pitch` is "m".
bool put_units(mat_t* file, const Record& record) {
  std::vector<std::string> names{"time"};
  for (const Channel& channel : record.channels) {
    names.push_back(matlab_name(channel.name));
  }
  std::vector<const char*> fields;
  std::transform(names.begin(), names.end(), std::back_inserter(fields),
                 [](const std::string& name) { return name.c_str(); });
  std::array<std::size_t, 2> one{1, 1};
  const MatVariable units(Mat_VarCreateStruct("units", 2, one.data(), fields.data(), static_cast<unsigned>(fields.size())));
  if (!units) {
    return false;
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    Mat_VarSetStructFieldByName(units.get(), fields[i], 0, text_variable(i == 0 ? "s" : record.channels[i - 1].unit));
  }
  return Mat_VarWrite(file, units.get(), MAT_COMPRESSION_NONE) == 0;
}

}  // namespace

std::string matlab_name(std::string channel) {
  std::ranges::replace(channel, '.', '_');
  return channel;
}

void write_matlab(const Record& record, const std::filesystem::path& path) {
  write_whole_file_by(path, [&](const std::filesystem::path& temporary) {
    const MatFile file(Mat_CreateVer(temporary.c_str(), nullptr, MAT_FT_MAT5));
    bool good = file && put_column(file.get(), "time", times_of(record));
    for (const Channel& channel : record.channels) {
      good = good && put_column(file.get(), matlab_name(channel.name), channel.values);
    }
    return good && put_units(file.get(), record);
  });
}

}  // namespace hotfire
