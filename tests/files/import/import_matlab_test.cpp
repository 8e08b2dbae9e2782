// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "tests/files/expect.hpp"
#include "tests/files/import/write_matlab.hpp"
#include "tests/files/scratch.hpp"
#include "tools/files/import/import.hpp"

using namespace hotfire;
using namespace hotfire::test;

TEST_GROUP(ImportMatlab) {
  Scratch scratch;

  /// Imports the variable "X" of a file, which has rows of 1 ms.
  Record imported(const std::filesystem::path& path) const {
    return import_record(path, map_of("X"), scratch.path("run.csv"));
  }

  /// Of a column in rows of 1 ms.
  ImportMap map_of(const std::string& column) const {
    return load_import_map(scratch.write(
        "map.toml", "schema = 1\nperiod = \"1 ms\"\n[channels.piston]\nunit = \"m\"\ncolumn = \"" + column + "\"\n"));
  }

  /// The bytes of a file with the struct X, whose member beta has three numbers.
  std::string struct_file() const {
    const std::filesystem::path path = scratch.path("struct.mat");
    write_matlab(path, {}, {"X", "beta", {1.0, 2.0, 3.0}});
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  template <class T>
  std::filesystem::path written(MatlabVersion version, const std::string& matlab_class, const std::vector<T>& values) const {
    std::filesystem::path path = scratch.path(matlab_class + ".mat");
    CHECK(write_matlab_class(path, version, "X", matlab_class, values.data(), values.size()));
    return path;
  }

  template <class T>
  void expect_read_back(MatlabVersion version, const std::string& matlab_class, const std::vector<T>& values) const {
    const Record record = imported(written(version, matlab_class, values));
    UNSIGNED_LONGS_EQUAL_TEXT(values.size(), record.rows, matlab_class.c_str());
    for (std::size_t row = 0; row < values.size(); ++row) {
      DOUBLES_EQUAL_TEXT(static_cast<double>(values[row]), record.channels[0].values[row], 0.0, matlab_class.c_str());
    }
  }

  void expect_every_class_read_back(MatlabVersion version) const {
    expect_read_back<double>(version, "double", {-1.5, 0.1, 1e300});
    expect_read_back<float>(version, "single", {-1.5F, 0.1F, 1e30F});
    expect_read_back<std::int8_t>(version, "int8", {-128, 0, 127});
    expect_read_back<std::uint8_t>(version, "uint8", {0, 1, 255});
    expect_read_back<std::int16_t>(version, "int16", {-32768, 0, 32767});
    expect_read_back<std::uint16_t>(version, "uint16", {0, 1, 65535});
    expect_read_back<std::int32_t>(version, "int32", {INT32_MIN, 0, INT32_MAX});
    expect_read_back<std::uint32_t>(version, "uint32", {0, 1, UINT32_MAX});
    expect_read_back<std::int64_t>(version, "int64", {-kLargest, 0, kLargest});
    expect_read_back<std::uint64_t>(version, "uint64", {0, 1, kLargest});
    expect_read_back<std::uint8_t>(version, "logical", {0, 1, 1});
  }

  /// 2^53: no integer above it is sure to be a double.
  static constexpr std::int64_t kLargest = 9'007'199'254'740'992;
};

TEST(ImportMatlab, every_class_of_real_numbers_is_read_from_an_uncompressed_file) {
  expect_every_class_read_back(MatlabVersion::v6);
}

TEST(ImportMatlab, every_class_of_real_numbers_is_read_from_a_compressed_file) {
  expect_every_class_read_back(MatlabVersion::v7);
}

TEST(ImportMatlab, every_class_of_real_numbers_is_read_from_a_file_of_version_7_3) {
  const double one = 1.0;
  if (!write_matlab_class(scratch.path("try.mat"), MatlabVersion::v7_3, "X", "double", &one, 1)) {
    std::printf("\nskipped: matio of this machine is built without HDF5 and writes no version 7.3\n");
    return;
  }
  expect_every_class_read_back(MatlabVersion::v7_3);
}

TEST(ImportMatlab, integers_that_no_double_holds_are_refused_with_variable_row_and_value) {
  const auto refused = [this]<class T>(const std::string& matlab_class, const std::vector<T>& values) {
    return refusal([&] { imported(written(MatlabVersion::v7, matlab_class, values)); });
  };
  expect_message(refused("int64", std::vector<std::int64_t>{0, kLargest + 1, 0}),
                 {"int64.mat: X for piston: row 2: 9007199254740993", "at most 2^53 = 9007199254740992"});
  expect_message(refused("int64", std::vector<std::int64_t>{0, 0, INT64_MIN}), {"row 3: -9223372036854775808", "2^53"});
  expect_message(refused("uint64", std::vector<std::uint64_t>{UINT64_MAX, 0}), {"row 1: 18446744073709551615", "2^53"});
}

TEST(ImportMatlab, what_holds_no_numbers_is_refused_with_the_classes_that_do) {
  expect_message(refusal([&] {
                   imported(written(MatlabVersion::v7, "char", std::vector<std::uint8_t>{'a', 'b'}));
                 }),
                 {"char.mat: X for piston: holds no numbers", "int8 to int64, uint8 to uint64, logical"});
}

TEST(ImportMatlab, AMatlabFileGivesVectorsMatrixColumnsAndFieldsOfStructs) {
  std::vector<double> time;
  std::vector<double> matrix;
  time.reserve(50);
  matrix.reserve(100);
  for (int i = 0; i < 50; ++i) {
    time.push_back(1e-3 * i);
  }
  for (int i = 0; i < 100; ++i) {
    matrix.push_back(0.1 * i);
  }
  const auto path = scratch.path("run.mat");
  write_matlab(path, {{"t", 50, 1, time}, {"X", 50, 2, matrix}}, {"data", "beta", time});
  const auto map = load_import_map(scratch.write(
      "map.toml",
      "schema = 1\ntime = {column = \"t\", unit = \"s\"}\n[channels]\ncommand = {column = \"data.beta\", unit = "
      "\"rad\"}\npiston = {column = \"X:2\", unit = \"mm\"}\n"));
  const Record record = import_record(path, map, scratch.path("run.csv"));
  LONGS_EQUAL(50, record.rows);
  DOUBLES_EQUAL(7e-3, record.find("command")->values[7], 1e-15);
  DOUBLES_EQUAL(5.7e-3, record.find("piston")->values[7], 1e-15);
}

TEST(ImportMatlab, AMatlabVariableThatIsNotThereIsRefusedWithThoseThatAre) {
  const auto path = scratch.path("run.mat");
  write_matlab(path, {{"t", 3, 1, {0.0, 0.001, 0.002}}, {"X", 3, 2, {1, 2, 3, 4, 5, 6}}}, {"data", "beta", {1, 2, 3}});
  const auto refused_column = [&](const std::string& column) {
    const auto map = load_import_map(scratch.write(
        "map.toml", "schema = 1\nperiod = \"1 ms\"\n[channels.piston]\nunit = \"m\"\ncolumn = \"" + column + "\"\n"));
    return refusal([&] { import_record(path, map, scratch.path("run.csv")); });
  };
  expect_message(refused_column("xp"), {"run.mat", "no variable \"xp\"", "t, X, data"});
  expect_message(refused_column("X"), {"3 x 2", "X:1"});
  expect_message(refused_column("X:3"), {"has 2 columns"});
  expect_message(refused_column("data.gamma"), {"no field \"gamma\""});
  const auto text = scratch.write("text.mat", "time,piston\n");
  const ImportMap map = map_of("X");
  expect_message(refusal([&] { import_record(text, map, scratch.path("run.csv")); }),
                 {"text.mat", "not a readable MATLAB file"});
}

// matio 1.5.23 crashes on some of these: a struct whose tags say what is not so.
TEST(ImportMatlab, struct_with_any_byte_damaged_is_read_or_refused_and_the_program_goes_on) {
  const ImportMap map = map_of("X.beta");
  const std::string whole = struct_file();
  constexpr std::size_t kPreamble = 128;  // of text, which says nothing
#ifdef __SANITIZE_ADDRESS__
  constexpr std::size_t kStep = 10;  // such a process is slow to copy
#else
  constexpr std::size_t kStep = 1;
#endif
  std::size_t reads = 0;
  for (std::size_t at = kPreamble; at < whole.size(); at += kStep) {
    for (const char damage : {'\x7F', '\xFF'}) {
      std::string damaged = whole;
      damaged[at] = damage;
      const std::filesystem::path one = scratch.write("damaged.mat", damaged);
      const std::string refused = refusal([&] { read_matlab_columns(one, map); });
      CHECK(refused.empty() || refused.starts_with(one.string() + ": "));
      ++reads;
    }
  }
  CHECK(reads > 200 / kStep);
}

TEST(ImportMatlab, element_that_goes_beyond_its_file_or_its_matrix_is_refused_with_its_byte) {
  const ImportMap map = map_of("X.beta");
  const std::string whole = struct_file();
  const auto refused = [&](std::size_t at, char value) {
    std::string damaged = whole;
    damaged[at] = value;
    const std::filesystem::path one = scratch.write("damaged.mat", damaged);
    return refusal([&] { read_matlab_columns(one, map); });
  };
  constexpr std::size_t kVariable = 128;  // its tag: type, then size
  expect_message(refused(kVariable, 13), {"damaged.mat: byte 128: an element of type 13; a variable has 14 or 15"});
  expect_message(refused(kVariable + 6, 1), {"byte 128: an element of 65", "bytes, and", "are left"});
  // The flags, the first element of the variable.
  expect_message(refused(kVariable + 8, 19), {"byte 136: an element of type 19; allowed: 1 to 18"});
  expect_message(refused(kVariable + 13, 1), {"byte 136: an element of 264 bytes, and"});
  expect_message(refused(kVariable + 10, 5), {"byte 136: a small element of 5 bytes; allowed: 4"});
  const std::string other_order = std::string(124, ' ') + "\x01" + '\0' + "MI" + std::string("\0\0\0\x0D\0\0\0\x00", 8);
  const std::filesystem::path big_endian = scratch.write("big_endian.mat", other_order);
  expect_message(refusal([&] { read_matlab_columns(big_endian, map); }), {"byte 128: an element of type 13"});
  const std::filesystem::path cut = scratch.write("cut.mat", whole + "12345");
  expect_message(refusal([&] { read_matlab_columns(cut, map); }), {"5 bytes are left; the tag of an element has 8"});
}

TEST(ImportMatlab, doubles_are_read_from_a_file_of_version_4) {
  expect_read_back<double>(MatlabVersion::v4, "double", {-1.5, 0.1, 1e300});
}

TEST(ImportMatlab, variable_of_version_4_that_goes_beyond_its_file_is_refused_with_its_byte) {
  const ImportMap map = map_of("X");
  std::ifstream file(written<double>(MatlabVersion::v4, "double", {1.0, 2.0, 3.0}), std::ios::binary);
  const std::string variable(std::istreambuf_iterator<char>(file), {});
  constexpr std::size_t kSize = 20 + 2 + 3 * sizeof(double);  // header, name with its end, values
  UNSIGNED_LONGS_EQUAL(kSize, variable.size());
  // The second variable is damaged at a byte of its header.
  const auto refused = [&](std::size_t at, char value) {
    std::string damaged = variable + variable;
    damaged[kSize + at] = value;
    const std::filesystem::path one = scratch.write("damaged.mat", damaged);
    return refusal([&] { read_matlab_columns(one, map); });
  };
  STRCMP_EQUAL("", refused(0, variable[0]).c_str());
  expect_message(refused(0, 60), {"damaged.mat: byte 46: a variable of type 60"});
  expect_message(refused(4, 4), {"byte 46: 4 x 1 values of 8 bytes, and 24 are left"});
  expect_message(refused(12, 1), {"byte 46: 3 x 1 values of 16 bytes, and 24 are left"});
  expect_message(refused(15, 1), {"byte 46: complex by a flag of 16777216; allowed: 0 and 1"});
  expect_message(refused(16, 27), {"byte 46: a name of 27 bytes, and 26 are left"});
  expect_message(refused(16, 0), {"byte 46: a name of 0 bytes"});
  const std::filesystem::path cut = scratch.write("cut.mat", variable + "12345");
  expect_message(refusal([&] { read_matlab_columns(cut, map); }),
                 {"byte 46: 5 bytes are left; the header of a variable has 20"});
  // In the other byte order: type 1000, 3 x 2^24 values.
  const std::filesystem::path big_endian =
      scratch.write("big_endian.mat", variable + std::string("\0\0\x03\xE8\0\0\0\3\1\0\0\0\0\0\0\0\0\0\0\2X", 21) + '\0');
  expect_message(refusal([&] { read_matlab_columns(big_endian, map); }),
                 {"byte 46: 3 x 16777216 values of 8 bytes, and 0 are left"});
}

TEST(ImportMatlab, what_is_no_file_is_refused) {
  const ImportMap map = map_of("X");
  expect_message(refusal([&] { read_matlab_columns("/dev/zero", map); }), {"/dev/zero: is not a file"});
}
