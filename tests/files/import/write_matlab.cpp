// SPDX-License-Identifier: Apache-2.0
#include "tests/files/import/write_matlab.hpp"

#include <matio.h>

#include <array>
#include <map>

namespace hotfire::test {

namespace {

matvar_t* matrix(const std::string& name, std::size_t rows, std::size_t columns, std::vector<double> values) {
  std::array<std::size_t, 2> size{rows, columns};
  return Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), values.data(), 0);
}

struct MatlabClass {
  matio_classes in_memory;
  matio_types in_file;
  int flags = 0;
};

const std::map<std::string, MatlabClass> kClasses{
    {"double", {MAT_C_DOUBLE, MAT_T_DOUBLE}}, {"single", {MAT_C_SINGLE, MAT_T_SINGLE}},
    {"int8", {MAT_C_INT8, MAT_T_INT8}},       {"uint8", {MAT_C_UINT8, MAT_T_UINT8}},
    {"int16", {MAT_C_INT16, MAT_T_INT16}},    {"uint16", {MAT_C_UINT16, MAT_T_UINT16}},
    {"int32", {MAT_C_INT32, MAT_T_INT32}},    {"uint32", {MAT_C_UINT32, MAT_T_UINT32}},
    {"int64", {MAT_C_INT64, MAT_T_INT64}},    {"uint64", {MAT_C_UINT64, MAT_T_UINT64}},
    {"char", {MAT_C_CHAR, MAT_T_UINT8}},      {"logical", {MAT_C_UINT8, MAT_T_UINT8, MAT_F_LOGICAL}}};

const std::map<MatlabVersion, mat_ft> kFormats{{MatlabVersion::v4, MAT_FT_MAT4},
                                               {MatlabVersion::v6, MAT_FT_MAT5},
                                               {MatlabVersion::v7, MAT_FT_MAT5},
                                               {MatlabVersion::v7_3, MAT_FT_MAT73}};

}  // namespace

bool write_matlab_class(const std::filesystem::path& path, MatlabVersion version, const std::string& name,
                        const std::string& matlab_class, const void* values, std::size_t rows) {
  mat_t* file = Mat_CreateVer(path.c_str(), nullptr, kFormats.at(version));
  if (file == nullptr) {
    return false;
  }
  const MatlabClass& one = kClasses.at(matlab_class);
  std::array<std::size_t, 2> size{rows, 1};
  matvar_t* variable = Mat_VarCreate(name.c_str(), one.in_memory, one.in_file, 2, size.data(), const_cast<void*>(values),
                                     one.flags);  // which copies them
  const bool is_compressed = version == MatlabVersion::v7 || version == MatlabVersion::v7_3;
  const int error = Mat_VarWrite(file, variable, is_compressed ? MAT_COMPRESSION_ZLIB : MAT_COMPRESSION_NONE);
  Mat_VarFree(variable);
  Mat_Close(file);
  return error == 0;
}

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
