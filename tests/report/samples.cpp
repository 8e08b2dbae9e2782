// SPDX-License-Identifier: Apache-2.0
#include "tests/report/samples.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "tests/report/sample_effects.hpp"
#include "tests/report/sample_residual.hpp"

namespace hotfire::test {
namespace {

using nlohmann::json;

constexpr const char* kHostile = "</script><script>document.title='owned'</script><img src=x onerror=alert(1)>&\"'";

/// What a channel of the sample record follows: gain on the motion, rms noise, and the error that each model leaves.
struct Shape {
  std::string name;
  std::string unit;
  double gain;
  double noise;
  double declared_error;
  double calibrated_error;
};

/// Steps, then a sine sweep: a command as test engineers write it [rad].
double command_at(double time) {
  if (time < 8.0) {
    return 0.007 * (std::fmod(time, 4.0) < 2.0 ? 1.0 : -1.0);
  }
  const double sweep = time - 8.0;
  return 0.006 * std::sin(2.0 * std::numbers::pi * (0.3 * sweep + 0.14 * sweep * sweep));
}

/// A first-order motion behind the command, and a bristle-like state that lags behind its reversals: what friction leaves.
ReportRecord record_of(const std::string& name, const std::vector<Shape>& shapes, std::size_t rows, double period,
                       unsigned seed) {
  ReportRecord record{.name = name,
                      .start = 0.0,
                      .period = period,
                      .held_out = {{0.0, 4.0}, {12.0, 16.0}},
                      .input_name = "command",
                      .input_unit = "rad",
                      .input = {},
                      .channels = {}};
  for (const Shape& shape : shapes) {
    record.channels.push_back({shape.name, shape.unit, {}, {}, {}, {}});
  }
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise;
  double motion = 0.0;
  double bristle = 0.0;
  for (std::size_t row = 0; row < rows; ++row) {
    const double command = command_at(std::fmod(static_cast<double>(row) * period, 20.0));
    const double rate = 17.0 * (command - motion);
    motion += period * rate;
    const double sliding = std::copysign(0.002, rate);
    bristle = sliding + (bristle - sliding) * std::exp(-std::abs(rate) * period / 0.002);
    record.input.push_back(command);
    for (std::size_t index = 0; index < shapes.size(); ++index) {
      const Shape& shape = shapes[index];
      ReportChannel& channel = record.channels[index];
      const double truth = shape.gain * motion;
      channel.measured.push_back(truth + shape.noise * noise(generator));
      channel.declared.push_back(truth + shape.declared_error * (bristle / 0.002 + 0.2));
      channel.calibrated.push_back(truth + shape.calibrated_error * bristle / 0.002);
      channel.after.push_back(truth + 0.2 * shape.noise * std::sin(9.0 * static_cast<double>(row) * period));
    }
  }
  return record;
}

json errors(double rms, double fit) {
  return {{"rms", rms}, {"max", 3.1 * rms}, {"bias", -0.04 * rms}, {"fit_percent", fit}};
}

json channel_errors(const Shape& shape, const char* source) {
  return {{"unit", shape.unit},
          {"noise", shape.noise},
          {"noise_source", source},
          {"before", errors(shape.declared_error * 0.7, 71.3)},
          {"calibrated", errors(shape.calibrated_error * 0.7, 84.06)},
          {"after", errors(shape.noise * 1.02, 99.42)}};
}

json attempt(int round, const char* candidate, const char* law, double ratio, double bic, const char* decision,
             const char* reason) {
  json row{{"round", round},   {"candidate", candidate}, {"held_out_rms_ratio", ratio},
           {"delta_bic", bic}, {"seconds", 1.4},         {"decision", decision},
           {"reason", reason}};
  if (*law != '\0') {
    row["law"] = law;
  }
  return row;
}

json search() {
  return {attempt(1, "gimbal_friction", "lugre", 0.116, -41230.0, "kept", "lowest error on held-out data"),
          attempt(1, "gimbal_friction", "dahl", 0.141, -40418.0, "tied", "BIC 812 above lugre"),
          attempt(1, "piston_friction", "", 0.488, -32110.0, "dropped", "held-out error 4.2 times that of gimbal_friction"),
          attempt(1, "command_delay", "", 0.981, -40.0, "dropped", "explains 2 % of the error"),
          attempt(2, "soft_stiffness", "", 0.69, -2210.0, "kept", "lowest error on held-out data"),
          attempt(2, "backlash", "", 0.725, -1900.0, "dropped", "BIC 310 above soft_stiffness"),
          attempt(3, "valve_deadband", "", 1.002, 18.0, "dropped", "held-out error does not fall")};
}

json calibrated(double declared, double value, double half_width, double tolerance, const char* unit, bool pressed) {
  return {{"declared", declared},   {"value", value}, {"ci95", {value - half_width, value + half_width}},
          {"tolerance", tolerance}, {"unit", unit},   {"pressed", pressed}};
}

json frame(const char* verdict, const std::string& sentence) {
  return {{"schema", 1},
          {"hotfire", "0.1.0"},
          {"command_line", "hotfire explain --model declared.toml --out out steps.csv"},
          {"seconds", 41.7},
          {"model", "declared.toml"},
          {"verdict", verdict},
          {"sentence", sentence}};
}

}  // namespace

Sample explained_actuator() {
  const std::vector<Shape> shapes{{"piston", "m", 0.75, 8e-6, 1.9e-4, 1.2e-4},
                                  {"engine", "rad", 1.0, 2e-5, 9e-4, 6e-4},
                                  {"load_pressure", "Pa", 4e8, 9e3, 3.1e5, 2.8e5}};
  Sample sample;
  for (const char* name : {"steps.csv", "sweep.csv", "quiet.csv"}) {
    const auto seed = static_cast<unsigned>(sample.series.records.size());
    sample.series.records.push_back(record_of(name, shapes, 10'000, 0.002, seed));
  }
  sample.report = frame("explained",
                        "Missing in the declared model: friction in the gimbal bearing (LuGre, 12.0 kN\u00b7m) and a soft "
                        "actuator stiffness below 23 kN.");
  json& report = sample.report;
  report["name"] = "single-axis TVC actuator";
  for (const Shape& shape : shapes) {
    report["channels"][shape.name] = channel_errors(shape, shape.gain == 1.0 ? "estimated" : "declared");
  }
  for (const ReportRecord& record : sample.series.records) {
    report["records"].push_back({{"path", "data/" + record.name}, {"rows", record.input.size()}, {"period", record.period}});
    for (const auto& [from, to] : record.held_out) {
      report["held_out"].push_back(fmt::format("{}@{:.1f}-{:.1f}", record.name, from, to));
    }
  }
  report["warnings"] = {"servovalve.position_gain ended 2.6 tolerances from its declared value: check the declaration.",
                        "gimbal_friction.vibration_ratio is not determined by these records."};
  report["calibration"] = {{"servovalve.position_gain", calibrated(86.2, 92.9, 0.1, 0.03, "1/m", false)},
                           {"servovalve.rated_flow", calibrated(3.155e-3, 3.12e-3, 1.1e-5, 0.02, "m^3/s", false)},
                           {"actuator.bulk_modulus", calibrated(1.034e9, 0.72e9, 4e7, 0.1, "Pa", true)},
                           {"engine.inertia", calibrated(9490.0, 9512.0, 31.0, 0.01, "kg.m^2", false)}};
  report["effects"] = {friction(), soft_stiffness()};
  report["trace"] = {{"site", "engine_torque"},
                     {"points", reconstructed_points()},
                     {"text", "The missing torque follows the sign of the gimbal rate: 91 % of its variance."}};
  report["residual"] = {{"white", true},
                        {"unexplained_percent", 3.1},
                        {"next_experiment",
                         "slow triangles of 0.1, 0.2 and 0.4 deg at rest and at hot fire: they tell "
                         "vibration_ratio from coulomb_torque"}};
  for (const Shape& shape : shapes) {
    json& residual = report["residual"];
    residual["autocorrelation"][shape.name] = autocorrelation();
    residual["input_correlation"][shape.name] = input_correlation(shape.name != "load_pressure");
    residual["by_frequency"][shape.name] = by_frequency(shape.noise, shape.declared_error);
    residual["by_amplitude"][shape.name] = by_amplitude(shape.gain * 0.006, shape.noise, shape.declared_error);
  }
  report["identifiability"] = {
      {{"text",
        "gimbal_friction.vibration_ratio and coulomb_torque act alike in these records (correlation 0.998): only their "
        "product is known."}},
      {{"text", "actuator.bulk_modulus moves nothing that was measured by more than a tenth of the noise."}}};
  report["search"] = search();
  return sample;
}

Sample nothing_missing_mass() {
  Sample sample;
  sample.series.records.push_back(record_of("hammer.csv", {{"position", "", 1.0, 1e-4, 2e-5, 1e-5}}, 4'000, 0.005, 5));
  sample.series.records.front().channels.front().after.clear();
  sample.report = frame("nothing-missing", "");
  sample.report["channels"]["position"] = {{"unit", ""},
                                           {"noise", 1e-4},
                                           {"noise_source", "estimated"},
                                           {"before", errors(1.02e-4, 98.9)},
                                           {"calibrated", errors(1.005e-4, 99.0)}};
  sample.report["records"] = {{{"path", "hammer.csv"}, {"rows", 4000}, {"period", 0.005}}};
  sample.report["residual"] = {{"white", true}, {"unexplained_percent", nullptr}};
  sample.report["effects"] = json::array();
  return sample;
}

Sample hostile_long_records() {
  Sample sample;
  for (int index = 0; index < 10; ++index) {
    ReportRecord record = record_of(fmt::format("{}-{}.csv", kHostile, index), {{kHostile, kHostile, 1.0, 1e-4, 2e-3, 1e-3}},
                                    30'000, 0.001, static_cast<unsigned>(index));
    record.input_name = kHostile;
    record.input_unit = kHostile;
    sample.series.records.push_back(std::move(record));
  }
  sample.report = frame(kHostile, fmt::format("A sentence with {} in it.", kHostile));
  json& report = sample.report;
  report["name"] = kHostile;
  report["command_line"] = kHostile;
  report["channels"][kHostile] = channel_errors({kHostile, kHostile, 1.0, 1e-4, 2e-3, 1e-3}, kHostile);
  report["warnings"] = {kHostile};
  report["held_out"] = {kHostile};
  report["effects"] = {{{"name", kHostile},
                        {"site", kHostile},
                        {"law", kHostile},
                        {"meaning", kHostile},
                        {"parameters", {{kHostile, parameter(1.0, kHostile, 0.1, kHostile)}}},
                        {"alternatives", {{{"name", kHostile}}}},
                        {"curve",
                         {{"x_label", kHostile},
                          {"x_unit", kHostile},
                          {"y_label", kHostile},
                          {"y_unit", kHostile},
                          {"series", {{{"name", kHostile}, {"x", {0, 1}}, {"y", {1, 0}}}}}}}}};
  report["search"] = {attempt(1, kHostile, kHostile, 0.5, -1.0, kHostile, kHostile)};
  report["effects"][0]["parameters"][kHostile]["interval_from"] = kHostile;
  report["identifiability"] = {{{"text", kHostile}}};
  report["residual"] = {{"next_experiment", kHostile},
                        {"autocorrelation", {{kHostile, autocorrelation()}}},
                        {"input_correlation", {{kHostile, input_correlation(false)}}},
                        {"by_frequency", {{kHostile, by_frequency(0.0, 0.0)}}},
                        {"by_amplitude", {{kHostile, by_amplitude(1.0, 1e-4, 2e-3)}}}};
  return sample;
}

}  // namespace hotfire::test
