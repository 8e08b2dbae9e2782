// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <type_traits>

#include "model/effects/load/soft_stiffness.hpp"
#include "model/keys.hpp"
#include "tools/analysis/free_decay.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/trials/disturbed.hpp"
#include "tools/trials/fine_sweep.hpp"
#include "tools/trials/profiles.hpp"
#include "tools/trials/stiffness.hpp"
#include "tools/trials/string_angles.hpp"
#include "tools/trials/sweep.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::trials {
namespace {

/// The linear axis with its reference values.
ModelFile linear() {
  ModelFile model;
  model.parameters = SimplexParameters{};
  return model;
}

/// Frequency of the engine's pendulum on a locked actuator [SD eq. 10], and of the piston's zeros.
double pendulum(const SimplexParameters& p) {
  const double total = 1.0 / (1.0 / p.actuator.stiffness + 1.0 / p.structure.stiffness);
  return std::sqrt((p.engine.duct_stiffness + total * p.actuator.moment_arm * p.actuator.moment_arm) / p.engine.inertia) /
         (2.0 * std::numbers::pi);
}

}  // namespace

TEST_GROUP(Trials){};

TEST(Trials, SinesAndMultisineGiveTheSameResponseOfALinearAxis) {
  const ModelFile model = linear();
  const SweepGoal goal{.moment_arm = moment_arm_of(model)};
  // Small enough for the root of the flow law, whose share falls with the load pressure.
  const auto by_sines =
      analyse_sweep(simulate(model, command_record(stepped_sines({{1e-5, {1.0, 2.0, 4.0, 6.0, 9.0}}}))), goal);
  const auto broadband = analyse_sweep(simulate(model, command_record(multisine(1e-4, 0.5, 14.0, 8.0, 6, 2))), goal);
  LONGS_EQUAL(2, by_sines.size());
  LONGS_EQUAL(2, broadband.size());
  for (std::size_t channel = 0; channel < 2; ++channel) {
    for (const auto& sine : by_sines[channel].response) {
      for (const auto& point : broadband[channel].response) {
        if (std::abs(point.frequency - sine.frequency) < 0.01) {
          // Hann's window reaches two bins of 1/8 Hz to either side, over which the response bends.
          CHECK_TRUE(std::abs(point.gain - sine.gain) < 0.03 * std::abs(sine.gain));
          CHECK_TRUE(point.coherence > 0.99);
        }
      }
    }
  }
}

TEST(Trials, ARecordedTestIsAnalysedAsASimulatedOne) {
  const ModelFile model = linear();
  Record record = simulate(model, command_record(stepped_sines({{1e-3, spaced(6.0, 10.0, 25)}})));
  const SweepGoal goal{.moment_arm = moment_arm_of(model)};
  const auto simulated = analyse_sweep(record, goal);
  for (Channel& channel : record.channels) {
    channel.name += ".pitch";
  }
  SweepGoal pitch = goal;
  pitch.axis = "pitch";
  const auto recorded = analyse_sweep(record, pitch);
  DOUBLES_EQUAL(simulated[0].notch->frequency, recorded[0].notch->frequency, 0.0);
  CHECK_THROWS(FileError, analyse_sweep(record, goal));
}

TEST(Trials, TheStiffnessFromTheNotchOfLinearSpringsIsThatOfTheSpringsThatWerePutIn) {
  ModelFile model = linear();
  const auto& axis = std::get<SimplexParameters>(model.parameters);
  const LoadSpring spring = load_spring_of(model);
  DOUBLES_EQUAL(pendulum(axis), asymptote(spring), 1e-9);
  const SweepGoal goal{.moment_arm = moment_arm_of(model), .lowest = 6.0, .highest = 11.0};
  const Record record = simulate(model, command_record(stepped_sines({{radians(0.02), spaced(6.0, 11.0, 60)}})));
  const std::vector<SineStiffness> found = sine_stiffnesses(analyse_sweep(record, goal), spring);
  LONGS_EQUAL(1, found.size());
  const ResonanceStiffness& test = *found[0].test;
  // The engine's damping, which eq. 2 leaves out, is 1.3 % of critical: it moves the zeros by 0.01 %. The grid is 1 % wide
  // and the vertex through three of its points is the notch within a tenth of that, F1 allows half: twice as much of the
  // total, and 1 / (1 - K_T / K_L), 3.1 times that, of the actuator's.
  const double total = 1.2e8 * 5.75e7 / (1.2e8 + 5.75e7);
  DOUBLES_EQUAL(total, test.total, 2.2e-3 * total);
  DOUBLES_EQUAL(1.2e8, test.actuator, 7e-3 * 1.2e8);
  const double w = 2.0 * std::numbers::pi * pendulum(axis);
  const double force = axis.engine.inertia * radians(0.02) * w * w / axis.actuator.moment_arm;
  DOUBLES_EQUAL(force, test.peak_force, 2.2e-3 * force);
  // A linear spring stores what a spring of its own stiffness does.
  DOUBLES_EQUAL(1.2e8, found[0].expected.actuator, 1e-6 * 1.2e8);
}

TEST(Trials, TheStiffnessOfASoftActuatorRisesWithTheAmplitudeToThatUnderALargeLoad) {
  ModelFile model = linear();
  auto& axis = std::get<SimplexParameters>(model.parameters);
  model::visit_effects(axis, [&]<class E>(std::size_t index, auto& law) {
    if constexpr (std::is_same_v<E, model::SoftStiffness>) {
      axis.effects.active[index] = true;
      law.option = static_cast<int>(E::Law::table);
      law.table.points = 2;
      law.table.x = {0.0, 2e4};
      law.table.y = {4e7, 1.6e8};
    }
  });
  const LoadSpring spring = load_spring_of(model);
  DOUBLES_EQUAL(1.6e8, spring.loaded, 0.0);
  // Up to the second load the curve is a straight line of the mean compliance, and a small swing stays on it.
  const double straight = 2.0 / (1.0 / 4e7 + 1.0 / 1.6e8);
  DOUBLES_EQUAL(straight, expected_stiffness(spring, 0.0).actuator, 1e-6 * straight);
  double before = 0.999 * straight;
  for (const double amplitude : {1e-4, 1e-2, 1.0, 100.0}) {
    const ResonanceStiffness expected = expected_stiffness(spring, amplitude);
    CHECK_TRUE(expected.actuator > before && expected.frequency < asymptote(spring));
    before = expected.actuator;
  }
  // The soft stretch gives way by 2e4 N (1 / straight - 1 / 1.6e8) = 0.19 mm more, and the last force of 3 GN takes 20 m.
  DOUBLES_EQUAL(1.6e8, before, 1e-4 * 1.6e8);
}

TEST(Trials, TheLoadSpringOfAVehicleWithoutItsThrustIsThatOfTheUnloadedStructure) {
  VehicleFile vehicle;
  TaosParameters parameters;
  parameters.gimbals[0].bearing.thrust = parameters.gimbals[0].bearing.rated_thrust = 1.86e6;
  parameters.gimbals[0].bearing.unloaded_structure = 0.4;
  vehicle.parameters = parameters;
  const double stiffness = parameters.axes[0].structure.stiffness;
  DOUBLES_EQUAL(stiffness, load_spring_of(vehicle, "pitch").load.load_stiffness, 1e-9 * stiffness);
  DOUBLES_EQUAL(0.4 * stiffness, load_spring_of(with_thrust(vehicle, 0.0), "pitch").load.load_stiffness, 1e-9 * stiffness);
}

TEST(Trials, TheLoadSpringOfAVehicleHasTheModesOfItsAttachPointInSeries) {
  VehicleFile vehicle;
  TaosParameters parameters;
  parameters.modes.modes = 1;
  parameters.modes.frequency[0] = 2.0;
  parameters.modes.shape(1, 0) = 1e-3;
  parameters.modes.residual(1, 1) = 2e-9;
  vehicle.parameters = parameters;
  const double local = parameters.axes[1].structure.stiffness;
  const double w = 4.0 * std::numbers::pi;
  const LoadSpring yaw = load_spring_of(vehicle, "yaw");
  DOUBLES_EQUAL(1.0 / (1.0 / local + 1e-6 / (w * w) + 2e-9), yaw.load.load_stiffness, 1e-9 * local);
  DOUBLES_EQUAL(local, load_spring_of(vehicle, "pitch").load.load_stiffness, 1e-9 * local);
  DOUBLES_EQUAL(moment_arm_of(vehicle, "yaw"), yaw.load.moment_arm, 0.0);
  CHECK_THROWS(UsageError, load_spring_of(vehicle, "yaw2"));
  ModelFile mass;
  mass.parameters = DirectParameters{};
  CHECK_THROWS(FileError, load_spring_of(mass));
}

TEST(Trials, TheHammerFindsThePendulumOfALockedActuator) {
  const ModelFile model = linear();
  const Record record = hammer(model, {});
  const auto decay = analysis::free_decay(record.find("engine")->values, record.period, 4.0);
  DOUBLES_EQUAL(pendulum(std::get<SimplexParameters>(model.parameters)), decay->frequency, 2e-3 * decay->frequency);
  double piston = 0.0;
  double engine = 0.0;
  for (std::size_t row = 0; row < record.rows; ++row) {
    piston = std::max(piston, std::abs(record.find("piston")->values[row]));
    engine = std::max(engine, std::abs(record.find("engine")->values[row]));
  }
  // Locked: the spring's deflection is the engine's motion at its arm.
  CHECK_TRUE(piston < 2e-3 * 0.7544 * engine);
}

TEST(Trials, AMassIsHitAsItIs) {
  ModelFile model;
  DirectParameters direct;
  direct.mass = {2.0, 0.4, 200.0};
  model.parameters = direct;
  const Record record = hammer(model, {1.0, 8.0});
  const auto decay = analysis::free_decay(record.find("position")->values, record.period, 8.0);
  DOUBLES_EQUAL(10.0 / (2.0 * std::numbers::pi), decay->frequency, 1e-3);
  DOUBLES_EQUAL(0.01, decay->damping_ratio, 5e-4);
}

TEST(Trials, AQuiescentAxisIsTheSameForTheSameSeedAndStillWithoutTorque) {
  Quiescence ambient{100.0, 2.0, 7};
  const Record one = quiescent(linear(), ambient);
  CHECK_TRUE(one.find("piston")->values == quiescent(linear(), ambient).find("piston")->values);
  ambient.seed = 8;
  CHECK_FALSE(one.find("piston")->values == quiescent(linear(), ambient).find("piston")->values);
  ambient.torque_density = 0.0;
  for (const double value : quiescent(linear(), ambient).find("engine")->values) {
    DOUBLES_EQUAL(0.0, value, 1e-12);
  }
}

// Straight arms and no modes: each axis of the vehicle is the single axis.
TEST(Trials, TheHammerFindsThePendulumOfEveryAxisOfAVehicle) {
  VehicleFile vehicle;
  MasvParameters parameters;
  parameters.axes[5].structure.stiffness = 9e7;
  vehicle.parameters = parameters;
  for (const std::string axis : {"pitch1", "yaw3"}) {
    SimplexParameters single;
    single.structure = parameters.axes[axis == "yaw3" ? 5 : 0].structure;
    const Record record = hammer(vehicle, axis, {.impulse = 20.0, .seconds = 2.0});
    const auto decay = analysis::free_decay(record.find("engine." + axis)->values, record.period, 2.0);
    DOUBLES_EQUAL(pendulum(single), decay->frequency, 2e-3 * decay->frequency);
    DOUBLES_EQUAL(0.0, record.find("engine.pitch2")->values.back(), 1e-9);
  }
  CHECK_THROWS(UsageError, hammer(vehicle, "pitch5", {}));
}

TEST(Trials, AQuiescentVehicleMovesOnAllAxesAndIsTheSameForTheSameSeed) {
  VehicleFile vehicle;
  vehicle.parameters = TaosParameters{};
  const Quiescence ambient{100.0, 2.0, 7};
  const Record one = quiescent(vehicle, "pitch", ambient);
  CHECK_TRUE(one.find("piston.yaw")->values == quiescent(vehicle, "yaw", ambient).find("piston.yaw")->values);
  CHECK_FALSE(one.find("piston.yaw")->values == one.find("piston.pitch")->values);
  const auto rms = [](const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) {
      sum += value * value;
    }
    return std::sqrt(sum);
  };
  // Of one strength on both: two seconds of a lightly damped axis vary by less than a factor of three.
  const double ratio = rms(one.find("engine.yaw")->values) / rms(one.find("engine.pitch")->values);
  CHECK_TRUE(ratio > 1.0 / 3.0 && ratio < 3.0);
  CHECK_THROWS(UsageError, quiescent(vehicle, "yaw2", ambient));
}

TEST(Trials, StringsGiveTheAnglesThatTheirSettledPosesTaught) {
  VehicleFile vehicle;
  vehicle.parameters = TaosParameters{};
  vehicle.sensors.strings = {VehicleSensors::Strings::representative()};
  Record poses = command_record({}, "command.pitch");
  poses.channels.push_back({"command.yaw", "rad", {}});
  for (const double pitch : {-0.02, 0.0, 0.02}) {
    for (const double yaw : {-0.02, 0.0, 0.02}) {
      poses.channels[0].values.insert(poses.channels[0].values.end(), 3000, pitch);
      poses.channels[1].values.insert(poses.channels[1].values.end(), 3000, yaw);
    }
  }
  poses.rows = poses.channels[0].values.size();
  const auto settled = settled_poses(simulate(vehicle, poses), "", 2.0);
  LONGS_EQUAL(9, settled.size());
  DOUBLES_EQUAL(-0.02, settled[0].yaw, 0.0);
  LONGS_EQUAL(0, settled_poses(simulate(vehicle, poses), "", 3.5).size());
  const analysis::AngleCalibration calibration(settled);
  const Record test = simulate(vehicle, command_record(multisine(0.01, 0.5, 2.0, 2.0, 2, 4), "command.pitch"));
  const StringAngles angles = string_angles(test, calibration, "");
  CHECK_TRUE(angles.known);
  // Calibrated on commands, which the engine misses by what its ducts take from the load spring: K_n / (K_T R^2), 2 %.
  CHECK_TRUE(angles.pitch < 0.02 * 0.01);
  CHECK_TRUE(angles.yaw < 1e-4);
  CHECK_THROWS(FileError, settled_poses(test, "2", 2.0));
}

TEST(Trials, TheGreenRunProfileIsThatOfThePaperInEitherOrder) {
  const std::vector<SineBand> pitch = green_run_sines();
  const std::vector<SineBand> yaw = green_run_sines(true);
  DOUBLES_EQUAL(radians(0.8), pitch[0].amplitude, 1e-12);
  DOUBLES_EQUAL(7.0, pitch[0].frequencies.front(), 1e-9);
  DOUBLES_EQUAL(14.0, pitch[0].frequencies.back(), 1e-9);
  DOUBLES_EQUAL(radians(0.4), yaw[0].amplitude, 1e-12);
  DOUBLES_EQUAL(0.4, yaw[0].frequencies.front(), 1e-9);
  DOUBLES_EQUAL(6.25, yaw[0].frequencies.back(), 1e-9);
}

// Half of a percent of damping: on 40 frequencies the notch lies between two of them, and two seconds leave it ringing. The
// servo damps what is free to move, so that an engine of a tenth of that and one without damping are settled as well.
TEST(Trials, AFineGridThatIsHeldUntilItSettlesFindsANotchToATenthOfAPercent) {
  for (const double ratio : {0.005, 0.0}) {
    ModelFile model = linear();
    auto& axis = std::get<SimplexParameters>(model.parameters);
    const double zero = pendulum(axis);
    axis.engine.viscous_damping = 2.0 * ratio * axis.engine.inertia * 2.0 * std::numbers::pi * zero;
    SweepGoal goal{.moment_arm = moment_arm_of(model)};
    // The frequencies of a sweep by default.
    const std::vector<SineBand> bands{{1e-5, spaced(0.4, 14.0, 40)}};
    const auto coarse = analyse_sweep(simulate(model, command_record(stepped_sines(bands))), goal);
    CHECK_TRUE(std::abs(coarse.front().notch->frequency - zero) > 2e-3 * zero);
    const double notch = coarse.front().notch->frequency;
    const std::vector<SineBand> near{{1e-5, {notch}}};
    const auto fine = analyse_sweep(simulate(model, command_record(fine_sines(near, coarse, settled_dwell(model)))), goal);
    DOUBLES_EQUAL(zero, fine.front().notch->frequency, 1e-3 * zero);
  }
}

namespace {

/// One engine and one mode of 3.2 Hz, each of half a percent, and the mode's zero in the piston: with the pistons locked,
/// the engine on its spring and the mode move as two masses, the spring between them.
struct EngineOnAMode {
  VehicleFile vehicle;
  double zero = 0.0;  ///< [Hz]
};

EngineOnAMode engine_on_a_mode() {
  constexpr double kRatio = 0.002;
  TaosParameters parameters;
  auto& axis = parameters.axes[0];
  parameters.modes.modes = 1;
  parameters.modes.frequency[0] = 3.2;
  parameters.modes.damping_ratio[0] = kRatio;
  const double w = 2.0 * std::numbers::pi * 3.2;
  const double spring = 1.0 / (1.0 / axis.actuator.stiffness + 1.0 / axis.structure.stiffness);
  const double flexibility = 0.3 / spring;
  parameters.modes.shape(0, 0) = w * std::sqrt(flexibility);
  axis.engine.viscous_damping = 2.0 * kRatio * axis.engine.inertia * 2.0 * std::numbers::pi * 8.0;
  EngineOnAMode own;
  own.vehicle.parameters = parameters;
  const double arm = moment_arm_of(own.vehicle, "pitch");
  const double engine = (axis.engine.duct_stiffness + spring * arm * arm) / axis.engine.inertia;
  const double mode = w * w * (1.0 + 0.3);
  const double between = spring * arm / std::sqrt(axis.engine.inertia) * parameters.modes.shape(0, 0);
  const double mean = 0.5 * (engine + mode);
  own.zero = std::sqrt(mean - std::hypot(0.5 * (engine - mode), between)) / (2.0 * std::numbers::pi);
  return own;
}

}  // namespace

TEST(Trials, ASineBesideALightlyDampedModeIsHeldUntilTheModeHasSettled) {
  const EngineOnAMode own = engine_on_a_mode();
  const LeastDwell dwell = settled_dwell(own.vehicle, 1.0, 14.0);
  const SweepGoal goal{.axis = "pitch", .moment_arm = moment_arm_of(own.vehicle, "pitch"), .lowest = 1.5, .highest = 5.0};
  const auto piston = [&](const auto& held) {
    // A part of the fine grid, which the zero is not on.
    const std::vector<double> frequencies = spaced(0.996 * own.zero, 1.006 * own.zero, 5);
    return analyse_sweep(simulate(own.vehicle, command_record(stepped_sines({{1e-5, frequencies}}, held), "command.pitch")),
                         goal)
        .front();
  };
  const ChannelSweep settled = piston(dwell);
  DOUBLES_EQUAL(own.zero, settled.notch->frequency, 1e-3 * own.zero);
  const ChannelSweep longer = piston([&](double frequency) { return 1.5 * dwell(frequency); });
  const auto change = [&](const ChannelSweep& sweep) {
    double largest = 0.0;
    for (std::size_t k = 0; k < sweep.response.size(); ++k) {
      largest = std::max(largest, std::abs(sweep.response[k].gain / longer.response[k].gain - 1.0));
    }
    return largest;
  };
  CHECK_TRUE(change(settled) < 1e-3);
  CHECK_TRUE(change(piston(40.0)) > 1e-2);
}

TEST(Trials, EveryFrequencyOfAFineSweepIsHeldForItsDwell) {
  const std::vector<SineBand> bands{{1e-3, spaced(1.0, 8.0, 5)}};
  const std::vector<ChannelSweep> coarse{{"piston", 1e-3, {}, analysis::Notch{4.0, -20.0, 10.0}, {}}};
  const LeastDwell dwell = [](double frequency) { return 3.0 * frequency; };
  const auto dwells = analysis::find_dwells(fine_sines(bands, coarse, dwell), kPeriod);
  CHECK_TRUE(dwells.size() > 50);
  for (const analysis::Dwell& own : dwells) {
    // Where one dwell ends and the next begins is known to a period.
    CHECK_TRUE(static_cast<double>(own.rows) * kPeriod > dwell(own.frequency) - 2.0 / own.frequency);
  }
}

TEST(Trials, TheDwellIsTwiceTheSettlingTimeOfTheEngineAndOfAModeAtItsFrequency) {
  ModelFile model = linear();
  auto& engine = std::get<SimplexParameters>(model.parameters).engine;
  engine = {1.0, 2.0, 0.0};
  DOUBLES_EQUAL(2.0 * std::log(1000.0), settled_dwell(model)(3.0), 1e-4);
  engine.viscous_damping = 1e-3;
  DOUBLES_EQUAL(kLongestEngineDwell, settled_dwell(model)(3.0), 0.0);
  engine.viscous_damping = 1e3;
  DOUBLES_EQUAL(kShortestDwell, settled_dwell(model)(3.0), 0.0);
  VehicleFile vehicle;
  TaosParameters parameters;
  parameters.modes.modes = 2;
  parameters.modes.frequency = {5.0, 30.0};
  parameters.modes.damping_ratio = {0.005, 0.0001};
  vehicle.parameters = parameters;
  const LeastDwell dwell = settled_dwell(vehicle, 1.0, 20.0);
  const double rate = 2.0 * std::numbers::pi * 5.0 * 0.005;
  DOUBLES_EQUAL(2.0 * std::log(1000.0) / rate, dwell(5.0), 1e-3);
  for (const double frequency : {4.0, 4.9, 5.5, 8.0}) {
    // In half of the dwell the mode's share of the fit is a thousandth, at the engine's 11 s or later.
    const double half = 0.5 * dwell(frequency);
    const double share = std::exp(-rate * half) / std::max(1.0, std::numbers::pi * half * std::abs(frequency - 5.0));
    CHECK_TRUE(share < 1.0001e-3);
    CHECK_TRUE(half < 11.0 || share > 0.999e-3);
  }
  // Half a percent settles down to where a sweep begins, without damping it never does.
  parameters.modes.frequency[0] = 0.4;
  vehicle.parameters = parameters;
  CHECK_TRUE(settled_dwell(vehicle, 0.4, 14.0)(0.4) < 0.95 * kLongestDwell);
  parameters.modes.damping_ratio[0] = 0.0;
  vehicle.parameters = parameters;
  DOUBLES_EQUAL(kLongestDwell, settled_dwell(vehicle, 0.4, 14.0)(0.4), 0.0);
}

}  // namespace hotfire::trials
