// SPDX-License-Identifier: Apache-2.0
// A lab whose readings have to come from who has the key: in the layouts with room for a code, of every message.

#include <array>

#include "tests/firmware/lab/lab_on_wire.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::firmware {

namespace {

using test_lab::full_settings;
using test_lab::kPeriodNs;
using test_lab::LabOnWire;

}  // namespace

TEST_GROUP(LabAuthentication){};

TEST(LabAuthentication, ReadingWithoutTheKeyIsAFaultAndOneWithItIsNotAndNothingIsAllocated) {
  constexpr can::AuthenticationKey kKey{1, 2, 3};
  constexpr std::int64_t kTolerance = 1'000'000'000;
  const can::Authentication::RealTime no_time = []() noexcept { return std::int64_t{0}; };
  for (const can::Layout layout : {can::Layout::fd, can::Layout::fd_split}) {
    can::Authentication of_lab(kKey, kTolerance, no_time);
    can::Authentication of_plant(kKey, kTolerance, no_time);
    LabOnWire world(full_settings(layout), layout);
    world.rig.authenticate(of_lab);
    world.sends = false;
    bool seals_load_pressure = true;
    world.before_lab = [&] {
      for (std::size_t i = 0; i < world.rig.messages(); ++i) {
        hal::CanFrame frame = world.reading(i, static_cast<std::uint8_t>(world.counter - 1));
        if (!world.is_load_pressure(i) || seals_load_pressure) {
          of_plant.seal(world.rig.message(i), frame);
        }
        world.plant.try_send(frame);
      }
    };
    world.run();
    {
      const test::AllocationGuard guard;
      world.cycles(300);
      UNSIGNED_LONGS_EQUAL(0, guard.allocations() + guard.releases());
    }
    CHECK(world.lab.outputs().interlock.state == RigState::running);
    std::uint64_t newest = 0;
    CHECK(of_plant.accepts(can::command_message(layout), world.plant.mailbox(0).frame, newest));
    seals_load_pressure = false;
    world.cycle();
    CHECK(world.lab.outputs().interlock.first == Fault::not_authentic);
    seals_load_pressure = true;
    world.press();
    world.press();
    CHECK(world.on(kSupply));
    world.before_lab = [] {};
    world.sends = true;
    world.cycle();
    CHECK(!world.on(kSupply));
    CHECK(world.lab.outputs().interlock.first == Fault::not_authentic);
  }
}

namespace {

/// The real time of a node of its own [ns].
template <int Node>
std::int64_t node_time = 0;

/// A lab that runs under a key, with a plant that has it.
class Sealed : public LabOnWire {
 public:
  explicit Sealed(can::Layout frames) : LabOnWire(full_settings(frames), frames) {
    rig.authenticate(of_lab_);
    sends = false;
    before_lab = [this] { send_true(); };
    after_cycle = [] {
      node_time<0> += kPeriodNs;
      node_time<1> += kPeriodNs;
    };
    run();
  }

  /// What the plant says of message `which` in this cycle, sealed by who has that time.
  hal::CanFrame sealed(std::size_t which, can::Authentication& by) const {
    hal::CanFrame frame = reading(which, static_cast<std::uint8_t>(counter - 1));
    by.seal(rig.message(which), frame);
    return frame;
  }

  void send_true() {
    for (std::size_t i = 0; i < rig.messages(); ++i) {
      last_[i] = sealed(i, of_plant_);
      plant.try_send(last_[i]);
    }
  }

  const hal::CanFrame& last(std::size_t which) const { return last_[which]; }

 private:
  static constexpr can::AuthenticationKey kKey{1, 2, 3};
  static constexpr std::int64_t kTolerance = 1'000'000'000;

  can::Authentication of_lab_{kKey, kTolerance, []() noexcept { return node_time<0>; }};
  can::Authentication of_plant_{kKey, kTolerance, []() noexcept { return node_time<0>; }};
  std::array<hal::CanFrame, can::kMostReadingMessages + 1> last_{};

 public:
  /// A second node with the key, and with a clock of its own.
  can::Authentication other{kKey, kTolerance, []() noexcept { return node_time<1>; }};
};

/// Runs `forge(rig, which)`, which sends a second frame of a message, on a rig of its own; expects its fault in that cycle.
template <class Forge>
void expect_fault_of_every_sealed_message(std::int64_t ahead_ns, Fault fault, Forge&& forge) {
  for (const can::Layout layout : {can::Layout::fd, can::Layout::fd_split}) {
    for (std::size_t which = 0; which < can::reading_messages(layout, can::most_actuators(layout)) + 1; ++which) {
      node_time<0> = 0;
      node_time<1> = ahead_ns;
      Sealed rig(layout);
      rig.before_lab = [&] {
        const hal::CanFrame before = rig.last(which);
        rig.send_true();
        rig.plant.receive(rig.clock.now_ns());
        rig.plant.try_send(forge(rig, which, before));
      };
      rig.cycle();
      CHECK(!rig.on(kSupply));
      CHECK(rig.lab.outputs().interlock.faults.has(fault));
    }
  }
}

}  // namespace

TEST(LabAuthentication, SecondNodeWithTheKeyAndALaterClockIsASecondSender) {
  expect_fault_of_every_sealed_message(
      1'000'000, Fault::second_sender,
      [](Sealed& rig, std::size_t which, const hal::CanFrame&) { return rig.sealed(which, rig.other); });
}

TEST(LabAuthentication, SecondNodeWithTheKeyAndAnEarlierClockIsNotAuthentic) {
  expect_fault_of_every_sealed_message(
      -1'000'000, Fault::not_authentic,
      [](Sealed& rig, std::size_t which, const hal::CanFrame&) { return rig.sealed(which, rig.other); });
}

TEST(LabAuthentication, ReplayedFrameOfTheCycleBeforeIsNotAuthentic) {
  expect_fault_of_every_sealed_message(0, Fault::not_authentic,
                                       [](Sealed&, std::size_t, const hal::CanFrame& before) { return before; });
}

}  // namespace hotfire::firmware
