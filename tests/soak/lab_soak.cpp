// SPDX-License-Identifier: Apache-2.0
// A lab on the wire in the process, for a given time, with everything that goes wrong going wrong at random, and what must
// always hold checked in every cycle: lab_soak SECONDS [SEED] Exit 0: it held in every cycle, and enough went wrong for that
// to mean something.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "tests/firmware/lab/lab_on_wire.hpp"
#include "tests/rig/lab_laws.hpp"

namespace hotfire::firmware {
namespace {

using test_lab::kPeriod;
using test_lab::kPeriodNs;
using test_lab::LabOnWire;

/// A command handed over in a cycle may reach the wire in the two that follow: then the bus is given up.
constexpr std::uint64_t kMostCyclesOnTheWay = 2;
/// Less than this and a run says nothing: profiles run to their end, and different first faults.
constexpr std::uint64_t kLeastCompleted = 3;
constexpr std::size_t kLeastFaults = 11;
constexpr std::uint64_t kLeastEnds = 10;

/// Something that is so for a random time, again and again.
class Spell {
 public:
  /// Begins in a cycle with probability 1/`every`, lasts 1 to `longest` cycles.
  Spell(std::uint64_t every, std::uint64_t longest) : every_(every), longest_(longest) {}

  bool now(std::mt19937_64& random) {
    if (left_ > 0) {
      --left_;
    } else if (random() % every_ == 0) {
      left_ = 1 + random() % longest_;
    }
    return left_ > 0;
  }

 private:
  std::uint64_t every_;
  std::uint64_t longest_;
  std::uint64_t left_ = 0;
};

class Soak {
 public:
  explicit Soak(std::uint64_t seed) : random_(seed) { restart(); }

  /// False once something did not hold, which is then printed.
  bool cycle() {
    if (random_() % 200'000 == 0) {
      restart();
    }
    happen();
    send_readings();
    hal::Command unused;
    bench_->rig.try_receive_command(unused);
    bench_->rig.step(unused);
    bench_->rig.try_send_reading({});
    bench_->plant.receive(bench_->clock.now_ns());
    check();
    move();
    bench_->clock.advance_ns(kPeriodNs);
    ++cycles_;
    if (bench_->rig.ended()) {
      check_end();
      restart();
    }
    return held_;
  }

  std::uint64_t cycles() const { return cycles_; }

  bool report() {
    take_account();
    std::size_t different = 0;
    std::printf(
        "%llu cycles, %llu starts of the program, %llu ends by itself, %llu armings, %llu profiles run to their end; first "
        "faults:\n",
        whole(cycles_), whole(restarts_), whole(ends_), whole(armings_), whole(completed_));
    for (const FaultText& fault : kFaults) {
      const std::uint64_t count = first_.at(static_cast<std::size_t>(fault.fault));
      different += count > 0 ? 1 : 0;
      std::printf("  %2d %-24s %llu\n", static_cast<int>(fault.fault), fault.name.data(), whole(count));
    }
    if (different < kLeastFaults || completed_ < kLeastCompleted || ends_ < kLeastEnds) {
      std::printf("FAILED: too little happened: wanted %zu different faults, %llu profiles and %llu ends\n", kLeastFaults,
                  whole(kLeastCompleted), whole(kLeastEnds));
      return false;
    }
    return held_;
  }

 private:
  static unsigned long long whole(std::uint64_t count) { return count; }

  bool chance(std::uint64_t one_in) { return random_() % one_in == 0; }

  /// The program is killed and started anew: its node and its lines go, the actuator stays.
  void restart() {
    if (bench_) {
      take_account();
    }
    LabSettings made = test_lab::settings();
    made.profile = Profile({test_lab::segment(0.3, 0.02, 0.02), test_lab::segment(0.3, 0.0, 0.0, 0.02, 5.0, 5.0)});
    made.limits.actuators[0].load_pressure = kLoadPressureLimit;
    bench_ = std::make_unique<LabOnWire>(std::move(made));
    asked_ = false;
    bench_->rig.ask_to_stop_when(asked_);
    holding_ = false;
    ++restarts_;
    state_ = RigState::safe;
    beat_ = bench_->on(kHeartbeat);
    last_driven_.reset();
    forget_switch();
    target_ = piston_;
  }

  void take_account() {
    for (const FaultText& fault : kFaults) {
      first_.at(static_cast<std::size_t>(fault.fault)) += bench_->lab.times_first(fault.fault);
    }
    armings_ += bench_->lab.armings();
  }

  void happen() {
    bench_->drive(kEmergencyStopReleased, !stop_.now(random_));
    bench_->drive(kHydraulicEnabled, !hydraulic_.now(random_));
    // A press that bounces: on, with short breaks.
    const bool pressed = press_.now(random_) && !bounce_.now(random_);
    bench_->drive(kArm, pressed);
    arm_on_ = pressed;
    broken_ = lines_.now(random_);
    bench_->board.set_broken(broken_);
    bench_->wire.set_bus_off(bus_off_.now(random_));
    bench_->wire.set_down(down_.now(random_));
    bench_->wire.set_queue_full(full_.now(random_));
    if (const bool held = nobody_acknowledges_.now(random_); held != holding_) {
      holding_ = held;
      if (held) {
        bench_->wire.hold();
      } else {
        bench_->wire.release();
      }
    }
    bench_->wire.set_stop_refused(refuses_take_back_.now(random_));
    if (late_.now(random_)) {
      bench_->rig.note_overrun();
    }
    asked_ = asked_ || chance(50'000);
  }

  void send_readings() {
    if (bench_->plant.state() >= hal::CanState::bus_off) {
      bench_->plant.rearm();  // by itself, as a sensor's node does
    }
    send_load_pressure();
    if (silent_.now(random_)) {
      return;
    }
    const double seen = wild_.now(random_) ? 0.2 : piston_;
    const double other = torn_.now(random_) ? seen + 0.01 : seen;
    hal::CanFrame frame;
    counter_ = static_cast<std::uint8_t>(counter_ + (chance(20'000) ? 2 : 1));
    if (!can::encode(can::piston_1::kMessage, std::array{std::min(seen, kMostSayable), std::min(other, kMostSayable)},
                     counter_, frame)) {
      return;
    }
    if (chance(20'000)) {
      frame.data[random_() % frame.length] ^= static_cast<std::uint8_t>(1U << (random_() % 8));
    }
    bench_->plant.try_send(frame);
  }

  void send_load_pressure() {
    if (gauge_silent_.now(random_)) {
      return;
    }
    const double pressure = (overloaded_.now(random_) ? 1.01 : 0.99) * (chance(2) ? 1.0 : -1.0) * kLoadPressureLimit;
    hal::CanFrame frame;
    can::encode(can::load_pressures::kMessage, std::array{pressure, 0.0}, ++gauge_counter_, frame);
    bench_->plant.try_send(frame);
  }

  /// The piston follows the newest current, as far as it was heard, while the supply is on.
  void move() {
    if (bench_->plant.mailbox(0).fresh) {
      std::array<double, 32> values{};
      std::uint8_t counter = 0;
      if (can::decode(can::command_message(can::Layout::classic), bench_->plant.mailbox(0).frame, values, counter) ==
          can::Decoding::good) {
        target_ = values[0] / kCurrentPerCommand * kPistonPerCommand;
      }
    }
    constexpr double kSpeed = 0.5;  // [m/s]
    if (bench_->on(kSupply) && !jammed_.now(random_)) {
      piston_ += std::clamp(target_ - piston_, -kSpeed * kPeriod, kSpeed * kPeriod);
    }
  }

  void forget_switch() {
    seen_off_ = false;
    seen_on_after_off_ = false;
  }

  void expect(bool good, const std::string& law) {
    if (!good && held_) {
      held_ = false;
      std::printf("FAILED in cycle %llu, %s: %s\n", whole(cycles_),
                  kRigStates[static_cast<std::size_t>(bench_->lab.outputs().interlock.state)].data(), law.c_str());
    }
  }

  void check() {
    const InterlockOutputs& interlock = bench_->lab.outputs().interlock;
    const ObservedRig& seen = bench_->rig.inputs().rig;
    expect(test::may_follow(state_, interlock.state),
           "came from " + std::string(kRigStates[static_cast<std::size_t>(state_)]) + ", which does not lead here");
    seen_on_after_off_ = seen_on_after_off_ || (seen_off_ && arm_on_ && !broken_);
    seen_off_ = seen_off_ || (!arm_on_ && !broken_);
    if (interlock.state != state_) {
      expect(interlock.state != RigState::armed || seen_on_after_off_, "armed though nobody pressed in the state before");
      completed_ += state_ == RigState::running && interlock.state == RigState::stopping ? 1 : 0;
      forget_switch();
      state_ = interlock.state;
    }
    const bool cause =
        seen.emergency_stop || !seen.hydraulic_enable || seen.bus_off || seen.bus_down || seen.bad_frame ||
        seen.second_sender || seen.transmit_queue_full ||
        std::abs(bench_->rig.inputs().load_pressures[0]) > kLoadPressureLimit ||
        bench_->rig.inputs().load_pressure_ages_ns[0] > test_lab::settings().limits.actuators[0].reading_age_ns ||
        std::ranges::max(bench_->rig.inputs().ages_ns[0]) > test_lab::settings().limits.actuators[0].reading_age_ns;
    expect(!interlock.drive || !cause, "drives in a cycle that has a cause of a fault");
    expect(interlock.fault_out == (interlock.state == RigState::faulted), "its fault output is not its state");
    if (!broken_) {
      expect(bench_->on(kSupply) == interlock.drive, "the supply line is not what is driven");
      expect(bench_->on(kFault) == interlock.fault_out, "the fault line is not the state");
      expect(bench_->on(kHeartbeat) != beat_ || was_broken_, "the heartbeat line stood still");
      beat_ = bench_->on(kHeartbeat);
    }
    was_broken_ = broken_;
    if (interlock.drive) {
      last_driven_ = cycles_;
    }
    // One that the kernel does not give back may leave: the fault line says so.
    expect(!bench_->plant.mailbox(0).fresh || (last_driven_ && cycles_ - *last_driven_ <= kMostCyclesOnTheWay) ||
               (interlock.fault_out && interlock.faults.has(Fault::take_back_refused)),
           "a command reached the wire though nothing was driven");
    const double current = bench_->lab.outputs().currents[0];
    const double command = bench_->lab.outputs().commands[0];
    expect(std::isfinite(current) && std::abs(current) <= test_lab::settings().current_limit, "a current beyond its limit");
    expect(std::isfinite(command), "a command that is no number");
    expect(!interlock.drive ||
               std::abs(command * kPistonPerCommand) <= test_lab::settings().limits.actuators[0].highest_position,
           "a command beyond its limit");
  }

  /// The program ends: nothing is on, and nothing that it handed over leaves any more, whoever acknowledges.
  void check_end() {
    ++ends_;
    expect(!bench_->on(kSupply), "the program ends with its supply on");
    bench_->wire.set_bus_off(false);
    bench_->wire.set_down(false);
    bench_->wire.release();
    if (bench_->plant.state() >= hal::CanState::bus_off) {
      bench_->plant.rearm();
    }
    bench_->plant.receive(bench_->clock.now_ns());
    expect(!bench_->plant.mailbox(0).fresh, "a command leaves after the end of the program");
  }

  static constexpr double kMostSayable = 0.19;
  static constexpr double kLoadPressureLimit = 2e7;  ///< [Pa]
  static constexpr double kPistonPerCommand = 0.5;
  static constexpr double kCurrentPerCommand = 0.1;

  std::mt19937_64 random_;
  std::unique_ptr<LabOnWire> bench_;
  // Seldom enough that profiles of 0.7 s end now and then, each long enough to outlast its limit.
  Spell press_{400, 200};
  Spell bounce_{10, 3};
  Spell stop_{15'000, 500};
  Spell hydraulic_{15'000, 500};
  Spell lines_{20'000, 20};
  Spell bus_off_{20'000, 300};
  Spell down_{20'000, 300};
  Spell full_{20'000, 5};
  Spell nobody_acknowledges_{20'000, 20};
  Spell refuses_take_back_{200, 50};
  Spell late_{20'000, 20};
  Spell silent_{5'000, 10};
  Spell wild_{20'000, 3};
  Spell torn_{20'000, 3};
  Spell jammed_{10'000, 100};
  Spell gauge_silent_{20'000, 10};
  Spell overloaded_{20'000, 3};
  double piston_ = 0.0;
  double target_ = 0.0;
  std::uint8_t counter_ = 0;
  std::uint8_t gauge_counter_ = 0;
  std::atomic<bool> asked_{false};
  bool arm_on_ = false;
  bool holding_ = false;
  bool broken_ = false;
  bool was_broken_ = false;
  bool beat_ = false;
  bool seen_off_ = false;
  bool seen_on_after_off_ = false;
  bool held_ = true;
  RigState state_ = RigState::safe;
  std::optional<std::uint64_t> last_driven_;
  std::uint64_t cycles_ = 0;
  std::uint64_t restarts_ = 0;
  std::uint64_t ends_ = 0;
  std::uint64_t armings_ = 0;
  std::uint64_t completed_ = 0;
  std::array<std::uint64_t, 256> first_{};
};

int run(double seconds, std::uint64_t seed) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begun = Clock::now();
  Soak soak(seed);
  constexpr std::uint64_t kLeastCycles = 1'000'000;
  while (soak.cycles() < kLeastCycles || Clock::now() - begun < std::chrono::duration<double>(seconds)) {
    for (int i = 0; i < 10'000; ++i) {
      if (!soak.cycle()) {
        soak.report();
        std::printf("again: lab_soak %g %llu\n", seconds, static_cast<unsigned long long>(seed));
        return 1;
      }
    }
  }
  return soak.report() ? 0 : 1;
}

}  // namespace
}  // namespace hotfire::firmware

int main(int count, char** values) {
  const double seconds = count > 1 ? std::strtod(values[1], nullptr) : 60.0;
  const std::uint64_t seed = count > 2 ? std::strtoull(values[2], nullptr, 10) : 1;
  return hotfire::firmware::run(seconds, seed);
}
