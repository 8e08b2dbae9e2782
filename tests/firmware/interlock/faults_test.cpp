// SPDX-License-Identifier: Apache-2.0
#include "firmware/interlock/faults.hpp"

#include <CppUTest/TestHarness.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "firmware/interlock/fault_checks.hpp"

namespace hotfire::firmware {

namespace {

constexpr double kFaultsPeriod = 1e-3;
constexpr ActuatorLimits kActuatorLimits{3'000'000, -0.1, 0.1, 1000.0};
constexpr FaultLimits kLimits = [] {
  FaultLimits limits{5'000'000, -0.2, 0.2, 1e-3, 1.0, 0.01, 20, 5, 3};
  limits.actuators.fill(kActuatorLimits);
  return limits;
}();
const double kNan = std::numeric_limits<double>::quiet_NaN();

/// The sections of docs/faults.md below its second level headings, each with its heading first.
std::vector<std::string> sections() {
  std::ifstream file(HOTFIRE_FAULTS_PAGE);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::string> found;
  for (std::size_t at = text.find("\n## "); at != std::string::npos;) {
    const std::size_t next = text.find("\n## ", at + 1);
    found.push_back(text.substr(at + 4, next == std::string::npos ? next : next - at - 4));
    at = next;
  }
  return found;
}

}  // namespace

TEST_GROUP(Faults) {
  FaultChecks checks{kLimits, kFaultsPeriod};
  ObservedRig rig;
  std::vector<ObservedActuator> actuators{8};

  void expect(FaultSet faults) { CHECK(checks.look(rig, actuators) == faults); }
};

TEST(Faults, NumbersRiseAndNamesAreDifferentAndEachIsFoundByItsNumber) {
  for (std::size_t i = 0; i < kFaults.size(); ++i) {
    CHECK(static_cast<std::size_t>(kFaults[i].fault) < kFaultNumbers);
    CHECK(&firmware::text_of(kFaults[i].fault) == &kFaults[i]);
    CHECK(FaultSet::all().has(kFaults[i].fault));
    for (std::size_t j = 0; j < i; ++j) {
      CHECK(kFaults[i].fault > kFaults[j].fault);
      CHECK(kFaults[i].name != kFaults[j].name);
    }
  }
  UNSIGNED_LONGS_EQUAL(kFaults.size(), FaultSet::all().count());
}

TEST(Faults, EveryFaultHasASectionThatSaysWhatItMeansWhatTheRigDidAndWhatToDo) {
  const std::vector<std::string> found = sections();
  UNSIGNED_LONGS_EQUAL(kFaults.size(), found.size());
  for (std::size_t i = 0; i < kFaults.size(); ++i) {
    const std::string heading =
        std::to_string(static_cast<unsigned>(kFaults[i].fault)) + " " + std::string(kFaults[i].name) + "\n";
    STRCMP_EQUAL(heading.c_str(), found[i].substr(0, heading.size()).c_str());
    for (const char* part : {"**Means.** ", "**The rig** ", "**To do.** "}) {
      STRCMP_CONTAINS(part, found[i].c_str());
    }
  }
}

TEST(Faults, NothingIsFoundOnAHealthyRigNotEvenAtTheLimits) {
  expect({});
  rig.command_age_ns = kLimits.command_age_ns;
  actuators[7].reading_ages_ns = {kActuatorLimits.reading_age_ns, kActuatorLimits.reading_age_ns};
  actuators[7].readings = {0.0, kLimits.disagreement};
  expect({});
}

TEST(Faults, EachSignalOfTheRigIsItsOwnFault) {
  const std::vector<std::pair<Fault, void (*)(ObservedRig&)>> signals{
      {Fault::stale_command, [](ObservedRig& r) { r.command_age_ns = kLimits.command_age_ns + 1; }},
      {Fault::bad_frame, [](ObservedRig& r) { r.bad_frame = true; }},
      {Fault::second_sender, [](ObservedRig& r) { r.second_sender = true; }},
      {Fault::command_not_answered, [](ObservedRig& r) { r.command_not_answered = true; }},
      {Fault::not_authentic, [](ObservedRig& r) { r.not_authentic = true; }},
      {Fault::bus_off, [](ObservedRig& r) { r.bus_off = true; }},
      {Fault::bus_down, [](ObservedRig& r) { r.bus_down = true; }},
      {Fault::transmit_queue_full, [](ObservedRig& r) { r.transmit_queue_full = true; }},
      {Fault::emergency_stop, [](ObservedRig& r) { r.emergency_stop = true; }},
      {Fault::hydraulic_enable_lost, [](ObservedRig& r) { r.hydraulic_enable = false; }},
      {Fault::overrun, [](ObservedRig& r) { r.overrun = true; }},
      {Fault::take_back_refused, [](ObservedRig& r) { r.take_back_refused = true; }},
      {Fault::recorder_full, [](ObservedRig& r) { r.dropped_recording = true; }}};
  for (const auto& [fault, set] : signals) {
    rig = {};
    set(rig);
    expect(fault);
  }
}

TEST(Faults, OldReadingOfAnyActuatorIsStale) {
  actuators[5].reading_ages_ns[1] = kActuatorLimits.reading_age_ns + 1;
  expect(Fault::stale_sensor);
}

TEST(Faults, ReadingThatTheSensorCannotGiveIsOutOfRangeAndBeyondTheLimit) {
  actuators[2].readings = {0.21, 0.21};
  actuators[2].command = 0.1;
  const FaultSet found = checks.look(rig, actuators);
  CHECK(found.has(Fault::out_of_range) && found.has(Fault::limit));
}

TEST(Faults, RedundantReadingsThatAreTooFarApartDisagree) {
  actuators[0].readings = {0.0, 1.01e-3};
  expect(Fault::readings_disagree);
}

TEST(Faults, PositionCommandAndItsRateAreLimited) {
  actuators[0].readings = {0.11, 0.11};
  actuators[0].command = 0.1;
  expect(Fault::limit);
  checks.forget();
  actuators[0] = {};
  actuators[0].command = 0.101;
  expect(Fault::limit);
  checks.forget();
  actuators[0].command = 0.0;
  expect({});
  actuators[0].command = 1.001e-3;
  expect(Fault::limit);
}

TEST(Faults, EveryActuatorHasItsOwnLimitsOfPositionSpeedAndAge) {
  FaultLimits own = kLimits;
  own.actuators[3] = {1'000'000, -0.01, 0.02, 0.5};
  checks = FaultChecks(own, kFaultsPeriod);
  for (const std::size_t i : {2, 3}) {
    const bool narrow = i == 3;
    actuators[i].readings = {0.03, 0.03};
    expect(narrow ? FaultSet(Fault::limit) : FaultSet());
    actuators[i].readings = {-0.02, -0.02};
    expect(narrow ? FaultSet(Fault::limit) : FaultSet());
    actuators[i] = {};
    actuators[i].reading_ages_ns[0] = 2'000'000;
    expect(narrow ? FaultSet(Fault::stale_sensor) : FaultSet());
    actuators[i] = {};
  }
}

TEST(Faults, MeasuredSpeedIsThatOverItsTimeAndLimited) {
  FaultLimits own = kLimits;
  own.actuators[1].speed = 0.5;
  own.position_error = 1.0;
  checks = FaultChecks(own, kFaultsPeriod);
  const auto move = [&](double speed, int cycles) {
    FaultSet found;
    for (int i = 0; i < cycles; ++i) {
      for (double& reading : actuators[1].readings) {
        reading += speed * kFaultsPeriod;
      }
      found |= checks.look(rig, actuators);
    }
    return found;
  };
  CHECK(!move(0.49, 40).any());
  CHECK(!move(-0.49, 40).any());
  CHECK(move(0.51, 4) == FaultSet());
  // A single step of the reading is no speed; what lasts is.
  CHECK(!move(0.0, 10).any());
  CHECK(!move(2.4, 1).any());
  CHECK(!move(0.0, 10).any());
  CHECK(move(0.51, 5) == FaultSet(Fault::speed));
  CHECK(!move(0.0, 10).has(Fault::readings_disagree));
  CHECK(move(-0.51, 5) == FaultSet(Fault::speed));
}

TEST(Faults, LoadPressureOfEveryActuatorHasItsOwnLimitEitherWayAndAnAge) {
  CHECK(!kLimits.has_load_pressure());
  FaultLimits own = kLimits;
  for (std::size_t i = 0; i < hal::kMaxActuators; ++i) {
    own.actuators[i].load_pressure = 1e6 * static_cast<double>(i + 1);
  }
  CHECK(own.has_load_pressure());
  checks = FaultChecks(own, kFaultsPeriod);
  for (std::size_t i = 0; i < hal::kMaxActuators; ++i) {
    for (const double way : {1.0, -1.0}) {
      actuators[i].load_pressure = way * own.actuators[i].load_pressure;
      expect({});
      actuators[i].load_pressure += way;
      expect(Fault::load_pressure);
    }
    actuators[i].load_pressure = kNan;
    expect(Fault::not_finite);
    actuators[i].load_pressure = 0.0;
    actuators[i].load_pressure_age_ns = kActuatorLimits.reading_age_ns;
    expect({});
    ++actuators[i].load_pressure_age_ns;
    expect(Fault::stale_sensor);
    actuators[i] = {};
  }
}

TEST(Faults, LineThatReadsBackOtherThanItIsSetIsAFaultOnceAContactorHasHadItsTime) {
  const std::vector<std::pair<Fault, bool ObservedRig::*>> lines{
      {Fault::supply_read_back, &ObservedRig::supply_reads_other},
      {Fault::fault_read_back, &ObservedRig::fault_line_reads_other}};
  for (const auto& [fault, line] : lines) {
    for (int again = 0; again < 2; ++again) {
      rig = {};
      expect({});
      rig.*line = true;
      for (std::uint64_t i = 0; i < kLimits.read_back_cycles; ++i) {
        expect({});
      }
    }
    expect(fault);
  }
}

TEST(Faults, ActuatorThatLagsIsNoFaultUntilItHasLaggedForLongerThanAllowed) {
  actuators[3].command = 0.05;
  for (std::uint64_t cycle = 0; cycle < kLimits.position_error_cycles; ++cycle) {
    expect({});
  }
  actuators[3].readings = {0.05, 0.05};
  expect({});
  actuators[3].readings = {};
  for (std::uint64_t cycle = 0; cycle < kLimits.position_error_cycles; ++cycle) {
    expect({});
  }
  expect(Fault::position_error);
}

TEST(Faults, ValueThatIsNotFiniteIsThatFaultAndNoOther) {
  actuators[1].readings[0] = kNan;
  expect(Fault::not_finite);
  actuators[1] = {};
  actuators[1].command = kNan;
  expect(Fault::not_finite);
  actuators[1].command = std::numeric_limits<double>::infinity();
  expect(Fault::not_finite);
  actuators[1] = {};
  expect({});
}

}  // namespace hotfire::firmware
