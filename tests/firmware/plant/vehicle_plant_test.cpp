// SPDX-License-Identifier: Apache-2.0
#include "firmware/plant/vehicle_plant.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cmath>
#include <memory>

#include "firmware/loop/loop.hpp"
#include "hal/arithmetic/denormals.hpp"
#include "hal/sim/manual_clock.hpp"
#include "hal/sim/plant_bus.hpp"
#include "tests/model/support/vehicles.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::firmware {

namespace {

using test::Masv;
using test::Taos;
using Rows = std::vector<std::vector<double>>;

constexpr double kVehiclePlantPeriod = 1e-3;
constexpr std::int64_t kPeriodNs = 1'000'000;
constexpr std::size_t kChannels = Masv::kChannels;

/// Four engines on 20 modes that carry the anchors of the strings too, at hot fire.
std::unique_ptr<model::InstrumentedVehicle<Masv>> hot_masv() {
  auto rig = std::make_unique<model::InstrumentedVehicle<Masv>>();
  rig->vehicle = test::hot_fire<Masv>();
  rig->vehicle.modes = test::random_modes<Masv::Modes>(20, 5e-9, 7);
  rig->sensors.piston.lag = 2e-3;
  rig->sensors.piston.noise = 1e-5;
  rig->sensors.string_shape.topRows(Masv::kPorts) = 0.1 * rig->vehicle.modes.shape;
  return rig;
}

using MasvLoop = Loop<VehiclePlant<Masv>, hal::sim::SimulatedPlantBus, hal::sim::ManualClock>;

/// What a plant of one hot engine sends in every cycle while its two actuators are under sines of their own.
Rows played(const std::vector<PlayedFault>& faults) {
  model::InstrumentedVehicle<Taos> rig;
  rig.vehicle = test::hot_fire<Taos>();
  const auto plant = std::make_unique<VehiclePlant<Taos>>(rig, kVehiclePlantPeriod, faults);
  Rows rows;
  hal::Command command;
  for (int cycle = 0; cycle < 400; ++cycle) {
    command.values[0] = 0.02 * std::sin(20.0 * cycle * kVehiclePlantPeriod);
    command.values[1] = 0.015 * std::sin(31.0 * cycle * kVehiclePlantPeriod);
    plant->step(command);
    rows.emplace_back(plant->measured().begin(), plant->measured().end());
  }
  return rows;
}

/// An engine whose friction is mu N r, and whose structure and trim follow the thrust.
model::InstrumentedVehicle<Taos> followed_thrust() {
  model::InstrumentedVehicle<Taos> rig;
  rig.vehicle = test::hot_fire<Taos>();
  auto& gimbal = rig.vehicle.gimbals[0];
  gimbal.bearing.rated_thrust = gimbal.bearing.thrust;
  gimbal.bearing.dead_load = -3.4e4;
  gimbal.bearing.unloaded_structure = 0.4;
  gimbal.bearing.pitch_misalignment = 3e-3;
  gimbal.friction.coulomb_torque = 0.0;
  gimbal.friction.coefficient = 0.08;
  return rig;
}

/// The first cycle in which any of some readings differs; the number of cycles if none does.
std::size_t first_difference(const Rows& one, const Rows& other, std::size_t from, std::size_t to) {
  std::size_t cycle = 0;
  for (; cycle < one.size(); ++cycle) {
    for (std::size_t i = from; i < to; ++i) {
      if (one[cycle][i] != other[cycle][i]) {
        return cycle;
      }
    }
  }
  return cycle;
}

}  // namespace

TEST_GROUP(VehiclePlant){};

TEST(VehiclePlant, LoopGivesTheBitsOfOfflineStepping) {
  constexpr std::uint64_t kCycles = 1000;
  const hal::sim::CommandSource source{hal::sim::CommandSource::Shape::steps, 0.01, 1.2};
  const hal::FlushDenormals flush;
  const auto rig = hot_masv();
  const auto plant = std::make_unique<VehiclePlant<Masv>>(*rig, kVehiclePlantPeriod);
  hal::sim::SimulatedPlantBus bus(source, kVehiclePlantPeriod);
  hal::sim::ManualClock clock;
  const auto loop =
      std::make_unique<MasvLoop>(*plant, bus, clock, LoopSettings{kPeriodNs, kCycles - 50, 50, OverrunPolicy::catch_up});
  loop->run(false, [&]() noexcept { clock.delay_next_wake_up_ns(3 * kPeriodNs); });

  const auto vehicle = std::make_unique<Masv>(rig->vehicle, kVehiclePlantPeriod / 2);
  const auto state = std::make_unique<Masv::State>(vehicle->steady({}));
  Masv::Inputs inputs;
  for (std::uint64_t cycle = 0; cycle < kCycles; ++cycle) {
    inputs.commands.fill(source.at(static_cast<double>(cycle) * kVehiclePlantPeriod));
    vehicle->step(*state, inputs);
    vehicle->step(*state, inputs);
  }
  // A piston is read through its potentiometer; the other channels are the vehicle's own.
  for (std::size_t i = 0; i < state->measured.size(); ++i) {
    if (i % kChannels != 0) {
      DOUBLES_EQUAL(state->measured[i], plant->measured()[i], 0.0);
    }
  }
  CHECK(std::abs(plant->measured()[1]) > 1e-4);
}

TEST(VehiclePlant, CyclesOfFourEnginesWithModesStringsAndFaultsAllocateNothing) {
  std::vector<PlayedFault> faults;
  for (const PlayedKind kind : {PlayedKind::stuck, PlayedKind::biased, PlayedKind::noisy, PlayedKind::dropped,
                                PlayedKind::delayed, PlayedKind::leak, PlayedKind::torque, PlayedKind::thrust}) {
    faults.push_back({kind, 0.1, 0.3, 0, 0, 1e-9});
  }
  const auto plant = std::make_unique<VehiclePlant<Masv>>(*hot_masv(), kVehiclePlantPeriod, faults);
  plant->string_up();
  hal::sim::SimulatedPlantBus bus({}, kVehiclePlantPeriod);
  hal::sim::ManualClock clock;
  const auto loop =
      std::make_unique<MasvLoop>(*plant, bus, clock, LoopSettings{kPeriodNs, 1000, 0, OverrunPolicy::catch_up});
  const test::AllocationGuard guard;
  loop->run(false, []() noexcept {});
  UNSIGNED_LONGS_EQUAL(0, guard.allocations());
  UNSIGNED_LONGS_EQUAL(0, guard.releases());
  UNSIGNED_LONGS_EQUAL(1000, loop->result().account.cycles());
}

TEST(VehiclePlant, ActuatorsAreTheAxesInTheirOrder) {
  const auto plant =
      std::make_unique<VehiclePlant<Masv>>(*std::make_unique<model::InstrumentedVehicle<Masv>>(), kVehiclePlantPeriod);
  UNSIGNED_LONGS_EQUAL(8, plant->actuators());
  UNSIGNED_LONGS_EQUAL(8 * kChannels, plant->measured().size());
  hal::Command command;
  command.values[5] = 0.02;  // yaw of engine 3
  for (int cycle = 0; cycle < 500; ++cycle) {
    plant->step(command);
  }
  for (std::size_t actuator = 0; actuator < plant->actuators(); ++actuator) {
    const double angle = plant->measured()[actuator * kChannels + 1];
    CHECK_EQUAL(actuator == 5, std::abs(angle) > 0.01);
  }
}

TEST(VehiclePlant, StringsReadAnglesBearingAndStructureAndChangeNoBitOfTheRest) {
  const auto rig = hot_masv();
  const auto plain = std::make_unique<VehiclePlant<Masv>>(*rig, kVehiclePlantPeriod);
  const auto stringed = std::make_unique<VehiclePlant<Masv>>(*rig, kVehiclePlantPeriod);
  rig->sensors.string_shape.setZero();
  const auto still = std::make_unique<VehiclePlant<Masv>>(*rig, kVehiclePlantPeriod);
  stringed->string_up();
  still->string_up();
  UNSIGNED_LONGS_EQUAL(0, plain->strings().size());
  UNSIGNED_LONGS_EQUAL(hal::kMaxStrings, stringed->strings().size());
  hal::Command command;
  command.values = {0.02, -0.01, 0.015};
  for (int cycle = 0; cycle < 300; ++cycle) {
    plain->step(command);
    stringed->step(command);
    still->step(command);
  }
  hal::Fnv1a one;
  hal::Fnv1a other;
  plain->add_to(one);
  stringed->add_to(other);
  CHECK(one.value() == other.value());
  // The bearing gives way to the thrust by a millimetre or so, and the modes carry the anchors.
  const model::StringPotentiometers<double> geometry(model::StringPotentiometers<double>::representative());
  const std::span<const double> read = plain->measured();
  const auto turned = geometry.lengths(read[1], read[kChannels + 1], {0.0, 0.0, 0.0});
  CHECK(std::abs(turned[0]) > 1e-3);
  for (std::size_t i = 0; i < turned.size(); ++i) {
    DOUBLES_EQUAL(turned[i], still->strings()[i], 2e-3);
    CHECK(turned[i] != still->strings()[i]);
    CHECK(still->strings()[i] != stringed->strings()[i]);
  }
}

TEST(VehiclePlant, FaultsOfSensorsAreOnTheirReadingAndNowhereElse) {
  const Rows healthy = played({});
  const Rows stuck = played({{PlayedKind::stuck, 0.1, 0.25, 2, 0}});
  UNSIGNED_LONGS_EQUAL(100, first_difference(healthy, stuck, kChannels, kChannels + 1));
  DOUBLES_EQUAL(healthy[99][kChannels], stuck[249][kChannels], 0.0);
  DOUBLES_EQUAL(healthy[250][kChannels], stuck[250][kChannels], 0.0);
  UNSIGNED_LONGS_EQUAL(healthy.size(), first_difference(healthy, stuck, 0, kChannels));
  UNSIGNED_LONGS_EQUAL(healthy.size(), first_difference(healthy, stuck, kChannels + 1, 2 * kChannels));
}

TEST(VehiclePlant, FaultsOfActuatorsThatOverlapActTogetherAndEachInItsTime) {
  const PlayedFault leak{PlayedKind::leak, 0.1, 0.3, 1, 0, 1e-8};
  const PlayedFault loss{PlayedKind::lost_supply, 0.2, 0.35, 2, 0, 4e5};
  const Rows healthy = played({});
  const Rows leaking = played({leak});
  const Rows both = played({loss, leak});
  const std::size_t all = 2 * kChannels;
  UNSIGNED_LONGS_EQUAL(100, first_difference(healthy, leaking, 0, all));
  UNSIGNED_LONGS_EQUAL(200, first_difference(leaking, both, 0, all));
  // The state goes on: the first cycle of a fault differs by less than the piston moves in it.
  CHECK(std::abs(leaking[100][0] - healthy[100][0]) < std::abs(healthy[100][0] - healthy[99][0]));
  // Each acts on its own actuator: without supply the yaw piston no longer follows, with a leak the pitch piston does.
  CHECK(std::abs(both[300][kChannels] - healthy[300][kChannels]) > 1e-3);
  CHECK(std::abs(both[300][0] - leaking[300][0]) < 1e-3);
}

TEST(VehiclePlant, ThrustAndTorqueThatAreSwitchedGiveTheBitsOfOfflineStepping) {
  const hal::FlushDenormals flush;
  const model::InstrumentedVehicle<Taos> rig = followed_thrust();
  const auto plant = std::make_unique<VehiclePlant<Taos>>(
      rig, kVehiclePlantPeriod,
      std::vector<PlayedFault>{{PlayedKind::thrust, 0.1, 0.3, 1, 0, 0.0}, {PlayedKind::torque, 0.2, 0.35, 2, 0, 5e3}});
  const auto vehicle = std::make_unique<Taos>(rig.vehicle, kVehiclePlantPeriod / 2);
  const auto state = std::make_unique<Taos::State>(vehicle->steady({}));
  for (int cycle = 0; cycle < 400; ++cycle) {
    Taos::Inputs inputs;
    hal::Command command;
    command.values[0] = inputs.commands[0] = 0.02 * std::sin(20.0 * cycle * kVehiclePlantPeriod);
    command.values[1] = inputs.commands[1] = 0.015 * std::sin(31.0 * cycle * kVehiclePlantPeriod);
    inputs.thrust[0] = cycle >= 100 && cycle < 300 ? -rig.vehicle.gimbals[0].bearing.thrust : 0.0;
    inputs.torque[1] = cycle >= 200 && cycle < 350 ? 5e3 : 0.0;
    plant->step(command);
    vehicle->step(*state, inputs);
    vehicle->step(*state, inputs);
    for (std::size_t i = 0; i < state->measured.size(); ++i) {
      if (i % kChannels != 0) {
        DOUBLES_EQUAL(state->measured[i], plant->measured()[i], 0.0);
      }
    }
  }
}

// Friction from the load pressure: half of what it differs by between both ways through zero, so that what is viscous
// cancels between two thrusts.
TEST(VehiclePlant, FrictionDiffersBetweenNoThrustAndFullThrustByMuNR) {
  constexpr double kPeak = 0.05;
  constexpr int kCycles = 4000;  // of a triangle, at 0.05 rad/s
  const model::InstrumentedVehicle<Taos> rig = followed_thrust();
  const auto plant = std::make_unique<VehiclePlant<Taos>>(
      rig, kVehiclePlantPeriod, std::vector<PlayedFault>{{PlayedKind::thrust, 1e-3 * 2 * kCycles, 1e9, 0, 0, 0.0}});
  std::array<double, 2> resistance{};  // under full thrust, without
  for (std::size_t part = 0; part < resistance.size(); ++part) {
    std::array<double, 2> sum{};  // on the way down, up
    std::array<int, 2> count{};
    for (int cycle = 0; cycle < 2 * kCycles; ++cycle) {
      const double turn = static_cast<double>(cycle % kCycles) / kCycles;
      hal::Command command;
      command.values[0] = kPeak * (turn < 0.25 ? 4.0 * turn : turn < 0.75 ? 2.0 - 4.0 * turn : 4.0 * turn - 4.0);
      const double before = plant->measured()[1];
      plant->step(command);
      const double angle = plant->measured()[1];
      if (cycle >= kCycles && std::abs(angle) < 0.4 * kPeak) {
        sum[angle > before ? 1 : 0] += plant->measured()[2];
        ++count[angle > before ? 1 : 0];
      }
    }
    resistance[part] = 0.5 * (sum[1] / count[1] - sum[0] / count[0]);
  }
  const auto& bearing = rig.vehicle.gimbals[0].bearing;
  const double law =
      0.08 * rig.vehicle.gimbals[0].friction.radius * (bearing.thrust + bearing.dead_load - std::abs(bearing.dead_load));
  const double arm = Taos::geometry_of(rig.vehicle, 0).at(0.0, 0.0).arm[0][0];
  DOUBLES_EQUAL(law, (resistance[0] - resistance[1]) * rig.vehicle.axes[0].actuator.piston_area * arm, 0.01 * law);
}

TEST(VehiclePlant, FaultOfEveryActuatorIsThatOfEach) {
  const PlayedFault every{PlayedKind::leak, 0.1, 0.3, 0, 0, 1e-8};
  const Rows one = played({every});
  const Rows each = played({{PlayedKind::leak, 0.1, 0.3, 1, 0, 1e-8}, {PlayedKind::leak, 0.1, 0.3, 2, 0, 1e-8}});
  UNSIGNED_LONGS_EQUAL(one.size(), first_difference(one, each, 0, 2 * kChannels));
}

}  // namespace hotfire::firmware
