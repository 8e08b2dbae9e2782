// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/interface/cases.hpp"
#include "tests/interface/importer.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::test {
namespace {

constexpr int kOk = 0;
constexpr int kDiscard = 2;
constexpr int kError = 3;

enum State { instantiated, initialization, step, terminated, failed, kStates };
constexpr std::array<const char*, kStates> kNames{"instantiated", "initialization", "step", "terminated", "failed"};

void bring(const Run& run, State state) {
  if (state >= initialization) {
    LONGS_EQUAL(kOk, run.enter());
  }
  if (state >= step) {
    LONGS_EQUAL(kOk, run.call("ExitInitializationMode"));
    LONGS_EQUAL(kOk, run.step(0.0, 1e-3));
  }
  if (state == terminated) {
    LONGS_EQUAL(kOk, run.call("Terminate"));
  }
  if (state == failed) {
    LONGS_EQUAL(kError, run.step(7.0, 1e-3));
  }
}

/// A function, the states in which the standards allow it, and a call.
struct Call {
  const char* name;
  std::array<bool, kStates> allowed;
  std::function<int(const Run&)> make;
};

/// The calls of one FMU [FMI 2.0 section 4.2.4, the table of calling sequences; FMI 3.0 sections 2.3 and 4.2.1]. What the
/// standards allow for debugging after an error is allowed. Before the initialization both versions allow what FMI 3.0
/// allows there: also to set inputs and to get parameters, which the table of FMI 2.0 does not have.
std::vector<Call> calls_of(const Fmu& fmu, int version) {
  const std::string prefix = version == 3 ? "fmi3" : "fmi2";
  const std::string state_name = version == 3 ? "FMUState" : "FMUstate";
  const auto references = [&fmu](const char* name) { return fmu.references({name}); };
  const auto set = [references](const char* name, double value) {
    return [=](const Run& run) { return run.set(references(name), {value}); };
  };
  const auto get = [references](const char* name) {
    return [=](const Run& run) {
      std::vector<double> value{0.0};
      return run.get(references(name), value);
    };
  };
  const auto named = [](const char* name) { return [name](const Run& run) { return run.call(name); }; };
  return {{"enter", {true, false, false, false, false}, [](const Run& run) { return run.enter(); }},
          {"ExitInitializationMode", {false, true, false, false, false}, named("ExitInitializationMode")},
          {"Terminate", {false, false, true, false, false}, named("Terminate")},
          {"Reset", {true, true, true, true, true}, named("Reset")},
          {"DoStep", {false, false, true, false, false}, [](const Run& run) { return run.step(1e-3, 1e-3); }},
          {"set an input", {true, true, true, false, false}, set("command", 0.01)},
          {"set a tunable parameter", {true, true, true, false, false}, set("engine.inertia", 9000.0)},
          {"get an output", {false, true, true, true, true}, get("engine")},
          {"get a parameter", {true, true, true, true, true}, get("engine.inertia")},
          {"get time", {true, true, true, true, true}, get("time")},
          {"a derivative",
           {false, true, true, true, true},
           [&fmu](const Run& run) {
             double slope = 0.0;
             return run.differentiate(fmu.reference("engine"), fmu.reference("command"), slope);
           }},
          {"get, set, free a state", {true, true, true, true, true}, [&fmu, prefix, state_name](const Run& run) {
             void* state = nullptr;
             int worst = fmu.function<int(void*, void**)>((prefix + "Get" + state_name).c_str())(run.instance(), &state);
             worst += fmu.function<int(void*, void*)>((prefix + "Set" + state_name).c_str())(run.instance(), state);
             return worst + fmu.function<int(void*, void**)>((prefix + "Free" + state_name).c_str())(run.instance(), &state);
           }}};
}

}  // namespace

TEST_GROUP(FmuStates){};

TEST(FmuStates, EveryFunctionWorksInItsStatesAndIsAnErrorWithAMessageInEveryOther) {
  const Case own = case_of("simplex", 20);
  for (const int version : {2, 3}) {
    const Fmu fmu(own, version);
    for (const Call& call : calls_of(fmu, version)) {
      for (int state = 0; state < kStates; ++state) {
        const Run run(fmu, version);
        bring(run, static_cast<State>(state));
        last_message.fill('\0');
        const std::string what = std::string(call.name) + ", " + kNames[static_cast<std::size_t>(state)];
        LONGS_EQUAL_TEXT(call.allowed[static_cast<std::size_t>(state)] ? kOk : kError, call.make(run), what.c_str());
        if (!call.allowed[static_cast<std::size_t>(state)]) {
          STRCMP_CONTAINS_TEXT("logStatusError: ", last_message.data(), what.c_str());
          STRCMP_CONTAINS_TEXT("is not allowed now; the instance is ", last_message.data(), what.c_str());
          LONGS_EQUAL_TEXT(kError, run.step(1e-3, 1e-3), what.c_str());
          LONGS_EQUAL_TEXT(kOk, run.call("Reset"), what.c_str());
          bring(run, step);
        }
      }
    }
  }
}

TEST(FmuStates, AFixedParameterIsSetBeforeTheRunOnly) {
  const Case own = case_of("direct", 20);
  for (const int version : {2, 3}) {
    const Fmu fmu(own, version);
    const std::vector<unsigned> start = fmu.references({"start.position"});
    const Run run(fmu, version);
    LONGS_EQUAL(kOk, run.set(start, {0.5}));
    LONGS_EQUAL(kOk, run.enter());
    LONGS_EQUAL(kOk, run.set(start, {0.25}));
    DOUBLES_EQUAL(0.25, run.got(fmu.references({"position"}))[0], 0.0);
    LONGS_EQUAL(kOk, run.set(start, {0.125}));
    LONGS_EQUAL(kOk, run.call("ExitInitializationMode"));
    DOUBLES_EQUAL(0.125, run.got(fmu.references({"position"}))[0], 0.0);
    LONGS_EQUAL(kError, run.set(start, {0.5}));
    STRCMP_CONTAINS("start.position: is not tunable", last_message.data());
  }
}

TEST(FmuStates, Version2NeedsAStartTimeBeforeInitialization) {
  const Fmu fmu(case_of("simplex", 20), 2);
  const Run run(fmu, 2);
  LONGS_EQUAL(kError, run.call("EnterInitializationMode"));
  STRCMP_CONTAINS("call SetupExperiment first", last_message.data());
}

TEST(FmuStates, EveryArgumentIsChecked) {
  const Case own = case_of("simplex", 20);
  for (const int version : {2, 3}) {
    const Fmu fmu(own, version);
    const std::vector<unsigned> command = fmu.references({"command"});
    const std::vector<unsigned> none;
    const auto refused = [&](int expected, const char* words, const std::function<int(const Run&)>& call) {
      const Run run(fmu, version);
      bring(run, step);
      last_message.fill('\0');
      LONGS_EQUAL_TEXT(expected, call(run), words);
      STRCMP_CONTAINS(words, last_message.data());
    };
    const double infinite = std::numeric_limits<double>::infinity();
    refused(kDiscard, "command = inf: not a finite number", [&](const Run& run) { return run.set(command, {infinite}); });
    refused(kDiscard, "command = nan: not a finite number",
            [&](const Run& run) { return run.set(command, {std::nan("")}); });
    refused(kError, "value reference 100000", [&](const Run& run) { return run.set({100'000}, {1.0}); });
    refused(kError, "value reference 0", [&](const Run& run) { return run.set({0}, {1.0}); });
    refused(kError, "an argument is missing", [&](const Run& run) { return run.set_nothing(1); });
    refused(kError, "an argument is missing", [&](const Run& run) { return run.get_nothing(1); });
    refused(kError, "communicationStepSize", [&](const Run& run) { return run.step(1e-3, 0.0); });
    refused(kError, "communicationStepSize", [&](const Run& run) { return run.step(1e-3, -1e-3); });
    refused(kError, "communicationStepSize", [&](const Run& run) { return run.step(1e-3, std::nan("")); });
    refused(kError, "communicationStepSize", [&](const Run& run) { return run.step(1e-3, infinite); });
    refused(kError, "currentCommunicationPoint = nan", [&](const Run& run) { return run.step(std::nan(""), 1e-3); });
    refused(kError, "currentCommunicationPoint = inf", [&](const Run& run) { return run.step(infinite, 1e-3); });
    refused(kError, "value reference", [&](const Run& run) {
      double slope = 0.0;
      return run.differentiate(command[0], command[0], slope);
    });
    refused(kError, "value reference", [&](const Run& run) {
      double slope = 0.0;
      return run.differentiate(fmu.reference("engine"), fmu.reference("engine"), slope);
    });
    const Run run(fmu, version);
    LONGS_EQUAL(kOk, run.set_nothing(0));
    LONGS_EQUAL(kOk, run.get_nothing(0));
    LONGS_EQUAL(kError, fmu.function<int(void*)>(version == 3 ? "fmi3Reset" : "fmi2Reset")(nullptr));
    fmu.function<void(void*)>(version == 3 ? "fmi3FreeInstance" : "fmi2FreeInstance")(nullptr);
    LONGS_EQUAL(kError, run.enter(1.0, true, 1.0));
    STRCMP_CONTAINS("a stop time after it", last_message.data());
  }
}

TEST(FmuStates, AnInstanceNeedsANameOfMoreThanSpaces) {
  const Fmu fmu(case_of("simplex", 20), 2);
  using Instantiate = fmi2Component(fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions*, int, int);
  CHECK(fmu.function<Instantiate>("fmi2Instantiate")(" \t", fmi2CoSimulation, fmu.token().c_str(),
                                                     fmu.resource_uri().c_str(), &kCallbacks, 0, 0) == nullptr);
  STRCMP_CONTAINS("the name of the instance is empty", last_message.data());
}

TEST(FmuStates, AMessageDoublesWhatTheStandardGivesAMeaning) {
  const Fmu fmu(case_of("simplex", 20), 2);
  using Instantiate = fmi2Component(fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions*, int, int);
  CHECK(fmu.function<Instantiate>("fmi2Instantiate")("one", fmi2CoSimulation, "50%s#1", fmu.resource_uri().c_str(),
                                                     &kCallbacks, 0, 0) == nullptr);
  // The importer has put the message through printf, which made one of each "%%".
  STRCMP_CONTAINS("50%s##1; allowed", last_message.data());
}

TEST(FmuStates, DerivativesInStepModeAreThoseOfTheNextInternalStep) {
  for (const char* topology : kTopologies) {
    const Case own = case_of(topology, 20);
    for (const int version : {2, 3}) {
      const Fmu fmu(own, version);
      const unsigned known = fmu.reference(own.inputs[0]);
      // Without noise, and before a delay.
      const unsigned unknown = fmu.reference(own.outputs()[own.outputs().size() > 3 ? 1 : 0]);
      const double width = 1e-5;
      const auto run_to = [&](const Run& run, double value) {
        run.enter();
        run.set({known}, {0.0});
        run.call("ExitInitializationMode");
        LONGS_EQUAL(kOk, run.step(0.0, 4.0 * own.period));
        LONGS_EQUAL(kOk, run.set({known}, {value}));
      };
      const auto reading = [&](double value) {
        const Run run(fmu, version);
        run_to(run, value);
        LONGS_EQUAL(kOk, run.step(4.0 * own.period, own.period));
        return run.got({unknown})[0];
      };
      const double expected = (reading(0.01 + width) - reading(0.01 - width)) / (2.0 * width);
      const Run run(fmu, version);
      run_to(run, 0.01);
      double slope = 0.0;
      LONGS_EQUAL(kOk, run.differentiate(unknown, known, slope));
      CHECK(std::abs(expected) > 1e-12);
      DOUBLES_EQUAL_TEXT(expected, slope, 1e-3 * std::abs(expected), topology);
    }
  }
}

TEST(FmuStates, DerivativesInInitializationAreThoseOfTheStart) {
  for (const char* topology : kTopologies) {
    const Case own = case_of(topology, 20);
    for (const int version : {2, 3}) {
      const Fmu fmu(own, version);
      const bool direct = own.topology == "direct";
      const unsigned known = fmu.reference(direct ? "start.position" : own.inputs[0]);
      const unsigned unknown = fmu.reference(direct ? "position" : own.outputs()[1]);
      const auto reading = [&](double value) {
        const Run run(fmu, version);
        run.enter();
        LONGS_EQUAL(kOk, run.set({known}, {value}));
        return run.got({unknown})[0];
      };
      const double width = 1e-5;
      const double expected = (reading(0.01 + width) - reading(0.01 - width)) / (2.0 * width);
      const Run run(fmu, version);
      run.enter();
      run.set({known}, {0.01});
      double slope = 0.0;
      LONGS_EQUAL(kOk, run.differentiate(unknown, known, slope));
      CHECK(std::abs(expected) > 0.1);
      DOUBLES_EQUAL_TEXT(expected, slope, 1e-3 * std::abs(expected), topology);
    }
  }
}

}  // namespace hotfire::test
