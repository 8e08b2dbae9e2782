#include "tests/files/write_matlab.hpp"

#include <matio.h>

#include <array>

namespace hotfire::test {

namespace {

matvar_t* matrix(const std::string& name, std::size_t rows, std::size_t columns, std::vector<double> values) {
  std::array<std::size_t, 2> size{rows, columns};
  return Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), values.data(), 0);
}

}  // namespace

void write_matlab(const std::filesystem::path& path, const std::vector<MatlabMatrix>& matrices,
                  const MatlabStruct& with_field) {
  mat_t* file = Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5);
  for (const MatlabMatrix& one : matrices) {
    matvar_t* variable = matrix(one.name, one.rows, one.columns, one.values);
    Mat_VarWrite(file, variable, MAT_COMPRESSION_NONE);
    Mat_VarFree(variable);
  }
  std::array<std::size_t, 2> single{1, 1};
  std::array<const char*, 1> fields{with_field.field.c_str()};
  matvar_t* variable = Mat_VarCreateStruct(with_field.name.c_str(), 2, single.data(), fields.data(), 1);
  Mat_VarSetStructFieldByName(variable, with_field.field.c_str(), 0,
                              matrix(with_field.field, with_field.values.size(), 1, with_field.values));
  Mat_VarWrite(file, variable, MAT_COMPRESSION_NONE);
  Mat_VarFree(variable);
  Mat_Close(file);
}

}  // namespace hotfire::test
