#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "model/string_potentiometer.hpp"
#include "tools/analysis/angle_calibration.hpp"
#include "tools/findings/one_axis.hpp"
#include "tools/findings/rows.hpp"
#include "tools/simulate/normal.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/trials/profiles.hpp"

namespace hotfire::findings {

namespace {

using Strings = model::StringPotentiometers<double>;
using Anchors = Strings::Anchors;

/// What of the test is not as it was assumed.
struct Disturbance {
  double placement = 0.0;  ///< each anchor is off by this in a direction of its own, after the calibration [m]
  double motion = 0.0;     ///< the structure moves by this at 8 Hz [m]
};

/// Two hot-fire axes on the ambient bearing: static poses, settled, and a dynamic test about both angles.
struct Test {
  std::vector<std::array<double, 2>> settled;
  Record dynamic;
};

Test test_of(const Sets& sets) {
  ModelFile hot = sets.hot_fire;
  const SimplexParameters& axis = axis_of(hot);
  TaosParameters parameters;
  for (auto& own : parameters.axes) {
    own.servovalve = axis.servovalve;
    own.actuator = axis.actuator;
    own.structure = axis.structure;
    own.engine = axis.engine;
  }
  VehicleFile vehicle;
  vehicle.parameters = parameters;
  Test test;
  for (const double pitch : {-2.0, 0.0, 2.0}) {
    for (const double yaw : {-2.0, 0.0, 2.0}) {
      test.settled.push_back({trials::radians(pitch), trials::radians(yaw)});
    }
  }
  Record command = trials::command_record(trials::multisine(trials::radians(1.0), 0.5, 4.0, 4.0, 1, 3), "command.pitch");
  command.channels.push_back({"command.yaw", "rad", trials::multisine(trials::radians(1.0), 0.5, 4.0, 4.0, 1, 5)});
  test.dynamic = simulate(vehicle, command);
  return test;
}

Anchors displaced(Anchors anchors, double distance) {
  // Directions that no two strings share.
  constexpr std::array<std::array<double, 3>, 4> kDirections{
      {{0.6, 0.8, 0.0}, {0.0, -0.6, 0.8}, {-0.8, 0.0, 0.6}, {0.6, -0.64, 0.48}}};
  for (std::size_t k = 0; k < anchors.size(); ++k) {
    anchors[k].vehicle_x += distance * kDirections[k][0];
    anchors[k].vehicle_y += distance * kDirections[k][1];
    anchors[k].vehicle_z += distance * kDirections[k][2];
  }
  return anchors;
}

/// Rms error of both angles over the dynamic test [rad].
double error_of(const Test& test, const Disturbance& disturbance) {
  const model::PotentiometerReadout<double> readout{2e-3, 2e-5, 1e-5};
  Normal draw(11);
  const Strings assumed(Strings::representative());
  std::vector<analysis::SettledAngles> settled;
  for (const auto& [pitch, yaw] : test.settled) {
    // Settled: the lag has died out, and noise is averaged away.
    settled.push_back({assumed.lengths(pitch, yaw, {0.0, 0.0, 0.0}), pitch, yaw});
  }
  const analysis::AngleCalibration calibration(settled);
  const Strings real(displaced(Strings::representative(), disturbance.placement));
  const std::vector<double>& pitch = test.dynamic.find("engine.pitch")->values;
  const std::vector<double>& yaw = test.dynamic.find("engine.yaw")->values;
  std::array<model::PotentiometerReadout<double>::State, 4> held;
  const std::array<double, 4> start = real.lengths(pitch[0], yaw[0], {0.0, 0.0, 0.0});
  for (std::size_t k = 0; k < held.size(); ++k) {
    model::PotentiometerReadout<double>::settle(held[k], start[k]);
  }
  double sum = 0.0;
  for (std::size_t row = 0; row < pitch.size(); ++row) {
    const double swing =
        disturbance.motion * std::sin(2.0 * std::numbers::pi * 8.0 * static_cast<double>(row) * test.dynamic.period);
    const std::array<double, 4> lengths = real.lengths(pitch[row], yaw[row], {swing, 0.5 * swing, 0.7 * swing});
    std::array<double, 4> readings{};
    for (std::size_t k = 0; k < readings.size(); ++k) {
      readings[k] = readout.read(held[k], lengths[k], draw(), test.dynamic.period);
    }
    const auto [own_pitch, own_yaw] = calibration.angles(readings);
    sum += (own_pitch - pitch[row]) * (own_pitch - pitch[row]) + (own_yaw - yaw[row]) * (own_yaw - yaw[row]);
  }
  return std::sqrt(sum / (2.0 * static_cast<double>(pitch.size())));
}

}  // namespace

Outcome string_potentiometers(const Sets& sets) {
  const Test test = test_of(sets);
  const auto error = [&](const Disturbance& disturbance) { return 1e3 * trials::degrees(error_of(test, disturbance)); };
  Outcome outcome;
  double before = error({});
  outcome.figures.push_back({"error of both angles, strings where they are assumed", before, 0.0, 20.0, "mdeg rms"});
  analysis::Curve placement{"placement error [cm]", {0.0}, {before}};
  double grows = 1.0;
  for (const double distance : {0.02, 0.05, 0.1}) {
    const double own = error({distance, 0.0});
    outcome.figures.push_back({fmt::format("error with anchors {:g} mm off", 1e3 * distance), own, before, 1e3, "mdeg rms"});
    grows = own > before ? grows : 0.0;
    before = own;
    placement.x.push_back(100.0 * distance);
    placement.y.push_back(own);
  }
  before = error({});
  analysis::Curve motion{"structure motion [mm]", {0.0}, {before}};
  for (const double size : {0.5e-3, 1e-3, 2e-3}) {
    const double own = error({0.0, size});
    outcome.figures.push_back(
        {fmt::format("error while the structure moves by {:g} mm", 1e3 * size), own, before, 1e3, "mdeg rms"});
    grows = own > before ? grows : 0.0;
    before = own;
    motion.x.push_back(1e3 * size);
    motion.y.push_back(own);
  }
  outcome.figures.push_back({"grows with both (1: yes)", grows, 1.0, 1.0, ""});
  outcome.picture = {"F13: error of the angles from four strings",
                     "placement error [cm], structure motion [mm]",
                     false,
                     {{"error [mdeg rms]", {placement, motion}}}};
  outcome.note =
      "Nine settled poses of up to 2 deg about both angles give the affine fit; then a test of 1 deg, 0.5 to 4 Hz, about "
      "both. "
      "Lag 2 ms, noise 20 um, quantisation 10 um. Placement: the anchors are off after the calibration, each in its own "
      "direction; "
      "motion: the anchors swing at 8 Hz.";
  return outcome;
}

}  // namespace hotfire::findings
