// SPDX-License-Identifier: Apache-2.0
#include "tools/files/import/matlab_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <span>
#include <type_traits>

#include "tools/files/exchange/exact_integer.hpp"
#include "tools/files/exchange/matlab_handles.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

/// "data.beta:3": variable "data", field "beta", third column; 0 is a vector.
struct Place {
  std::string variable;
  std::vector<std::string> fields;
  std::size_t column = 0;
};

std::string names_in(mat_t* file) {
  std::size_t count = 0;
  char* const* names = Mat_GetDir(file, &count);
  std::string text;
  for (std::size_t i = 0; names != nullptr && i < count; ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ", ", names[i]);
  }
  return text.empty() ? "none" : text;
}

class MatlabReader {
 public:
  explicit MatlabReader(const std::filesystem::path& path) : path_(path), file_(Mat_Open(path.c_str(), MAT_ACC_RDONLY)) {
    if (!file_) {
      throw FileError(fmt::format("{}: is not a readable MATLAB file; save it with -v7", path.string()));
    }
  }

  std::vector<double> read(const ImportColumn& column) const {
    const Place place = place_of(column);
    const MatVariable variable(Mat_VarRead(file_.get(), place.variable.c_str()));
    matvar_t* inner = variable.get();
    if (inner == nullptr) {
      refuse(column, fmt::format("no variable \"{}\"; there are: {}", place.variable, names_in(file_.get())));
    }
    for (const std::string& field : place.fields) {
      inner = inner->class_type == MAT_C_STRUCT ? Mat_VarGetStructFieldByName(inner, field.c_str(), 0) : nullptr;
      if (inner == nullptr) {
        refuse(column, fmt::format("no field \"{}\"", field));
      }
    }
    return values_of(*inner, place, column);
  }

  /// Every variable of numbers with its field of the struct `units`.
  std::vector<MatlabVariable> variables() const {
    std::vector<MatlabVariable> found;
    std::size_t count = 0;
    char* const* names = Mat_GetDir(file_.get(), &count);
    const MatVariable units(Mat_VarRead(file_.get(), kUnits));
    for (std::size_t i = 0; names != nullptr && i < count; ++i) {
      const std::string name = names[i];
      if (name == kUnits) {
        continue;
      }
      const MatVariable variable(Mat_VarReadInfo(file_.get(), name.c_str()));
      if (variable && variable->class_type >= MAT_C_DOUBLE && variable->class_type <= MAT_C_UINT64) {
        found.push_back({name, unit_of(units.get(), name)});
      }
    }
    return found;
  }

 private:
  static constexpr const char* kUnits = "units";

  static std::string unit_of(matvar_t* units, const std::string& name) {
    const matvar_t* field = units != nullptr && units->class_type == MAT_C_STRUCT
                                ? Mat_VarGetStructFieldByName(units, name.c_str(), 0)
                                : nullptr;
    if (field == nullptr || field->class_type != MAT_C_CHAR || field->data == nullptr || field->rank != 2) {
      return {};
    }
    // Characters of one byte or of two, of which units use those of one alone.
    std::string unit;
    const auto* bytes = static_cast<const char*>(field->data);
    const auto step = static_cast<std::size_t>(std::max(field->data_size, 1));
    for (std::size_t i = 0; i + step <= field->nbytes; i += step) {
      unit += bytes[i];
    }
    return unit;
  }

  [[noreturn]] void refuse(const ImportColumn& column, const std::string& problem) const {
    throw FileError(fmt::format("{}: {} for {}: {}", path_.string(), column.column, column.channel, problem));
  }

  Place place_of(const ImportColumn& column) const {
    Place place;
    std::string_view text = column.column;
    if (const std::size_t colon = text.find(':'); colon != std::string_view::npos) {
      const std::string_view digits = text.substr(colon + 1);
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), place.column);
      if (error != std::errc{} || end != digits.data() + digits.size() || place.column == 0) {
        refuse(column, "the number after the colon is the column of a matrix, from 1 on");
      }
      text = text.substr(0, colon);
    }
    for (bool first = true; !text.empty(); first = false) {
      const std::size_t dot = text.find('.');
      (first ? place.variable : place.fields.emplace_back()) = std::string(text.substr(0, dot));
      text.remove_prefix(dot == std::string_view::npos ? text.size() : dot + 1);
    }
    return place;
  }

  std::vector<double> values_of(const matvar_t& variable, const Place& place, const ImportColumn& column) const {
    if (variable.rank != 2 || variable.isComplex != 0 || variable.data == nullptr) {
      refuse(column, "is not a real vector or matrix");
    }
    const std::size_t rows = variable.dims[0];
    const std::size_t columns = variable.dims[1];
    const bool is_vector = rows == 1 || columns == 1;
    if (place.column == 0 && !is_vector) {
      refuse(column,
             fmt::format("is a matrix of {} x {}; write \"{}:1\" for its first column", rows, columns, column.column));
    }
    if (rows > kMostRows || columns > kMostRows) {
      refuse(column, fmt::format("{} x {}; allowed: up to {} rows", rows, columns, kMostRows));
    }
    if (place.column > columns) {
      refuse(column, fmt::format("has {} columns", columns));
    }
    const std::size_t first = place.column == 0 ? 0 : (place.column - 1) * rows;
    const std::size_t count = place.column == 0 ? rows * columns : rows;
    if (count > kMostRows) {
      refuse(column, fmt::format("{} values; allowed: up to {}", count, kMostRows));
    }
    const auto copy = [&]<class T>(const T* data) {
      if (variable.nbytes / sizeof(T) / std::max<std::size_t>(rows, 1) < columns) {
        refuse(column, fmt::format("{} x {} values, and bytes for fewer: the file is damaged", rows, columns));
      }
      require_exact(std::span(data + first, count), column);
      return std::vector<double>(data + first, data + first + count);
    };
    switch (variable.class_type) {
      case MAT_C_DOUBLE:
        return copy(static_cast<const double*>(variable.data));
      case MAT_C_SINGLE:
        return copy(static_cast<const float*>(variable.data));
      case MAT_C_INT64:
        return copy(static_cast<const std::int64_t*>(variable.data));
      case MAT_C_UINT64:
        return copy(static_cast<const std::uint64_t*>(variable.data));
      case MAT_C_INT32:
        return copy(static_cast<const std::int32_t*>(variable.data));
      case MAT_C_UINT32:
        return copy(static_cast<const std::uint32_t*>(variable.data));
      case MAT_C_INT16:
        return copy(static_cast<const std::int16_t*>(variable.data));
      case MAT_C_UINT16:
        return copy(static_cast<const std::uint16_t*>(variable.data));
      case MAT_C_INT8:
        return copy(static_cast<const std::int8_t*>(variable.data));
      case MAT_C_UINT8:  // and logical
        return copy(static_cast<const std::uint8_t*>(variable.data));
      default:
        refuse(column, "holds no numbers; allowed: double, single, int8 to int64, uint8 to uint64, logical");
    }
  }

  template <class T>
  void require_exact(std::span<const T> values, const ImportColumn& column) const {
    if constexpr (std::is_integral_v<T>) {
      const auto found = std::ranges::find_if_not(values, is_exact<T>);
      if (found != values.end()) {
        refuse(column, fmt::format("row {}: {} does not fit a double; allowed: integers of at most 2^53 = {}",
                                   found - values.begin() + 1, *found, kLargestExactInteger));
      }
    }
  }

  std::filesystem::path path_;
  MatFile file_;
};

}  // namespace

std::string matlab_columns_text(const std::filesystem::path& path, const ImportMap& map) {
  const MatlabReader reader(path);
  std::string text;
  for (const ImportColumn& column : map.columns) {
    const std::vector<double> values = reader.read(column);
    const std::uint64_t rows = values.size();
    text.append(reinterpret_cast<const char*>(&rows), sizeof rows);
    text.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
  }
  return text;
}

std::string matlab_variables_text(const std::filesystem::path& path) {
  std::string text;
  for (const MatlabVariable& variable : MatlabReader(path).variables()) {
    text += variable.name + '\t' + variable.unit + '\n';
  }
  return text;
}

}  // namespace hotfire
