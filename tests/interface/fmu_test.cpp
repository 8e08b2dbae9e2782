// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/files/scratch.hpp"
#include "tests/interface/cases.hpp"
#include "tests/interface/importer.hpp"
#include "tests/support/allocation_guard.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::test {
namespace {

std::vector<double> inputs_at(const Case& own, std::size_t period) {
  std::vector<double> values;
  for (const std::vector<double>& input : own.driven) {
    values.push_back(input[period]);
  }
  return values;
}

void check_same_bits(const std::vector<double>& expected, const std::vector<double>& actual) {
  LONGS_EQUAL(expected.size(), actual.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    MEMCMP_EQUAL(&expected[i], &actual[i], sizeof expected[i]);
  }
}

constexpr std::array<int, 2> kVersions{2, 3};

using Ids = std::vector<unsigned>;

/// Calls `check` with an FMU of every topology in both versions, and the references of its inputs and outputs.
template <class Check>
void for_every_fmu(std::size_t rows, Check&& check) {
  for (const Case& own : cases(rows)) {
    for (const int version : kVersions) {
      const Fmu fmu(own, version);
      check(own, version, fmu, fmu.references(own.inputs), fmu.references(own.outputs()));
    }
  }
}

}  // namespace

TEST_GROUP(Fmu){};

TEST(Fmu, GivesTheBitsOfHotfireSimulateForEveryTopologyInBothVersions) {
  for_every_fmu(300, [&](const Case& own, int version, const Fmu& fmu, const Ids& inputs, const Ids& outputs) {
    const Run run(fmu, version);
    LONGS_EQUAL(0, run.enter());
    LONGS_EQUAL(0, run.set(inputs, inputs_at(own, 0)));
    LONGS_EQUAL(0, run.call("ExitInitializationMode"));
    double time = 0.0;
    for (std::size_t period = 0; period < own.periods(); ++period) {
      if (own.reads_at(period)) {
        check_same_bits(own.readings_at(period), run.got(outputs));
      }
      LONGS_EQUAL(0, run.set(inputs, inputs_at(own, period)));
      LONGS_EQUAL(0, run.step(time, own.period));
      time += own.period;
    }
    LONGS_EQUAL(0, run.call("Terminate"));
  });
}

TEST(Fmu, TakesNoMemoryInAHundredThousandStepsOfEveryTopology) {
  if (!AllocationGuard::available) {
    return;
  }
  for_every_fmu(20, [&](const Case& own, int version, const Fmu& fmu, const Ids& inputs, const Ids& outputs) {
    const Run run(fmu, version);
    run.enter();
    run.call("ExitInitializationMode");
    std::vector<double> values(inputs.size());
    std::vector<double> readings(outputs.size());
    const AllocationGuard guard;
    int worst = 0;
    for (int i = 0; i < 100'000; ++i) {
      for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] = own.driven[k][static_cast<std::size_t>(i) % own.periods()];
      }
      worst = std::max(worst, run.set(inputs, values));
      worst = std::max(worst, run.step(i * own.period, own.period));
      worst = std::max(worst, run.get(outputs, readings));
    }
    LONGS_EQUAL(0, guard.allocations());
    LONGS_EQUAL(0, worst);
  });
}

TEST(Fmu, InstancesInThreadsGiveTheBitsOfOneAlone) {
  for_every_fmu(150, [&](const Case& own, int version, const Fmu& fmu, const Ids& inputs, const Ids& outputs) {
    // No two instances have the same inputs.
    const auto drive = [&](const Run& run, int instance) {
      double last = 0.0;
      bool uneventful = true;
      run.enter();
      run.call("ExitInitializationMode");
      for (int i = 0; i < 400; ++i) {
        run.set(inputs, std::vector<double>(inputs.size(), 0.01 * std::sin(0.02 * i * (instance + 1))));
        run.advance(i * own.period, own.period, last, uneventful);
      }
    };
    std::vector<std::unique_ptr<Run>> together;
    std::vector<std::thread> threads;
    for (int instance = 0; instance < 6; ++instance) {
      together.push_back(std::make_unique<Run>(fmu, version));
    }
    for (int instance = 0; instance < 6; ++instance) {
      threads.emplace_back([&, instance] { drive(*together[static_cast<std::size_t>(instance)], instance); });
    }
    for (std::thread& thread : threads) {
      thread.join();
    }
    for (int instance = 0; instance < 6; ++instance) {
      const Run alone(fmu, version);
      drive(alone, instance);
      check_same_bits(alone.got(outputs), together[static_cast<std::size_t>(instance)]->got(outputs));
    }
    CHECK(together[0]->got(outputs) != together[1]->got(outputs));
  });
}

TEST(Fmu, StepsThatAreNoMultiplesOfTheInternalStepReachTheSameReadings) {
  const Case own = cases(20)[0];
  for (const int version : kVersions) {
    const Fmu fmu(own, version);
    const Run fine(fmu, version);
    const Run coarse(fmu, version);
    const std::vector<unsigned> command = fmu.references({"command"});
    const std::vector<unsigned> outputs = fmu.references(own.outputs());
    for (const Run* run : {&fine, &coarse}) {
      run->enter(5.0);
      run->call("ExitInitializationMode");
      run->set(command, {0.01});
    }
    double time = 5.0;
    for (int i = 0; i < 1000; ++i) {
      LONGS_EQUAL(0, fine.step(time, 0.0003));
      time += 0.0003;
    }
    LONGS_EQUAL(0, coarse.step(5.0, 0.3));
    check_same_bits(coarse.got(outputs), fine.got(outputs));
    DOUBLES_EQUAL(5.3, fine.got({0})[0], 1e-9);
  }
}

TEST(Fmu, AStateGoesOnWithTheSameBitsAfterBytesOfAnotherInstance) {
  const Case own = cases(20)[2];
  for (const int version : kVersions) {
    const Fmu fmu(own, version);
    const Run one(fmu, version);
    const Run other(fmu, version);
    const std::string prefix = version == 3 ? "fmi3" : "fmi2";
    const std::string state_name = version == 3 ? "FMUState" : "FMUstate";
    const std::vector<unsigned> command = fmu.references({"command.pitch"});
    const std::vector<unsigned> outputs = fmu.references(own.outputs());
    one.enter();
    one.call("ExitInitializationMode");
    one.set(command, {0.02});
    one.step(0.0, 0.05);
    void* state = nullptr;
    const auto call = [&](const std::string& name) { return prefix + name; };
    LONGS_EQUAL(0, fmu.function<int(void*, void**)>(call("Get" + state_name).c_str())(one.instance(), &state));
    std::size_t size = 0;
    LONGS_EQUAL(0, fmu.function<int(void*, void*, std::size_t*)>(call("Serialized" + state_name + "Size").c_str())(
                       one.instance(), state, &size));
    std::vector<char> bytes(size);
    LONGS_EQUAL(0, fmu.function<int(void*, void*, char*, std::size_t)>(call("Serialize" + state_name).c_str())(
                       one.instance(), state, bytes.data(), size));
    void* copy = nullptr;
    const std::string deserialize = version == 3 ? "fmi3DeserializeFMUState" : "fmi2DeSerializeFMUstate";
    LONGS_EQUAL(0, fmu.function<int(void*, const char*, std::size_t, void**)>(deserialize.c_str())(
                       other.instance(), bytes.data(), size, &copy));
    LONGS_EQUAL(0, fmu.function<int(void*, void*)>(call("Set" + state_name).c_str())(other.instance(), copy));
    LONGS_EQUAL(0, one.step(0.05, 0.05));
    LONGS_EQUAL(0, other.step(0.05, 0.05));
    check_same_bits(one.got(outputs), other.got(outputs));
    const auto release = fmu.function<int(void*, void**)>(call("Free" + state_name).c_str());
    LONGS_EQUAL(0, release(one.instance(), &state));
    LONGS_EQUAL(0, release(other.instance(), &copy));
    CHECK(state == nullptr && copy == nullptr);
    LONGS_EQUAL(0, release(one.instance(), &state));
  }
}

TEST(Fmu, ADamagedStateIsRefusedAndChangesNothing) {
  const Case own = cases(20)[0];
  for (const int version : kVersions) {
    const Fmu fmu(own, version);
    const Run run(fmu, version);
    const std::string prefix = version == 3 ? "fmi3" : "fmi2";
    const std::string state_name = version == 3 ? "FMUState" : "FMUstate";
    const auto serialized_size =
        fmu.function<int(void*, void*, std::size_t*)>((prefix + "Serialized" + state_name + "Size").c_str());
    const auto serialize = fmu.function<int(void*, void*, char*, std::size_t)>((prefix + "Serialize" + state_name).c_str());
    const auto deserialize = fmu.function<int(void*, const char*, std::size_t, void**)>(
        version == 3 ? "fmi3DeserializeFMUState" : "fmi2DeSerializeFMUstate");
    const auto set = fmu.function<int(void*, void*)>((prefix + "Set" + state_name).c_str());
    run.enter();
    run.call("ExitInitializationMode");
    run.step(0.0, 0.05);
    void* state = nullptr;
    LONGS_EQUAL(0, fmu.function<int(void*, void**)>((prefix + "Get" + state_name).c_str())(run.instance(), &state));
    std::size_t size = 0;
    LONGS_EQUAL(0, serialized_size(run.instance(), state, &size));
    std::vector<char> bytes(size);
    LONGS_EQUAL(0, serialize(run.instance(), state, bytes.data(), size));
    constexpr std::size_t kHead = 128;  // what an FMU adds to the model's state, and the head of that
    for (std::size_t at = 0; at < size; at += at < kHead ? 1 : 41) {
      std::vector<char> damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ 0x01);
      LONGS_EQUAL(0, deserialize(run.instance(), damaged.data(), size, &state));
      LONGS_EQUAL_TEXT(3, set(run.instance(), state), std::to_string(at).c_str());
      // A state is what an instance waits for after an error.
      LONGS_EQUAL(0, deserialize(run.instance(), bytes.data(), size, &state));
      LONGS_EQUAL(0, set(run.instance(), state));
    }
    LONGS_EQUAL(0, run.step(0.05, 0.05));
    LONGS_EQUAL(0, fmu.function<int(void*, void**)>((prefix + "Free" + state_name).c_str())(run.instance(), &state));
  }
}

TEST(Fmu, ARefusedValueChangesNoneOfTheOthersOfItsCall) {
  const Case own = cases(20)[0];
  for (const int version : kVersions) {
    const Fmu fmu(own, version);
    const Run run(fmu, version);
    run.enter();
    const double inertia = run.got(fmu.references({"engine.inertia"}))[0];
    constexpr int kDiscard = 2;
    LONGS_EQUAL(kDiscard, run.set(fmu.references({"engine.inertia", "command"}), {0.5 * inertia, std::nan("")}));
    DOUBLES_EQUAL(inertia, run.got(fmu.references({"engine.inertia"}))[0], 0.0);
    LONGS_EQUAL(kDiscard, run.set(fmu.references({"command", "engine.inertia"}), {0.01, -1.0}));
    DOUBLES_EQUAL(inertia, run.got(fmu.references({"engine.inertia"}))[0], 0.0);
    DOUBLES_EQUAL(0.0, run.got(fmu.references({"command"}))[0], 0.0);
    LONGS_EQUAL(0, run.set(fmu.references({"command", "engine.inertia"}), {0.01, 0.5 * inertia}));
    DOUBLES_EQUAL(0.5 * inertia, run.got(fmu.references({"engine.inertia"}))[0], 0.0);
  }
}

TEST(Fmu, ResetGivesTheRunOfAFreshInstance) {
  const Case own = cases(20)[0];
  for (const int version : kVersions) {
    const Fmu fmu(own, version);
    const Run run(fmu, version);
    const std::vector<unsigned> outputs = fmu.references(own.outputs());
    const auto once = [&](double inertia) {
      LONGS_EQUAL(0, inertia > 0.0 ? run.set(fmu.references({"engine.inertia"}), {inertia}) : 0);
      run.enter();
      run.call("ExitInitializationMode");
      run.set(fmu.references({"command"}), {0.02});
      LONGS_EQUAL(0, run.step(0.0, 0.06));
      return run.got(outputs);
    };
    const std::vector<double> first = once(0.0);
    LONGS_EQUAL(0, run.call("Reset"));
    const std::vector<double> heavier = once(15000.0);
    CHECK(heavier[1] != first[1]);
    LONGS_EQUAL(0, run.call("Reset"));
    check_same_bits(first, once(0.0));
  }
}

TEST(Fmu, RefusesAsTheStandardsSay) {
  const Case own = cases(20)[0];
  for (const int version : kVersions) {
    const Fmu fmu(own, version);
    constexpr int kDiscard = 2;
    constexpr int kError = 3;
    std::vector<double> value{0.0};
    {
      const Run run(fmu, version);
      LONGS_EQUAL(kError, run.step(0.0, 1e-3));
      STRCMP_CONTAINS("logStatusError: DoStep: is not allowed now", last_message.data());
    }
    {
      const Run run(fmu, version);
      LONGS_EQUAL(kDiscard, run.set(fmu.references({"engine.inertia"}), {-1.0}));
      STRCMP_CONTAINS("engine.inertia = -1: outside its bounds; allowed: 1e-06 to 1e+09 kg.m^2", last_message.data());
      LONGS_EQUAL(0, run.enter(0.0, true, 0.01));
      LONGS_EQUAL(0, run.call("ExitInitializationMode"));
      LONGS_EQUAL(0, run.step(0.0, 0.01));
      LONGS_EQUAL(kError, run.step(0.01, 0.01));
      STRCMP_CONTAINS("stop time", last_message.data());
    }
    {
      const Run run(fmu, version);
      LONGS_EQUAL(kError, run.get({100'000}, value));
    }
    {
      const Run run(fmu, version);
      LONGS_EQUAL(kError, run.set(fmu.references({"engine"}), {1.0}));
    }
    {
      const Run run(fmu, version);
      run.enter();
      run.call("ExitInitializationMode");
      LONGS_EQUAL(kError, run.step(0.5, 1e-3));
      STRCMP_CONTAINS("currentCommunicationPoint", last_message.data());
      LONGS_EQUAL(kError, run.step(0.0, 1e-3));
      LONGS_EQUAL(0, run.call("Reset"));
      run.enter();
      run.call("ExitInitializationMode");
      LONGS_EQUAL(0, run.step(0.0, 1e-3));
    }
  }
}

TEST(Fmu, RefusesAForeignTokenAndOtherInterfaces) {
  const Case own = cases(20)[0];
  const Fmu three(own, 3);
  using Instantiate3 = fmi3Instance(fmi3String, fmi3String, fmi3String, bool, bool, bool, bool, const unsigned*, std::size_t,
                                    void*, fmi3LogMessageCallback, fmi3IntermediateUpdateCallback);
  CHECK(three.function<Instantiate3>("fmi3InstantiateCoSimulation")("one", "{foreign}", three.resource_path().c_str(), false,
                                                                    false, false, false, nullptr, 0, nullptr, log3,
                                                                    nullptr) == nullptr);
  STRCMP_CONTAINS("{foreign}; allowed: {", last_message.data());
  using Instantiate = fmi3Instance(fmi3String, fmi3String, fmi3String, bool, bool, void*, fmi3LogMessageCallback);
  CHECK(three.function<Instantiate>("fmi3InstantiateModelExchange")("one", "", "", false, false, nullptr, log3) == nullptr);
  STRCMP_CONTAINS("co-simulation only", last_message.data());
  const Fmu two(own, 2);
  using Instantiate2 = fmi2Component(fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions*, int, int);
  CHECK(two.function<Instantiate2>("fmi2Instantiate")("one", fmi2ModelExchange, two.token().c_str(),
                                                      two.resource_uri().c_str(), &kCallbacks, 0, 0) == nullptr);
  CHECK(two.function<Instantiate2>("fmi2Instantiate")("one", fmi2CoSimulation, two.token().c_str(), "file:///no/such",
                                                      &kCallbacks, 0, 0) == nullptr);
  STRCMP_CONTAINS("/no/such/plant.txt: cannot be read", last_message.data());
}

TEST(Fmu, TheSameModelGivesTheSameBytes) {
  const Scratch scratch;
  const Case own = cases(20)[0];
  const auto exported = [&] { return content_of(Fmu::unpacked(scratch.path(""), own, 3).string() + ".fmu"); };
  const std::string first = exported();
  CHECK(first == exported());
}

}  // namespace hotfire::test
