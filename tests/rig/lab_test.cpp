// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <bit>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <memory>
#include <vector>

#include "firmware/interlock/faults.hpp"
#include "tests/rig/lab_bench.hpp"
#include "tests/rig/lab_stops.hpp"

namespace hotfire::firmware {

namespace {

constexpr test::LabLimits kShortLimits{400'000'000, 100};
const char* const kShortLimitLines = "limits.reading_age 0.4\nlimits.command_age 0.4\nlimits.position_error_time 1\n";

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

using test::carries;
using test::press;
using test::pull;
using test::SensorNode;
using test::shell;
using test::wait_for_beats;
using test::wait_until;

TEST_GROUP(Lab) {
  std::unique_ptr<SensorNode> node;
  std::unique_ptr<test::LabProgram> lab;
  std::vector<std::int64_t> provoked;  ///< when each fault had been provoked, CLOCK_MONOTONIC

  void setup() override {
    shell("ip link add dev can0 type vcan; ip link set can0 up");
    test::bank_up();
    node = std::make_unique<SensorNode>();
  }
  void teardown() override {
    lab.reset();
    node.reset();
    test::bank_down();
  }

  void start(const std::string& changes = "", const std::string& options = "") {
    lab = std::make_unique<test::LabProgram>(changes, options);
  }

  void arm() {
    press();
    wait_until("supply", [] { return carries(test::kSupplyLine); });
  }

  void run_profile() {
    arm();
    // The least time in `armed`, in cycles of 10 ms and some that the heartbeat may not be seen in.
    wait_for_beats(110);
    press(test::kStartLine);
    wait_until("the profile to run", [&] { return node->state == RigState::running; });
    const std::uint64_t before = node->commands;
    wait_until("commands", [&] { return node->commands > before + 5; });
  }

  /// Nothing is driven, and nothing has been since the program said so.
  void is_safe() {
    CHECK(!carries(test::kSupplyLine));
    UNSIGNED_LONGS_EQUAL(0, node->commands_when_not_driving);
  }

  /// Waits for a fault, which leaves the rig safe, and ends the lab, which then reports it.
  void ends_safe(const char* fault) {
    wait_until("the fault line", [] { return carries(test::kFaultLine); });
    is_safe();
    lab->signal(SIGTERM);
    LONGS_EQUAL(5, lab->wait());
    STRCMP_CONTAINS(fault, lab->output().c_str());
  }

  /// Waits for a fault, and for all that was sent before it to be counted; returns how many commands that were.
  std::uint64_t commands_at_fault() {
    wait_until("the fault line", [] { return carries(test::kFaultLine); });
    const std::uint64_t quiet = node->quiet;
    wait_until("the last frames", [&] { return node->state == RigState::faulted || node->quiet > quiet; });
    is_safe();
    return node->commands;
  }

  /// Brings a running lab to a fault and removes its cause: nothing is sent until it is armed again, which it then is.
  template <class Provoke, class Remedy>
  void goes_safe(Provoke && provoke, Remedy && remedy) {
    run_profile();
    provoke();
    provoked.push_back(now_ns());
    const std::uint64_t sent = commands_at_fault();
    wait_for_beats(5);
    remedy();
    wait_for_beats(10);
    CHECK(carries(test::kFaultLine));
    UNSIGNED_LONGS_EQUAL(sent, node->commands);
    // After a fault of the bus the first press takes it into use again.
    press();
    if (!carries(test::kSupplyLine)) {
      UNSIGNED_LONGS_EQUAL(sent, node->commands);
      arm();
    }
    wait_until("commands", [&] { return node->commands > sent; });
  }

  /// Ends the program. Each of these faults ended driving, and the recording says how; `verdict` is that of its replay.
  void ended_driving(std::initializer_list<Fault> faults, const char* verdict = kSameBits) {
    lab->signal(SIGTERM);
    LONGS_EQUAL(1, lab->wait());
    is_safe();
    const std::string output = lab->output();
    for (const Fault fault : faults) {
      STRCMP_CONTAINS((std::string(text_of(fault).name) + ": the first one ").c_str(), output.c_str());
    }
    const test::LabRecord record = look_at_recording(verdict);
    UNSIGNED_LONGS_EQUAL(provoked.size(), record.stops.size());
    for (std::size_t i = 0; i < provoked.size(); ++i) {
      const auto& drove = record.stops[i].drove;
      const auto after = std::count_if(drove.begin(), drove.end(), [&](std::int64_t woken) { return woken > provoked[i]; });
      const Fault fault = record.stops[i].fault;
      std::printf("fault %d, %s: %d cycles that began after it was provoked still drove\n", static_cast<int>(fault),
                  text_of(fault).name.data(), static_cast<int>(after));
      // The others have to last before they are a fault, or come with a frame that has to come first.
      if (fault == Fault::emergency_stop || fault == Fault::hydraulic_enable_lost || fault == Fault::not_finite) {
        CHECK(after <= kMostPeriods);
      }
    }
  }

  static constexpr int kMostPeriods = 2;

  static constexpr const char* kSameBits = "verdict: good (every recorded cycle has the same bits)";

  /// The logic decides every cycle of the recording as it was recorded, every fault was acted on within two periods of the
  /// cycle that was given what shows it, and no command was on the bus that is not in it.
  test::LabRecord look_at_recording(const char* verdict = kSameBits) const {
    shell(std::string("hotfire-rt replay ") + test::LabProgram::kRecording + " >/tmp/replay || true; grep -F '" + verdict +
          "' /tmp/replay || { cat /tmp/replay; false; }");
    const test::LabRecord record = test::read_lab_record(test::LabProgram::kRecording, kShortLimits);
    for (const test::Stop& stop : record.stops) {
      const bool is_shown = stop.fault != Fault::not_finite;
      CHECK_EQUAL(is_shown, stop.seen != 0);
      CHECK(!is_shown || stop.safe - stop.seen <= kMostPeriods);
      if (is_shown) {
        std::printf("fault %d, %s: safe %d cycles after the one that was given it\n", static_cast<int>(stop.fault),
                    text_of(stop.fault).name.data(), static_cast<int>(stop.safe - stop.seen));
      }
    }
    CHECK(node->commands <= record.commands);
    return record;
  }
};

TEST(Lab, ProfileRunsToItsEndAndTheProgramEndsWithItsOutputsSafe) {
  start("segment.0.duration 0.5\n");
  wait_for_beats(10);
  UNSIGNED_LONGS_EQUAL(0, node->commands);
  run_profile();
  LONGS_EQUAL(0, lab->wait());
  STRCMP_CONTAINS("profile run to its end", lab->output().c_str());
  is_safe();
  UNSIGNED_LONGS_EQUAL(0, look_at_recording().stops.size());
}

TEST(Lab, ProgramThatIsKilledAndStartedAnewDrivesNothing) {
  start();
  run_profile();
  lab.reset();
  const std::uint64_t sent = node->commands;
  start();
  wait_for_beats(10);
  UNSIGNED_LONGS_EQUAL(sent, node->commands);
  CHECK(!carries(test::kSupplyLine));
}

TEST(Lab, FaultOfAReadingLeavesItSafeUntilArmedAgain) {
  start(kShortLimitLines);
  const auto mode = [&](SensorNode::Mode set) { return [this, set] { node->mode = set; }; };
  goes_safe(mode(SensorNode::Mode::silent), mode(SensorNode::Mode::good));
  goes_safe(mode(SensorNode::Mode::damaged), mode(SensorNode::Mode::good));
  goes_safe(mode(SensorNode::Mode::jammed), mode(SensorNode::Mode::good));
  goes_safe(mode(SensorNode::Mode::doubled), mode(SensorNode::Mode::good));
  goes_safe([&] { node->send_command(); }, [] {});
  const auto offset = [&](double set) { return [this, set] { node->offset = set; }; };
  goes_safe(offset(0.2), offset(0.0));
  goes_safe(offset(0.1), offset(0.0));
  goes_safe([&] { node->second_offset = 0.002; }, [&] { node->second_offset = 0.0; });
  ended_driving({Fault::stale_sensor, Fault::bad_frame, Fault::position_error, Fault::second_sender, Fault::out_of_range,
                 Fault::limit, Fault::readings_disagree});
}

TEST(Lab, SecondNodeWhoseCountersFitLeavesItSafeHoweverLateTheCyclesAre) {
  start(std::string(kShortLimitLines) + "limits.reading_period sync\n");
  goes_safe([&] { node->mode = SensorNode::Mode::surplus; }, [&] { node->mode = SensorNode::Mode::good; });
  ended_driving({Fault::second_sender});
}

TEST(Lab, FaultOfTheBusLeavesItSafeUntilArmedAgain) {
  start("limits.reading_age 10\nlimits.command_age 10\n");
  goes_safe([&] { CHECK(node->report_bus_off()); }, [] {});
  // While an interface goes down the kernel swallows frames before it says so, which a loop that runs may find first.
  goes_safe(
      [&] {
        lab->signal(SIGSTOP);
        shell("ip link set can0 down");
        lab->signal(SIGCONT);
      },
      [] { shell("ip link set can0 up"); });
  goes_safe([] { shell("tc qdisc add dev can0 root netem delay 100s limit 1"); },
            [] { shell("tc qdisc del dev can0 root; ip link set can0 up"); });
  ended_driving({Fault::bus_off, Fault::bus_down, Fault::transmit_queue_full});
}

TEST(Lab, LineOrAStoppedProcessLeavesItSafeUntilArmedAgain) {
  start(kShortLimitLines);
  goes_safe([] { pull(test::kStopLine, false); }, [] { pull(test::kStopLine, true); });
  goes_safe([] { pull(test::kHydraulicLine, false); }, [] { pull(test::kHydraulicLine, true); });
  goes_safe(
      [&] {
        lab->signal(SIGSTOP);
        shell("sleep 0.8");
        lab->signal(SIGCONT);
      },
      [] {});
  ended_driving({Fault::emergency_stop, Fault::hydraulic_enable_lost, Fault::stale_command});
}

TEST(Lab, MemoryThatGoesBadLeavesItSafeUntilArmedAgain) {
  constexpr double kAmplitude = 0.0498765;
  const auto not_a_number = std::bit_cast<double>(std::uint64_t{0x7ff8'1234'5678'9abc});
  start("segment.0.amplitude 0.0498765\n");
  goes_safe([&] { lab->change_memory(kAmplitude, not_a_number); }, [&] { lab->change_memory(not_a_number, kAmplitude); });
  // A logic whose memory is good would not have stopped there.
  ended_driving({Fault::not_finite}, "first that differs: state and first fault: recorded 4 and 14, replayed 2 and 0");
}

TEST(Lab, EmergencyStopWhileTheBusIsDownAndBothReleasedLetsNoCommandOut) {
  start();
  goes_safe(
      [] {
        shell("ip link set can0 down");
        pull(test::kStopLine, false);
      },
      [] {
        shell("ip link set can0 up");
        pull(test::kStopLine, true);
      });
  ended_driving({});
}

// On a machine this slow a cycle may overrun of itself, which is what is provoked here.
TEST(Lab, Overrun) {
  start("limits.overruns 0\n");
  wait_until("a fault", [&] {
    press();
    lab->signal(SIGSTOP);
    shell("sleep 0.2");
    lab->signal(SIGCONT);
    wait_for_beats(4);
    return carries(test::kFaultLine);
  });
  const std::uint64_t sent = commands_at_fault();
  wait_for_beats(10);
  UNSIGNED_LONGS_EQUAL(sent, node->commands);
  lab->signal(SIGTERM);
  LONGS_EQUAL(5, lab->wait());
  STRCMP_CONTAINS("interlock: fault 11, overrun", lab->output().c_str());
  CHECK(!look_at_recording().stops.empty());
}

// How a lab ends, and what its lines say: a case of its own.
TEST_GROUP_BASE(LabEnds, TEST_GROUP_CppUTestGroupLab){};

TEST(LabEnds, SignalsOfATerminalThatGoesAwayStopARunningProfile) {
  for (const int signal : {SIGHUP, SIGQUIT, SIGTSTP}) {
    start();
    run_profile();
    lab->signal(signal);
    LONGS_EQUAL(1, lab->wait());
    STRCMP_CONTAINS("a stop was requested before the profile had ended", lab->output().c_str());
    is_safe();
    lab.reset();
  }
}

TEST(LabEnds, EndOfItsCyclesStopsARunningProfileThroughTheInterlock) {
  start("", "--cycles 300");
  run_profile();
  LONGS_EQUAL(1, lab->wait());
  is_safe();
  const test::LabRecord record = look_at_recording();
  UNSIGNED_LONGS_EQUAL(0, record.stops.size());
}

TEST(LabEnds, EmergencyStopWhileStoppingIsTheVerdictAndInTheRecording) {
  start("stopping_time 5\nrest_speed 1e-9\n");
  run_profile();
  lab->signal(SIGTERM);
  wait_until("stopping", [&] { return node->state == RigState::stopping; });
  pull(test::kStopLine, false);
  LONGS_EQUAL(5, lab->wait());
  STRCMP_CONTAINS("interlock: fault 9, emergency stop", lab->output().c_str());
  is_safe();
  const test::LabRecord record = look_at_recording();
  UNSIGNED_LONGS_EQUAL(1, record.stops.size());
  CHECK(record.stops[0].fault == Fault::emergency_stop);
}

TEST(LabEnds, StopPulseThatIsShorterThanAPeriodIsAStop) {
  start();
  run_profile();
  // The loop is between two looks, so that neither sees the line off.
  lab->signal(SIGSTOP);
  pull(test::kStopLine, false);
  pull(test::kStopLine, true);
  lab->signal(SIGCONT);
  ends_safe("interlock: fault 9, emergency stop");
}

TEST(LabEnds, LoadPressureBeyondItsLimitOrSilentLeavesItSafeUntilArmedAgain) {
  node->sends_load_pressure = true;
  start(std::string(kShortLimitLines) + "limits.load_pressure 2e7\n");
  goes_safe([&] { node->load_pressure = -2.01e7; }, [&] { node->load_pressure = -1.99e7; });
  goes_safe([&] { node->sends_load_pressure = false; }, [&] { node->sends_load_pressure = true; });
  ended_driving({Fault::load_pressure, Fault::stale_sensor});
}

TEST(LabEnds, LabWithoutALimitOfLoadPressureHearsNoFrameOfIt) {
  node->sends_load_pressure = true;
  node->load_pressure = 8e7;
  start();
  run_profile();
  wait_for_beats(20);
  CHECK(node->state == RigState::running);
  lab->signal(SIGTERM);
  LONGS_EQUAL(1, lab->wait());
  UNSIGNED_LONGS_EQUAL(0, look_at_recording().stops.size());
}

TEST(LabEnds, ButtonThatBouncesArmsAndStartsNothing) {
  start();
  for (int bounce = 0; bounce < 20; ++bounce) {
    pull(test::kArmLine, bounce % 2 == 0);
    pull(test::kStartLine, bounce % 3 == 0);
    wait_for_beats(1);
  }
  pull(test::kArmLine, false);
  pull(test::kStartLine, false);
  wait_for_beats(150);
  CHECK(node->state != RigState::running);
}

TEST(LabEnds, SupplyThatDoesNotFollowItsLineIsAFault) {
  start("line.supply_read_back contactor\n");
  press();
  ends_safe("interlock: fault 17, supply read-back");
}

TEST(Lab, RecorderFull) {
  shell("mkdir -p /full; mount -t tmpfs -o size=16k full /full");
  start("", "--record /full/lab.hfr");
  arm();
  const std::uint64_t sent = commands_at_fault();
  wait_for_beats(10);
  UNSIGNED_LONGS_EQUAL(sent, node->commands);
  // A recording that has ended does not go on: arming does not restart it.
  press();
  CHECK(!carries(test::kSupplyLine));
  lab->signal(SIGTERM);
  LONGS_EQUAL(5, lab->wait());
  STRCMP_CONTAINS("interlock: fault 15, recorder full", lab->output().c_str());
  shell("umount /full");
}

}  // namespace hotfire::firmware
