// SPDX-License-Identifier: Apache-2.0
#include "tests/report/sample_effects.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace hotfire::test {

using nlohmann::json;

namespace {

json friction_curve() {
  std::vector<double> forward_x;
  std::vector<double> forward_y;
  std::vector<double> steady_x;
  std::vector<double> steady_y;
  for (int index = -100; index <= 100; ++index) {
    const double rate = 0.0012 * index;
    const double law = 1.2e4 * (1.0 + 0.4 * std::exp(-rate * rate / 4e-4));
    steady_x.push_back(rate);
    steady_y.push_back(rate == 0.0 ? std::nan("") : std::copysign(law, rate) + 2e4 * rate);
  }
  for (int index = 0; index <= 200; ++index) {
    const double phase = 2.0 * std::numbers::pi * index / 200.0;
    forward_x.push_back(0.1 * std::cos(phase));
    forward_y.push_back(1.25e4 * std::tanh(4.0 * std::cos(phase - 0.35)));
  }
  return {{"x_label", "gimbal rate"},
          {"x_unit", "rad/s"},
          {"y_label", "friction torque"},
          {"y_unit", "N.m"},
          {"series",
           {{{"name", "steady sliding"}, {"x", steady_x}, {"y", steady_y}},
            {{"name", "sine, 0.4 deg at 2 Hz"}, {"x", forward_x}, {"y", forward_y}}}}};
}

json from_profile(json parameter, double low, double high) {
  parameter["ci95"] = {low, high};
  parameter["interval_from"] = "profile";
  return parameter;
}

}  // namespace

json reconstructed_points() {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> rates(-0.12, 0.12);
  std::normal_distribution<double> spread(0.0, 1.6e3);
  std::vector<double> x;
  std::vector<double> y;
  for (int index = 0; index < 1500; ++index) {
    x.push_back(rates(generator));
    y.push_back(1.25e4 * std::tanh(x.back() / 0.01) + spread(generator));
  }
  return {{"x_label", "gimbal rate"},
          {"x_unit", "rad/s"},
          {"y_label", "friction torque"},
          {"y_unit", "N.m"},
          {"x", x},
          {"y", y}};
}

json parameter(double value, const char* unit, double half_width, const char* meaning, bool identified) {
  return {{"value", value},
          {"unit", unit},
          {"ci95", identified ? json{value - half_width, value + half_width} : json()},
          {"identified", identified},
          {"interval_from", "curvature"},
          {"meaning", meaning}};
}

json friction() {
  return {{"name", "gimbal_friction"},
          {"site", "engine_torque"},
          {"law", "lugre"},
          {"meaning",
           "Friction in the gimbal bearing: bristles that deflect before they slide, so the torque depends on the "
           "rate and on the motion before."},
          {"parameters",
           {{"coulomb_torque", parameter(12034.0, "N.m", 85.0, "torque of steady sliding")},
            {"bristle_stiffness", parameter(4.61e6, "N.m/rad", 2.1e5, "stiffness before sliding")},
            {"stribeck_ratio", parameter(1.38, "1", 0.06, "break-away torque over sliding torque")},
            {"vibration_ratio", parameter(1.0, "1", 0.0, "sliding torque at rest under vibration", false)}}},
          {"evidence", {{"held_out_error_drop_percent", 88.4}, {"delta_bic", -41230.0}, {"t_statistic", 283.0}}},
          {"alternatives",
           {{{"name", "gimbal_friction"}, {"law", "dahl"}, {"delta_bic", 812.0}, {"held_out_error_drop_percent", 85.9}},
            {{"name", "piston_friction"}, {"delta_bic", 9120.0}, {"held_out_error_drop_percent", 51.2}}}},
          {"curve", friction_curve()}};
}

json soft_stiffness() {
  return {
      {"name", "soft_stiffness"},
      {"site", "load_spring"},
      {"meaning", "The actuator is softer below a load, as if its mounting settled."},
      {"parameters",
       {{"soft_ratio", parameter(0.42, "1", 0.03, "stiffness at no load over stiffness at full load")},
        {"corner_force",
         from_profile(parameter(2.31e4, "N", 900.0, "load at which the stiffness is half way"), 2.27e4, 2.52e4)}}},
      {"evidence", {{"held_out_error_drop_percent", 31.0}, {"delta_bic", -2210.0}}},
      {"alternatives", {{{"name", "backlash"}, {"delta_bic", 310.0}, {"held_out_error_drop_percent", 27.5}}}},
      {"curve",
       {{"x_label", "load"},
        {"x_unit", "N"},
        {"y_label", "stiffness"},
        {"y_unit", "N/m"},
        {"series",
         {{{"name", "found"}, {"x", {0, 1e4, 2e4, 3e4, 5e4, 8e4}}, {"y", {5.1e7, 6.3e7, 8.2e7, 9.9e7, 1.13e8, 1.19e8}}}}}}}};
}

}  // namespace hotfire::test
