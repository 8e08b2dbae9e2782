// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"
#include "tools/files/model/model_file.hpp"

namespace hotfire {

using test::expect_message;

TEST_GROUP(RefusedModel) {
  test::Scratch scratch;

  std::string refused_file(const std::string& content) const {
    return test::refusal([&] { load_model(scratch.write("m.toml", content)); });
  }
  /// A simplex model with these lines from line 3 on.
  std::string refused(const std::string& lines) const {
    return refused_file("schema = 1\ntopology = \"simplex\"\n" + lines);
  }
};

TEST(RefusedModel, an_unknown_key_is_named_with_its_place_and_the_nearest_known_one) {
  expect_message(refused("[actuator]\npiston_aera = 1\n"),
                 {"m.toml:4:1:", "actuator.piston_aera", "unknown key", "did you mean \"piston_area\"?", "moment_arm"});
  expect_message(refused("[servovalv]\n"), {"m.toml:3:2:", "servovalv", "did you mean \"servovalve\"?"});
  expect_message(refused("[mass]\ninertia = 1\n"), {"m.toml:3:2:", "mass", "unknown key", "servovalve, actuator"});
  expect_message(refused("[effects.gimbal_frction]\n"),
                 {"m.toml:3:", "effects.gimbal_frction", "did you mean \"gimbal_friction\"?"});
  expect_message(refused("[effects.backlash]\nhalf_widht = 1\n"),
                 {"m.toml:4:1:", "effects.backlash.half_widht", "\"half_width\""});
  expect_message(refused("[sensors]\npistn_noise = 1\n"),
                 {"m.toml:4:1:", "sensors.pistn_noise", "did you mean \"piston_noise\"?"});
}

TEST(RefusedModel, a_wrong_dimension_is_named_with_value_unit_and_the_one_wanted) {
  expect_message(refused("[servovalve]\nrated_flow = \"50 psi\"\n"),
                 {"m.toml:4:14:", "servovalve.rated_flow", "\"50 psi\"", "\"psi\"", "m^3/s"});
  expect_message(refused("[servovalve]\nnatural_frequency = \"60 Hz\"\n"),
                 {"m.toml:4:21:", "servovalve.natural_frequency", "\"60 Hz\"", "write 376.99 rad/s"});
  expect_message(refused("[effects.structural_mode]\nfrequency = \"42.4115 rad/s\"\n"),
                 {"m.toml:4:13:", "effects.structural_mode.frequency", "write 6.75 Hz"});
  expect_message(refused("[sensors]\npiston_noise = \"8 \xC2\xB5s\"\n"),
                 {"m.toml:4:", "sensors.piston_noise", "\"8 \xC2\xB5s\"", "to m"});
}

TEST(RefusedModel, an_unknown_unit_or_a_string_without_one_is_refused) {
  expect_message(refused("[engine]\ninertia = \"5 parsnip\"\n"),
                 {"m.toml:4:", "engine.inertia", "\"parsnip\"", "not known", "kg.m^2"});
  expect_message(refused("[engine]\ninertia = \"5\"\n"),
                 {"m.toml:4:", "engine.inertia", "\"5\"", "without a unit", "kg.m^2"});
  expect_message(refused("[engine]\ninertia = \"heavy\"\n"),
                 {"m.toml:4:", "engine.inertia", "\"heavy\"", "begin with a number"});
}

TEST(RefusedModel, nan_and_infinity_are_refused_bare_and_in_a_string) {
  expect_message(refused("[engine]\ninertia = nan\n"), {"m.toml:4:11:", "engine.inertia = nan", "not a finite number"});
  expect_message(refused("[engine]\ninertia = -inf\n"), {"m.toml:4:11:", "engine.inertia = -inf", "not a finite number"});
  expect_message(refused("[engine]\ninertia = \"nan kg.m^2\"\n"), {"m.toml:4:11:", "engine.inertia", "not a finite number"});
}

TEST(RefusedModel, a_value_outside_its_bounds_is_refused_with_the_bounds) {
  expect_message(refused("[engine]\ninertia = -1\n"), {"m.toml:4:11:", "engine.inertia = -1", "1e-06 to 1e+09", "kg.m^2"});
  expect_message(refused("[effects.valve_deadband]\nhalf_width = 0.51\n"),
                 {"m.toml:4:14:", "half_width = 0.51", "0 to 0.5"});
}

TEST(RefusedModel, a_value_of_another_type_is_refused) {
  expect_message(refused("[engine]\ninertia = true\n"), {"m.toml:4:11:", "engine.inertia = true", "not a number"});
  expect_message(refused("[engine]\ninertia = [1, 2]\n"), {"m.toml:4:11:", "engine.inertia = [1, 2]", "not a number"});
  expect_message(refused("engine = 3\n"), {"m.toml:3:10:", "engine = 3", "[engine]"});
  expect_message(refused("[effects]\nbacklash = 1\n"), {"m.toml:4:12:", "effects.backlash = 1", "[effects.backlash]"});
  expect_message(refused("name = 3\n"), {"m.toml:3:8:", "name = 3", "string"});
}

TEST(RefusedModel, schema_and_topology_must_be_there_and_of_this_build) {
  expect_message(refused_file("topology = \"simplex\"\n"), {"m.toml:1:", "schema", "missing", "schema = 1"});
  expect_message(refused_file("schema = 2\n"), {"m.toml:1:10:", "schema = 2", "allowed: 1"});
  expect_message(refused_file("schema = 1\n"), {"m.toml:1:", "topology", "missing", "\"simplex\", \"direct\""});
  for (const std::string later : {"taos", "masv", "complex"}) {
    expect_message(refused_file("schema = 1\ntopology = \"" + later + "\"\n"),
                   {"m.toml:2:12:", ("topology = \"" + later + "\"").c_str(), "not a topology that this takes",
                    "\"simplex\", \"direct\""});
  }
}

TEST(RefusedModel, a_law_that_is_missing_or_unknown_is_refused_with_the_laws_there_are) {
  expect_message(refused("[effects.gimbal_friction]\ncoulomb_torque = 1\n"),
                 {"m.toml:3:", "effects.gimbal_friction.law", "missing", "\"coulomb\", \"dahl\", \"lugre\""});
  expect_message(refused("[effects.gimbal_friction]\nlaw = \"lugra\"\n"),
                 {"m.toml:4:7:", "effects.gimbal_friction.law = \"lugra\"", "did you mean \"lugre\"?"});
  expect_message(refused("[effects.sensor_lag]\nchannel = \"pistn\"\n"), {"m.toml:4:11:", "channel", "\"piston\""});
}

TEST(RefusedModel, a_parameter_of_another_law_is_refused_and_not_ignored) {
  expect_message(
      refused("[effects.gimbal_friction]\nlaw = \"coulomb\"\nstiffness = 1e7\n"),
      {"m.toml:5:1:", "effects.gimbal_friction.stiffness", "no meaning with law = \"coulomb\"", "\"dahl\", \"lugre\""});
}

TEST(RefusedModel, a_curve_must_rise_in_x_and_have_as_many_points_in_both_arrays) {
  const std::string table = "[effects.soft_stiffness]\nlaw = \"table\"\n";
  expect_message(refused(table), {"m.toml:3:", "effects.soft_stiffness.load", "missing", "load and table_stiffness"});
  expect_message(refused(table + "load = [0, 1000]\ntable_stiffness = [1e7]\n"),
                 {"m.toml:6:", "table_stiffness", "1 points", "2"});
  expect_message(refused(table + "load = [0, 1000, 1000]\ntable_stiffness = [1e7, 2e7, 3e7]\n"),
                 {"m.toml:5:18:", "load[2] = 1000", "above the value before it"});
  expect_message(refused(table + "load = [0, 1000]\ntable_stiffness = [1e7, 1.0]\n"),
                 {"m.toml:6:25:", "table_stiffness[1] = 1.0", "100000 to 1e+12"});
  expect_message(refused(table + "load = [0, nan]\ntable_stiffness = [1e7, 1e7]\n"),
                 {"m.toml:5:12:", "load[1] = nan", "not a finite"});
  expect_message(refused(table + "load = 5\ntable_stiffness = [1e7, 1e7]\n"),
                 {"m.toml:5:8:", "load = 5", "must be an array"});
}

TEST(RefusedModel, a_broken_relation_between_values_is_named) {
  expect_message(refused("[effects.soft_stiffness]\nlaw = \"table\"\nload = [0]\ntable_stiffness = [1e7]\n"),
                 {"m.toml:3:", "effects.soft_stiffness", "at least two points"});
  expect_message(refused("[effects.soft_stiffness]\nlaw = \"table\"\nload = [-5, 5]\ntable_stiffness = [1e7, 1e7]\n"),
                 {"m.toml:3:", "effects.soft_stiffness", "must not be negative"});
}

TEST(RefusedModel, a_tolerance_must_name_a_declared_parameter_and_lie_above_0_and_up_to_1) {
  expect_message(refused("[tolerance]\nservovalve.position_gian = 0.1\n"),
                 {"m.toml:4:", "servovalve.position_gian", "no such declared parameter", "\"servovalve.position_gain\""});
  expect_message(refused("[tolerance]\nengine.inertia = 0\n"), {"m.toml:4:18:", "engine.inertia = 0", "above 0, at most 1"});
  expect_message(refused("[tolerance]\nengine.inertia = 1.5\n"),
                 {"m.toml:4:18:", "engine.inertia = 1.5", "above 0, at most 1"});
  // Of an effect: one that is declared, and a number that its law uses.
  expect_message(refused("[tolerance]\neffects.gimbal_friction.coulomb_torque = 0.3\n"),
                 {"m.toml:4:", "effects.gimbal_friction.coulomb_torque", "no such declared parameter"});
  expect_message(refused("[tolerance]\neffects.gimbal_friction.stiffness = 0.3\n"
                         "[effects.gimbal_friction]\nlaw = \"coulomb\"\ncoulomb_torque = 11e3\n"),
                 {"m.toml:4:", "effects.gimbal_friction.stiffness", "no such declared parameter"});
}

TEST(RefusedModel, an_effect_of_the_other_axis_needs_one) {
  expect_message(refused("[effects.cross_axis]\nstiffness = 1e5\n"),
                 {"m.toml:3:", "effects.cross_axis", "simplex", "allowed with topology \"taos\""});
}

TEST(RefusedModel, a_noise_must_be_above_zero) {
  expect_message(refused("[sensors]\npiston_noise = 0\n"), {"m.toml:4:16:", "sensors.piston_noise = 0", "above 0"});
}

TEST(RefusedModel, a_key_given_twice_and_text_that_is_not_toml_are_refused_with_their_place) {
  expect_message(refused("[engine]\ninertia = 1\ninertia = 2\n"), {"m.toml:5:", "inertia"});
  expect_message(refused("[engine\n"), {"m.toml:3:", "not TOML"});
  expect_message(refused("[engine]\ninertia = \n"), {"m.toml:4:", "not TOML"});
}

TEST(RefusedModel, a_file_that_is_missing_a_folder_or_huge_is_refused) {
  expect_message(test::refusal([&] { load_model(scratch.path("none.toml")); }), {"none.toml", "No such file"});
  expect_message(test::refusal([&] { load_model(scratch.path("")); }), {"directory"});
  const auto path = scratch.write("huge.toml", "");
  std::filesystem::resize_file(path, std::uintmax_t{2} << 30);
  expect_message(test::refusal([&] { load_model(path); }), {"huge.toml:1:", "1048576 bytes"});
}

}  // namespace hotfire
