// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <array>
#include <bit>
#include <cmath>
#include <memory>

#include "firmware/loop/loop.hpp"
#include "firmware/plant/plant.hpp"
#include "firmware/plant/reference_plant.hpp"
#include "hal/arithmetic/denormals.hpp"
#include "hal/sim/manual_clock.hpp"
#include "hal/sim/plant_bus.hpp"

namespace hotfire::firmware {

namespace {

using Simplex = model::Simplex<double>;

constexpr std::uint64_t kCycles = 5000;
const hal::sim::CommandSource kSource{hal::sim::CommandSource::Shape::steps, 0.01, 1.0};

/// The hash of a run of the loop on a manual clock, whose wake-ups come late now and then.
std::uint64_t loop_hash(const Simplex::Parameters& parameters, std::int64_t period_ns, std::uint64_t warm_up) {
  const hal::FlushDenormals flush;
  const double period = static_cast<double>(period_ns) * 1e-9;
  Plant<Simplex> plant(parameters, period);
  hal::sim::SimulatedPlantBus bus(kSource, period);
  hal::sim::ManualClock clock;
  const auto loop = std::make_unique<Loop<Plant<Simplex>, hal::sim::SimulatedPlantBus, hal::sim::ManualClock>>(
      plant, bus, clock, LoopSettings{period_ns, kCycles - warm_up, warm_up, OverrunPolicy::catch_up});
  loop->run(false, [&]() noexcept { clock.delay_next_wake_up_ns(3 * period_ns); });
  return loop->result().hash.value();
}

/// The hash of the same cycles with neither clock nor loop nor bus.
std::uint64_t offline_hash(const Simplex::Parameters& parameters, double period, int steps) {
  const hal::FlushDenormals flush;
  const Simplex model(parameters, period / steps);
  Simplex::State state = model.steady(0.0);
  hal::Fnv1a hash;
  for (std::uint64_t cycle = 0; cycle < kCycles; ++cycle) {
    const double command = kSource.at(static_cast<double>(cycle) * period);
    for (int i = 0; i < steps; ++i) {
      model.step(state, command);
    }
    hash.add(std::span(state.y.data(), static_cast<std::size_t>(state.y.size())));
    hash.add(Simplex::measured(state));
  }
  return hash.value();
}

}  // namespace

TEST_GROUP(LoopBits) { Simplex::Parameters parameters = reference_plant_with_every_effect(); };

TEST(LoopBits, RealTimeLoopGivesTheBitsOfOfflineStepping) {
  CHECK(offline_hash(parameters, 1e-3, 2) == loop_hash(parameters, 1'000'000, 100));
  CHECK(offline_hash(parameters, 2.5e-4, 1) == loop_hash(parameters, 250'000, 100));
}

TEST(LoopBits, TwoRunsOfTheSameInputGiveTheSameBitsWhateverTheirTiming) {
  CHECK(loop_hash(parameters, 1'000'000, 10) == loop_hash(parameters, 1'000'000, 500));
}

TEST(LoopBits, LastBitOfOneParameterChangesTheHash) {
  const std::uint64_t before = loop_hash(parameters, 1'000'000, 10);
  parameters.engine.inertia = std::nextafter(parameters.engine.inertia, 1e9);
  CHECK(before != loop_hash(parameters, 1'000'000, 10));
}

// The expected value is of an implementation checked against the authors' vector "foobar" -> 85944171f73967e8.
TEST(LoopBits, HashIsFnv1aOverTheBytesFromTheLowestUp) {
  hal::Fnv1a hash;
  CHECK(hash.value() == 0xcbf29ce484222325);
  const std::array<double, 1> chongo{std::bit_cast<double>(std::uint64_t{0x3c206f676e6f6863})};  // the bytes of "chongo <"
  hash.add(chongo);
  CHECK(hash.value() == 0xd1ed9c0b5072eac1);
}

TEST(LoopBits, StringPotentiometersReadTheGeometryOfEveryPairOfActuatorsAndChangeNoBit) {
  constexpr std::size_t kStrings = 4;
  Plant<Simplex> plain({}, 1e-3, 3);
  Plant<Simplex> stringed({}, 1e-3, 3);
  stringed.string_up();
  UNSIGNED_LONGS_EQUAL(0, plain.strings().size());
  UNSIGNED_LONGS_EQUAL(2 * kStrings, stringed.strings().size());
  hal::Command command;
  command.values = {0.02, -0.01, 0.015};
  for (int cycle = 0; cycle < 300; ++cycle) {
    plain.step(command);
    stringed.step(command);
  }
  hal::Fnv1a one;
  hal::Fnv1a other;
  plain.add_to(one);
  stringed.add_to(other);
  CHECK(one.value() == other.value());
  // Channel 1 is the engine's angle; the third actuator's engine has no yaw.
  const std::span<const double> read = plain.measured();
  const model::StringPotentiometers<double> geometry(model::StringPotentiometers<double>::representative());
  const auto first = geometry.lengths(read[1], read[4], {0.0, 0.0, 0.0});
  const auto second = geometry.lengths(read[7], 0.0, {0.0, 0.0, 0.0});
  CHECK(std::abs(first[0]) > 1e-3);
  for (std::size_t i = 0; i < kStrings; ++i) {
    DOUBLES_EQUAL(first[i], stringed.strings()[i], 0.0);
    DOUBLES_EQUAL(second[i], stringed.strings()[kStrings + i], 0.0);
  }
}

}  // namespace hotfire::firmware
