// SPDX-License-Identifier: Apache-2.0
#include "firmware/plant/declared_faults.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numeric>

#include "firmware/image/plant_image.hpp"
#include "firmware/plant/plant.hpp"
#include "firmware/replay/replay.hpp"
#include "hal/sim/plant_bus.hpp"
#include "tests/files/scratch.hpp"
#include "tests/firmware/recording/recorded_run.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::firmware {

namespace {

using Simplex = model::Simplex<double>;
using Rows = std::vector<std::vector<double>>;

constexpr double kPeriod = 1e-3;
constexpr std::size_t kCycles = 400;
constexpr std::size_t kFrom = 100;
constexpr std::size_t kTo = 250;
constexpr std::size_t kChannels = 3;

/// A plant of two actuators under a sine, and what it sends in every cycle.
Rows played(const std::vector<PlayedFault>& faults, std::vector<std::uint32_t>* missing = nullptr) {
  Plant<Simplex> plant({}, kPeriod, 2, faults);
  const hal::sim::CommandSource source{hal::sim::CommandSource::Shape::sine, 0.02, 3.0};
  Rows rows;
  hal::Command command;
  for (std::size_t cycle = 0; cycle < kCycles; ++cycle) {
    command.values.fill(source.at(static_cast<double>(cycle) * kPeriod));
    plant.step(command);
    rows.emplace_back(plant.measured().begin(), plant.measured().end());
    if (missing != nullptr) {
      missing->push_back(plant.missing());
    }
  }
  return rows;
}

PlayedFault of(PlayedKind kind, double value = 0.0) { return {kind, 0.1, 0.25, 2, 0, value}; }

}  // namespace

TEST_GROUP(PlayedFaults) {
  test::Scratch scratch;
  const Rows healthy = played({});
  static constexpr std::size_t kPlace = kChannels;  ///< the piston of the second actuator

  /// Every reading but the piston of the second actuator in its time is as without the fault.
  void expect_nothing_else(const Rows& rows) const {
    for (std::size_t cycle = 0; cycle < kCycles; ++cycle) {
      for (std::size_t i = 0; i < rows[cycle].size(); ++i) {
        if (i != kPlace || cycle < kFrom || cycle >= kTo) {
          CHECK(rows[cycle][i] == healthy[cycle][i]);
        }
      }
    }
  }
};

TEST(PlayedFaults, StuckSensorHoldsWhatItReadBefore) {
  const Rows rows = played({of(PlayedKind::stuck)});
  expect_nothing_else(rows);
  for (std::size_t cycle = kFrom; cycle < kTo; ++cycle) {
    DOUBLES_EQUAL(healthy[kFrom - 1][kPlace], rows[cycle][kPlace], 0.0);
  }
}

TEST(PlayedFaults, BiasedSensorReadsSoMuchMore) {
  const Rows rows = played({of(PlayedKind::biased, 2e-3)});
  expect_nothing_else(rows);
  for (std::size_t cycle = kFrom; cycle < kTo; ++cycle) {
    DOUBLES_EQUAL(healthy[cycle][kPlace] + 2e-3, rows[cycle][kPlace], 0.0);
  }
}

TEST(PlayedFaults, DelayedSensorReadsWhatItHadReadThen) {
  const Rows rows = played({of(PlayedKind::delayed, 0.02)});
  expect_nothing_else(rows);
  for (std::size_t cycle = kFrom; cycle < kTo; ++cycle) {
    DOUBLES_EQUAL(healthy[cycle - 20][kPlace], rows[cycle][kPlace], 0.0);
  }
}

TEST(PlayedFaults, DroppedSensorIsMarkedAndKeepsWhatWasSentLast) {
  std::vector<std::uint32_t> missing;
  const Rows rows = played({of(PlayedKind::dropped)}, &missing);
  expect_nothing_else(rows);
  for (std::size_t cycle = 0; cycle < kCycles; ++cycle) {
    UNSIGNED_LONGS_EQUAL(cycle >= kFrom && cycle < kTo ? 1U << kPlace : 0U, missing[cycle]);
  }
  DOUBLES_EQUAL(healthy[kFrom - 1][kPlace], rows[kTo - 1][kPlace], 0.0);
}

// With 4000 draws the rms of white noise is known to 1 in 90 at one sigma, its mean and its correlation from draw to draw to
// 1 in 63: five sigma are allowed.
TEST(PlayedFaults, NoiseIsWhiteHasItsRmsAndIsTheSameInEveryRun) {
  constexpr double kRms = 1e-4;
  constexpr std::size_t kDraws = 4000;
  const auto draw = [] {
    PlayedSensors sensors({{PlayedKind::noisy, 0.0, 1e9, 0, 0, kRms}}, kPeriod, 1, 1);
    std::vector<double> noise(kDraws);
    const std::vector<double> before{0.0};
    for (std::size_t cycle = 0; cycle < kDraws; ++cycle) {
      sensors.play(cycle, before, std::span(noise).subspan(cycle, 1));
    }
    return noise;
  };
  const std::vector<double> noise = draw();
  const double square = std::inner_product(noise.begin(), noise.end(), noise.begin(), 0.0) / kDraws;
  const double mean = std::accumulate(noise.begin(), noise.end(), 0.0) / kDraws;
  const double next = std::inner_product(noise.begin() + 1, noise.end(), noise.begin(), 0.0) / kDraws;
  DOUBLES_EQUAL(1.0, std::sqrt(square) / kRms, 5.0 / 90.0);
  DOUBLES_EQUAL(0.0, mean / kRms, 5.0 / 63.0);
  DOUBLES_EQUAL(0.0, next / square, 5.0 / 63.0);
  CHECK(noise == draw());
}

TEST(PlayedFaults, LeakAndLostSupplyChangeTheirActuatorFromTheirTimeOnAndOnlyIt) {
  const Simplex::Parameters reference;
  for (const PlayedFault& fault : {of(PlayedKind::leak, 1000.0 * reference.actuator.leakage),
                                   of(PlayedKind::lost_supply, 0.02 * reference.actuator.supply_pressure)}) {
    const Rows rows = played({fault});
    for (std::size_t cycle = 0; cycle < kCycles; ++cycle) {
      for (std::size_t i = 0; i < kChannels; ++i) {
        CHECK(rows[cycle][i] == healthy[cycle][i]);
        CHECK(cycle >= kFrom || rows[cycle][kPlace + i] == healthy[cycle][kPlace + i]);
      }
    }
    // The state goes on: the first cycle of the fault differs by less than the piston moves in it.
    const double moved = std::abs(healthy[kFrom][kPlace] - healthy[kFrom - 1][kPlace]);
    CHECK(std::abs(rows[kFrom][kPlace] - healthy[kFrom][kPlace]) < moved);
    CHECK(rows[kTo - 1][kPlace] != healthy[kTo - 1][kPlace]);
  }
}

// A torque turns the engine by what its springs give, and by what the piston gives way until the feedback of its load
// pressure is washed out. An overshoot of half is allowed.
TEST(PlayedFaults, TorqueTurnsItsEngineTowardsPositiveAnglesWhileItLasts) {
  constexpr double kTorque = 2e4;
  const Simplex::Parameters reference;
  const double arm = reference.actuator.moment_arm;
  const double spring = 1.0 / (1.0 / reference.actuator.stiffness + 1.0 / reference.structure.stiffness);
  const double turned = kTorque / (reference.engine.duct_stiffness + spring * arm * arm);
  const double pressure = kTorque / (arm * reference.actuator.piston_area);
  const double given = reference.servovalve.pressure_feedback_gain * pressure / (reference.servovalve.position_gain * arm);
  const Rows rows = played({of(PlayedKind::torque, 0.5 * kTorque), of(PlayedKind::torque, 0.5 * kTorque)});
  for (std::size_t cycle = 0; cycle < kCycles; ++cycle) {
    for (std::size_t i = 0; i < kChannels; ++i) {
      CHECK(rows[cycle][i] == healthy[cycle][i]);
      CHECK(cycle >= kFrom || rows[cycle][kPlace + i] == healthy[cycle][kPlace + i]);
    }
  }
  const double largest = rows[kTo - 1][kPlace + 1] - healthy[kTo - 1][kPlace + 1];
  CHECK(largest > 0.5 * turned);
  CHECK(largest < 1.5 * (turned + given));
  CHECK(std::abs(rows[kCycles - 1][kPlace + 1] - healthy[kCycles - 1][kPlace + 1]) < 0.5 * largest);
}

TEST(PlayedFaults, BusThatIsOffNeitherReceivesNorSendsAndForgetsWhatCame) {
  hal::sim::SimulatedPlantBus wire({}, kPeriod);
  PlayedBus bus(wire, {{PlayedKind::bus_off, 0.01, 0.02}}, kPeriod);
  hal::Command command;
  for (std::uint64_t cycle = 0; cycle < 30; ++cycle) {
    const bool off = cycle >= 10 && cycle < 20;
    CHECK(bus.try_receive_command(command) == !off);
    CHECK(bus.try_send_reading({}) == !off);
    UNSIGNED_LONGS_EQUAL(off ? 9 : cycle, command.sequence);
  }
}

TEST(PlayedFaults, PlayingAllocatesNothing) {
  std::vector<PlayedFault> faults;
  for (const PlayedKind kind : {PlayedKind::stuck, PlayedKind::biased, PlayedKind::noisy, PlayedKind::dropped,
                                PlayedKind::delayed, PlayedKind::leak, PlayedKind::torque}) {
    faults.push_back({kind, 0.0, 1.0, 0, 0, 1e-9});
  }
  Plant<Simplex> plant({}, kPeriod, 8, faults);
  const test::AllocationGuard guard;
  for (int cycle = 0; cycle < 100; ++cycle) {
    plant.step({});
  }
  UNSIGNED_LONGS_EQUAL(0, guard.allocations());
}

TEST(PlayedFaults, ReplayPlaysTheFaultsOfTheRecording) {
  const std::string faults =
      "fault.0.kind noisy\nfault.0.from 0.05\nfault.0.to 0.2\nfault.0.actuator 0\nfault.0.channel position\n"
      "fault.0.value 0.001\nfault.1.kind bus_off\nfault.1.from 0.1\nfault.1.to inf\n";
  const std::string image = test::kBenchImage + faults;
  const PlantImage parsed = parse_plant_image(image, "image");
  STRCMP_EQUAL("", parsed.error.c_str());
  UNSIGNED_LONGS_EQUAL(2, parsed.faults.size());
  const auto options = test::recorded_options(scratch.path("run.hfr").string(), 300);
  test::record_run<model::Direct<double>>(options, test::bench_parameters(), image, parsed.faults);
  hal::RecordingReader reader(options.recording);
  const Replay result = replay(reader);
  UNSIGNED_LONGS_EQUAL(310, result.proved);
  CHECK(!result.difference);
}

TEST(PlayedFaults, ImageWithAFaultThatCannotBeIsRefused) {
  const auto refused = [](const std::string& lines, const char* message) {
    STRCMP_CONTAINS(message, parse_plant_image(test::kBenchImage + lines, "image").error.c_str());
  };
  refused("fault.0.kind broken\nfault.0.from 0\nfault.0.to 1\n", "fault.0.kind = broken: allowed are stuck biased");
  refused("fault.0.kind bus_off\nfault.0.from 2\nfault.0.to 1\n", "fault.0.to = 1: allowed is a number from 2");
  refused("fault.0.kind stuck\nfault.0.from 0\nfault.0.to 1\nfault.0.actuator 9\nfault.0.channel position\n",
          "fault.0.actuator = 9");
  refused("fault.0.kind stuck\nfault.0.from 0\nfault.0.to 1\nfault.0.actuator 1\nfault.0.channel piston\n",
          "fault.0.channel = piston: allowed are position");
  refused("fault.0.kind leak\nfault.0.from 0\nfault.0.to 1\nfault.0.actuator 1\nfault.0.value 0\n", "hydraulic");
  refused("fault.0.kind torque\nfault.0.from 0\nfault.0.to 1\nfault.0.actuator 1\nfault.0.value 0\n", "hydraulic");
  refused("fault.1.kind bus_off\nfault.1.from 0\nfault.1.to 1\n", "fault.1.kind = bus_off: unknown key");
}

}  // namespace hotfire::firmware
