// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <array>
#include <cstdint>
#include <random>

#include "firmware/lab/lab.hpp"
#include "tests/firmware/lab/lab_on_wire.hpp"

namespace hotfire::firmware {

namespace {

constexpr double kBouncePeriod = 1e-2;
constexpr int kSecond = 100;  ///< cycles

/// What a profile that says nothing of the interlock asks for, at `kBouncePeriod`.
InterlockSettings usual(bool start_is_arm) {
  return {start_is_arm, 3, start_is_arm ? 1U + kSecond : 1U, 1U + 10U * kSecond, kSecond, 60U * kSecond, 2U * kSecond};
}

/// A lab whose two buttons do what they like for a second: contacts that bounce, two that are pressed at once, a sleeve.
class Bounced {
 public:
  Bounced(bool start_is_arm, std::uint64_t seed) : random_(seed), lab_(settings_of(start_is_arm), kBouncePeriod) {
    run(kSecond / 10);
  }

  /// Whether it has been armed, and whether it has run.
  bool armed = false;
  bool ran = false;

  void bounce() {
    const unsigned chance = 1 + random_() % 64;  // of an edge in a cycle, of 64
    for (int cycle = 0; cycle < kSecond; ++cycle) {
      change(inputs_.arm, inputs_.arm_changed, chance);
      change(inputs_.start, inputs_.start_changed, chance);
      step();
    }
    inputs_.arm_changed = inputs_.start_changed = false;
  }

  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      step();
    }
  }

  void press(bool LabInputs::*button, int cycles) {
    inputs_.*button = true;
    run(cycles);
    inputs_.*button = false;
    run(kSecond / 10);
  }

 private:
  static LabSettings settings_of(bool start_is_arm) {
    LabSettings made = test_lab::settings();
    made.interlock = usual(start_is_arm);
    return made;
  }

  void change(bool& level, bool& changed, unsigned chance) {
    const auto edges = random_() % 64 < chance ? 1 + random_() % 3 : 0;
    level = level != (edges % 2 == 1);
    changed = edges > 0;
  }

  void step() {
    lab_.step(inputs_);
    armed = armed || lab_.outputs().interlock.state == RigState::armed;
    ran = ran || lab_.outputs().interlock.state == RigState::running;
  }

  std::mt19937_64 random_;
  Lab lab_;
  LabInputs inputs_;
};

}  // namespace

TEST_GROUP(LabBounce){};

TEST(LabBounce, NoSequenceOfEdgesWithinASecondStartsMotionNorDoesWhatTheyLeaveTheButtonsAt) {
  constexpr std::uint64_t kSequences = 100'000;
  std::uint64_t armed = 0;
  for (std::uint64_t seed = 0; seed < kSequences; ++seed) {
    Bounced lab(seed % 2 == 0, seed);
    lab.bounce();
    lab.run(2 * kSecond);
    CHECK(!lab.ran);
    armed += lab.armed ? 1 : 0;
  }
  // So many of them were an arming that the claim is about a start.
  CHECK(armed > kSequences / 20);
}

TEST(LabBounce, TheSameButtonsStartItWhenTheyArePressedOneAfterTheOther) {
  for (const bool start_is_arm : {true, false}) {
    Bounced lab(start_is_arm, 1);
    lab.press(&LabInputs::arm, kSecond / 5);
    CHECK(lab.armed);
    lab.run(kSecond);
    lab.press(start_is_arm ? &LabInputs::arm : &LabInputs::start, start_is_arm ? kSecond + 10 : kSecond / 5);
    CHECK(lab.ran);
  }
}

TEST(LabBounce, PressThatBouncesOnBothEdgesIsOnePress) {
  // On, off and on again within the debounce, as a contact does: the defect was that this armed and started.
  for (const bool start_is_arm : {true, false}) {
    Bounced lab(start_is_arm, 2);
    for (int bounce = 0; bounce < 3; ++bounce) {
      lab.press(&LabInputs::arm, 1);
    }
    lab.press(&LabInputs::arm, kSecond / 5);
    for (int bounce = 0; bounce < 3; ++bounce) {
      lab.press(&LabInputs::arm, 1);
    }
    lab.run(3 * kSecond);
    CHECK(lab.armed);
    CHECK(!lab.ran);
  }
}

}  // namespace hotfire::firmware
