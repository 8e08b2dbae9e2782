// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/plant_bus.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::hal {

TEST_GROUP(SimulatedPlantBus){};

TEST(SimulatedPlantBus, GivesOneCommandACallAtTheSourcesTimeOfThatPeriod) {
  const sim::CommandSource source{sim::CommandSource::Shape::sine, 1.0, 50.0};
  sim::SimulatedPlantBus bus(source, 1e-3);
  Command command;
  for (std::uint64_t i = 0; i < 100; ++i) {
    CHECK(bus.try_receive_command(command));
    UNSIGNED_LONGS_EQUAL(i, command.sequence);
    DOUBLES_EQUAL(source.at(static_cast<double>(i) * 1e-3), command.values[0], 0.0);
    DOUBLES_EQUAL(command.values[0], command.values[kMaxActuators - 1], 0.0);
  }
}

TEST(SimulatedPlantBus, KeepsTheNewestReadingOnly) {
  sim::SimulatedPlantBus bus({}, 1e-3);
  Reading reading;
  for (std::uint64_t i = 0; i < 3; ++i) {
    reading.sequence = i;
    CHECK(bus.try_send_reading(reading));
  }
  UNSIGNED_LONGS_EQUAL(2, bus.newest_reading().sequence);
}

}  // namespace hotfire::hal
