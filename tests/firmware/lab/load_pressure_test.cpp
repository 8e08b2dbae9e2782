// SPDX-License-Identifier: Apache-2.0
// The limit of load pressure, with the frames that carry it: in every layout, of every actuator, in every driving state.

#include <atomic>

#include "tests/firmware/lab/lab_on_wire.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::firmware {

namespace {

using test_lab::kPeriodNs;
using test_lab::LabOnWire;

constexpr double kLimit = 2e7;    ///< [Pa]
constexpr double kBeyond = 10.0;  ///< one code of the frame [Pa]

LabSettings settings_of(can::Layout layout, bool limited = true) {
  LabSettings made = test_lab::settings();
  made.actuators = can::most_actuators(layout);
  made.limits.position_error = 1.0;
  for (std::size_t i = 0; limited && i < made.actuators; ++i) {
    made.limits.actuators[i].load_pressure = kLimit;
  }
  return made;
}

constexpr std::array<RigState, 3> kDrivingStates{RigState::armed, RigState::running, RigState::stopping};

/// A lab that has been brought to a state.
class Driven : public LabOnWire {
 public:
  Driven(can::Layout frames, RigState state) : LabOnWire(settings_of(frames), frames) {
    rig.ask_to_stop_when(stop_);
    cycles(3);
    press();
    if (state != RigState::armed) {
      press();
      cycles(5);
    }
    stop_ = state == RigState::stopping;
    cycles(state == RigState::stopping ? 1 : 0);
    CHECK(lab.outputs().interlock.state == state);
  }

 private:
  std::atomic<bool> stop_{false};
};

template <class Act>
void for_every_layout(Act&& act) {
  for (std::size_t layout = 0; layout < can::kLayouts.size(); ++layout) {
    act(static_cast<can::Layout>(layout));
  }
}

/// The load pressure of an actuator ends driving in the very cycle, and is the only fault.
void expect_ended_by(can::Layout layout, RigState state, std::size_t actuator, double load_pressure) {
  Driven world(layout, state);
  const std::uint64_t sent = world.commands;
  world.load_pressures[actuator] = load_pressure;
  world.cycle();
  CHECK(!world.on(kSupply));
  CHECK(world.on(kFault));
  CHECK(world.lab.outputs().interlock.first == Fault::load_pressure);
  CHECK(world.lab.outputs().interlock.faults == FaultSet(Fault::load_pressure));
  UNSIGNED_LONGS_EQUAL(sent, world.commands);
}

}  // namespace

TEST_GROUP(LoadPressure){};

TEST(LoadPressure, BeyondItsLimitEndsDrivingInTheCycleThatIsGivenItInEveryDrivingState) {
  for_every_layout([](can::Layout layout) {
    for (std::size_t actuator = 0; actuator < can::most_actuators(layout); ++actuator) {
      for (const RigState state : kDrivingStates) {
        expect_ended_by(layout, state, actuator, kLimit + kBeyond);
        expect_ended_by(layout, state, actuator, -kLimit - kBeyond);
      }
    }
  });
}

TEST(LoadPressure, AtItsLimitIsNoFaultInAnyDrivingState) {
  for_every_layout([](can::Layout layout) {
    for (const RigState state : kDrivingStates) {
      Driven world(layout, state);
      world.load_pressures.fill(-kLimit);
      world.cycle();
      CHECK(!world.lab.outputs().interlock.faults.any());
      // A lab that comes to rest is safe then, without a fault.
      CHECK(world.on(kSupply) || state == RigState::stopping);
    }
  });
}

TEST(LoadPressure, BeyondItsLimitForbidsArmingUntilItIsWithin) {
  LabOnWire world(settings_of(can::Layout::classic));
  world.load_pressures[1] = kLimit + kBeyond;
  world.cycles(3);
  world.press();
  CHECK(!world.on(kSupply));
  CHECK(world.lab.outputs().interlock.state == RigState::safe);
  world.load_pressures[1] = kLimit;
  world.cycle();
  world.press();
  CHECK(world.on(kSupply));
}

TEST(LoadPressure, FramesThatNeverComeAreAStaleSensorSoThatNothingIsArmed) {
  for_every_layout([](can::Layout layout) {
    LabOnWire world(settings_of(layout), layout);
    world.sends = false;
    bool with_pressure = false;
    world.before_lab = [&] {
      for (std::size_t i = 0; i < world.rig.messages(); ++i) {
        if (with_pressure || !world.is_load_pressure(i)) {
          world.plant.try_send(world.reading(i, static_cast<std::uint8_t>(world.counter - 1)));
        }
      }
    };
    world.cycles(10);
    world.press();
    CHECK(!world.on(kSupply));
    with_pressure = true;
    world.cycles(10);
    world.press();
    CHECK(world.on(kSupply));
  });
}

TEST(LoadPressure, FramesThatStopAreAStaleSensorOnceTheyAreOlderThanAReadingMayBe) {
  for_every_layout([](can::Layout layout) {
    for (const RigState state : {RigState::armed, RigState::running}) {
      Driven world(layout, state);
      world.sends = false;
      world.before_lab = [&] {
        for (std::size_t i = 0; !world.is_load_pressure(i); ++i) {
          world.plant.try_send(world.reading(i, static_cast<std::uint8_t>(world.counter - 1)));
        }
      };
      world.cycles(static_cast<int>(world.lab.limits().actuators[0].reading_age_ns / kPeriodNs));
      CHECK(world.on(kSupply));
      world.cycle();
      CHECK(!world.on(kSupply));
      CHECK(world.lab.outputs().interlock.first == Fault::stale_sensor);
      CHECK(world.lab.outputs().interlock.faults == FaultSet(Fault::stale_sensor));
    }
  });
}

// That it does not hear them either is the kernel's filter: tools/rig lab_ends.
TEST(LoadPressure, LabWithoutALimitOfItExpectsNoFramesOfIt) {
  for_every_layout([](can::Layout layout) {
    LabOnWire world(settings_of(layout, false), layout);
    UNSIGNED_LONGS_EQUAL(can::reading_messages(layout, world.actuators), world.rig.messages());
    for (const hal::CanSubscription& heard : can::controller_ids(layout, world.actuators).subscriptions) {
      CHECK(heard.id != can::id_of(can::load_pressure_message(layout)));
    }
    world.run();
    world.cycles(20);
    CHECK(world.lab.outputs().interlock.state == RigState::running);
  });
}

TEST(LoadPressure, CycleThatTakesItTakesNothingFromTheHeap) {
  Driven world(can::Layout::fd, RigState::running);
  const test::AllocationGuard guard;
  world.cycles(100);
  UNSIGNED_LONGS_EQUAL(0, guard.allocations() + guard.releases());
  CHECK(world.on(kSupply));
}

}  // namespace hotfire::firmware
