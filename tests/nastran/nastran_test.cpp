// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "tests/nastran/four_modes.hpp"
#include "tests/nastran/write_op2.hpp"
#include "tools/nastran/geometry.hpp"
#include "tools/nastran/modes.hpp"
#include "tools/nastran/projection.hpp"
#include "tools/nastran/text_lines.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::nastran {

namespace {

/// Half of the last of seven digits, over a first digit of one; a single-precision number has no less.
constexpr double kSevenDigits = 5e-7;

}  // namespace

TEST_GROUP(Nastran) {
  test::Scratch scratch;

  /// Compares with the table by hand; `digits` is what the form prints of a number, relative.
  void expect_table(const std::filesystem::path& map, double digits) const {
    const Projection projection = project(map);
    // What `hotfire` writes is what its models read.
    const ModeSet modes = load_modes(scratch.write("table.csv", mode_table_text(projection.modes, {})));
    LONGS_EQUAL(1, projection.left_out);
    LONGS_EQUAL(1, modes.engines);
    LONGS_EQUAL(4, modes.modes());
    constexpr double kPoundSecondSquaredPerInch = 175.12683524647636;  // kg
    constexpr double kInch = 0.0254;                                   // m
    const Eigen::Matrix4d by_hand = test::four_modes_by_hand() / std::sqrt(kPoundSecondSquaredPerInch);
    for (int mode = 0; mode < 4; ++mode) {
      const double frequency = 2.0 * std::pow(2.0, mode);
      DOUBLES_EQUAL(frequency, modes.frequency(mode), digits * frequency);
      DOUBLES_EQUAL(0.01, modes.damping_ratio(mode), 0.0);
      for (int port = 0; port < 4; ++port) {
        const double wanted = by_hand(port, mode) / (port < 2 ? 1.0 : kInch);
        // Of numbers up to 1 a sum of five has the rounding of each.
        DOUBLES_EQUAL(wanted, modes.shape(port, mode), digits * std::max(std::abs(wanted), by_hand.cwiseAbs().maxCoeff()));
      }
    }
  }
  void copy(const std::string& ending) const {
    scratch.write("four_modes." + ending, test::content_of(test::four_modes(ending)));
  }
};

TEST(Nastran, FourModesOfThePrintedOutputGiveTheTableByHand) {
  copy("f06");
  expect_table(test::write_map(scratch, "four_modes.f06", "four_modes.f06"), kSevenDigits);
}

TEST(Nastran, FourModesOfThePunchFileGiveTheTableByHand) {
  copy("pch");
  copy("bdf");
  expect_table(test::write_map(scratch, "four_modes.pch", "four_modes.bdf", "generalised_mass = 1.0\n"), kSevenDigits);
}

TEST(Nastran, FourModesOfTheBinaryOutputGiveTheTableByHand) {
  copy("bdf");
  for (const bool has_long_words : {false, true}) {
    for (const bool is_swapped : {false, true}) {
      for (const bool in_basic_system : {false, true}) {
        scratch.write("four_modes.op2", test::four_modes_op2({has_long_words, is_swapped, in_basic_system}));
        expect_table(test::write_map(scratch, "four_modes.op2", "four_modes.bdf"), has_long_words ? 1e-14 : kSevenDigits);
      }
    }
  }
}

TEST(Nastran, ThePrintedEchoHasTheGridsOfTheBulkData) {
  const std::map<int, Grid> printed = load_geometry(test::four_modes("f06"));
  const std::map<int, Grid> bulk = load_geometry(test::four_modes("bdf"));
  LONGS_EQUAL(8, printed.size());
  LONGS_EQUAL(8, bulk.size());
  for (const auto& [id, grid] : bulk) {
    DOUBLES_EQUAL(0.0, (grid.place - printed.at(id).place).norm(), 1e-12);
    DOUBLES_EQUAL(0.0, (grid.axes - printed.at(id).axes).norm(), 1e-12);
  }
  // Grid 303 is given in the system 7, whose z is -y and whose y is z.
  DOUBLES_EQUAL(0.0, (bulk.at(303).place - Eigen::Vector3d(30.0, 38.0, 0.0)).norm(), 1e-12);
  DOUBLES_EQUAL(0.0, (bulk.at(302).axes.col(2) - Eigen::Vector3d(0.0, -1.0, 0.0)).norm(), 1e-12);
}

TEST(Nastran, CoordinateSystemsLieUponEachOther) {
  // System 2 is 1 in along x of system 1, which is 10 in along x and turned by 90 degrees about z.
  const auto grids = load_geometry(scratch.write("two.bdf",
                                                 "CORD2R,1,,10.,0.,0.,10.,0.,1.\n,10.,1.,0.\n"
                                                 "CORD2R,2,1,1.,0.,0.,1.,0.,1.\n,2.,0.,0.\nGRID,5,2,0.,3.,0.,1\n"));
  DOUBLES_EQUAL(0.0, (grids.at(5).place - Eigen::Vector3d(7.0, 1.0, 0.0)).norm(), 1e-12);
}

TEST(Nastran, APlaceWithoutAGridMovesWithTheNearestOne) {
  copy("f06");
  const std::string map = test::content_of(test::write_map(scratch, "four_modes.f06", "four_modes.f06"));
  expect_table(scratch.write("nearest.toml", test::replaced(map, "{grid = 303, at = [30, 40, 0]}", "{at = [30, 40, 0]}")),
               kSevenDigits);
}

TEST(Nastran, StringsAreTheApproachOfTheirEnds) {
  copy("f06");
  std::string further;
  for (int string = 1; string <= 4; ++string) {
    further += "[strings.string" + std::to_string(string) + ".engine1]\nengine = 202\nvehicle = 201\n";
  }
  const ModeSet modes = project(test::write_map(scratch, "four_modes.f06", "four_modes.f06", further)).modes;
  LONGS_EQUAL(4, modes.string_shape.rows());
  CHECK(modes.string_shape.row(2) == modes.shape.row(0));
}

TEST(Nastran, NumbersAreReadAsNastranWritesThem) {
  DOUBLES_EQUAL(-2.59e-3, *number_of("-2.5900-3"), 1e-18);
  DOUBLES_EQUAL(3.0e7, *number_of("3.0000+7"), 0.0);
  DOUBLES_EQUAL(1.5e3, *number_of("1.5D+03"), 0.0);
  DOUBLES_EQUAL(-1.5e-3, *number_of(" -1.500000E-03 "), 0.0);
  DOUBLES_EQUAL(0.25, *number_of(".25"), 0.0);
  for (const char* text : {"", "-", "1.0E", "1.0-", "1..0", "*****", "1.0 2", "nan", "inf"}) {
    CHECK_FALSE_TEXT(number_of(text).has_value(), text);
  }
}

}  // namespace hotfire::nastran
