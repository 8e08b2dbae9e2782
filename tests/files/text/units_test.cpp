// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "tests/files/expect.hpp"
#include "tests/support/refusal.hpp"
#include "tools/files/text/units.hpp"

namespace hotfire {

namespace {

std::string refused_unit(double value, const std::string& unit, const std::string& wanted) {
  return test::refusal<UnitError>([&] { convert_unit(value, unit, wanted); });
}

}  // namespace

TEST_GROUP(Units){};

TEST(Units, the_units_of_the_actuator_data_convert_to_their_definitions) {
  DOUBLES_EQUAL(24.8 * 0.0254 * 0.0254, convert_unit(24.8, "in^2", "m^2"), 1e-15);
  DOUBLES_EQUAL(50.0 * 3.785411784e-3 / 60.0, convert_unit(50.0, "gallon/minute", "m^3/s"), 1e-9);
  DOUBLES_EQUAL(50.0 * 3.785411784e-3 / 60.0, convert_unit(50.0, "gpm", "m^3/s"), 1e-9);
  DOUBLES_EQUAL(3000.0 * 6894.757293168, convert_unit(3000.0, "psi", "Pa"), 1e-2);
  DOUBLES_EQUAL(0.7544, convert_unit(29.7, "in", "m"), 1e-4);
  DOUBLES_EQUAL(3.14159265358979 / 180.0, convert_unit(1.0, "deg", "rad"), 1e-12);
}

TEST(Units, a_value_in_the_wanted_unit_keeps_its_bits) {
  CHECK(convert_unit(0.1, "N.m.s/rad", "N.m.s/rad") == 0.1);
  CHECK(convert_unit(0.003, "kg^-0.5", "kg^-0.5") == 0.003);
}

TEST(Units, hertz_are_refused_where_radians_per_second_are_wanted_with_the_value_to_write) {
  test::expect_message(refused_unit(60.0, "Hz", "rad/s"), {"\"Hz\"", "rad/s", "write 376.99 rad/s"});
  test::expect_message(refused_unit(0.06, "kHz", "rad/s"), {"\"kHz\"", "write 376.99 rad/s"});
}

TEST(Units, radians_per_second_are_refused_where_hertz_are_wanted_with_the_value_to_write) {
  test::expect_message(refused_unit(376.9911184, "rad/s", "Hz"), {"\"rad/s\"", "Hz", "write 60 Hz"});
  test::expect_message(refused_unit(60.0, "rpm", "Hz"), {"\"rpm\"", "write 1 Hz"});
}

TEST(Units, a_damping_per_hertz_is_refused_where_one_per_radian_is_wanted) {
  test::expect_message(refused_unit(1.0, "N.m/Hz", "N.m.s/rad"), {"\"N.m/Hz\"", "N.m.s/rad"});
}

TEST(Units, torque_units_without_the_radian_are_accepted) {
  DOUBLES_EQUAL(12.0, convert_unit(12.0, "N.m.s", "N.m.s/rad"), 0.0);
  DOUBLES_EQUAL(1.3558179483314, convert_unit(1.0, "lbf.ft/rad", "N.m/rad"), 1e-9);
}

TEST(Units, seconds_do_not_pass_for_hertz_by_their_reciprocal) {
  test::expect_message(refused_unit(5.0, "s", "Hz"), {"\"s\"", "does not convert to Hz"});
}

TEST(Units, a_wrong_dimension_names_the_unit_its_dimension_and_the_one_wanted) {
  test::expect_message(refused_unit(50.0, "psi", "m^3/s"), {"\"psi\"", "m-1.kg.s-2", "does not convert to m^3/s"});
}

TEST(Units, an_unknown_unit_is_named) {
  test::expect_message(refused_unit(1.0, "furlongs_per_beer", "m"), {"\"furlongs_per_beer\"", "not known"});
  test::expect_message(refused_unit(1.0, "", "m"), {"\"\"", "not known"});
}

TEST(Units, a_fractional_exponent_is_refused_and_not_read_as_a_factor) {
  test::expect_message(refused_unit(1.0, "g^-0.5", "kg^-0.5"), {"\"g^-0.5\"", "write a bare number in kg^-0.5"});
  test::expect_message(refused_unit(1.0, "m^0.5", "m"), {"\"m^0.5\"", "decimal point"});
}

TEST(Units, a_plain_number_is_not_an_angle) { test::expect_message(refused_unit(1.0, "1", "rad"), {"\"1\"", "rad"}); }

TEST(Units, units_of_a_direct_model_follow_its_record) {
  CHECK(follows_record(""));
  CHECK(follows_record("force.time^2/position"));
  CHECK(!follows_record("N.m"));
}

}  // namespace hotfire
