// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/files/scratch.hpp"
#include "tests/interface/cases.hpp"
#include "tests/interface/importer.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::test {
namespace {

/// The FMUs of all topologies in both versions, as words of a command line.
std::string exported() {
  std::string words;
  for (const Case& own : cases(20)) {
    for (const int version : {2, 3}) {
      words += " " + Fmu::kept(own, version).string() + ".fmu";
    }
  }
  return words;
}

/// The run of `hotfire simulate`, bit for bit.
void check_run(const Fmu& fmu, const Case& own, int version) {
  const Run run(fmu, version);
  const auto inputs_at = [&own](std::size_t period) {
    std::vector<double> values;
    for (const std::vector<double>& input : own.driven) {
      values.push_back(input[period]);
    }
    return values;
  };
  run.enter();
  run.set(fmu.references(own.inputs), inputs_at(0));
  LONGS_EQUAL(0, run.call("ExitInitializationMode"));
  for (std::size_t period = 0; period < own.periods(); ++period) {
    if (own.reads_at(period)) {
      const std::vector<double> expected = own.readings_at(period);
      const std::vector<double> actual = run.got(fmu.references(own.outputs()));
      MEMCMP_EQUAL(expected.data(), actual.data(), expected.size() * sizeof(double));
    }
    run.set(fmu.references(own.inputs), inputs_at(period));
    LONGS_EQUAL(0, run.step(own.period * static_cast<double>(period), own.period));
  }
}

}  // namespace

TEST_GROUP(FmuText) { Scratch scratch; };
TEST_GROUP(FmuTextAtLength) { Scratch scratch; };

TEST(FmuText, KeepsTheRulesOfTheStandards) {
  LONGS_EQUAL(0, std::system(("/usr/bin/python3 " FMU_RULES + exported()).c_str()));
}

TEST(FmuText, TheRulesFindADescriptionThatBreaksOne) {
  LONGS_EQUAL(0, std::system(("/usr/bin/python3 " FMU_RULES " --broken" + exported()).c_str()));
}

TEST(FmuTextAtLength, ItsSourcesCompileAsTheBuildDescriptionSaysAndGiveTheSameBits) {
  const Case own = case_of("simplex", 100);
  Fmu fmu(Fmu::unpacked(scratch.path(""), own, 3), 3);
  fmu.build(
      "cd sources && c++ -std=c++20 -O0 -ffp-contract=off -DFMI3_OVERRIDE_FUNCTION_PREFIX -fPIC -shared -I. fmu.cpp -o "
      "../own.so",
      "own.so");
  check_run(fmu, own, 3);
}

TEST(FmuText, ItsSourcesAreAProjectOfCMakeAndGiveTheSameBits) {
  const Case own = case_of("direct", 100);
  Fmu fmu(Fmu::unpacked(scratch.path(""), own, 2), 2);
  fmu.build("cmake -S sources -B build -DCMAKE_CXX_FLAGS=-O0 >build.log && cmake --build build >>build.log",
            "build/direct2.so");
  check_run(fmu, own, 2);
}

TEST(FmuText, ItsSourcesHaveThePrefixOfTheModelForStaticLinking) {
  const Case own = case_of("direct", 20);
  const std::string sources = Fmu::kept(own, 2).string() + "/sources";
  const std::string left = scratch.path("fmu.ii").string();
  // What the preprocessor leaves shows the name of each function, and takes a tenth of the time of a compiler.
  LONGS_EQUAL(0, std::system(("c++ -std=c++20 -E -P -I" + sources + " " + sources + "/fmu.cpp -o " + left +
                              " && grep -qw direct2_fmi2DoStep " + left + " && ! grep -qw 'fmi2[A-Z][A-Za-z]* *(' " + left)
                                 .c_str()));
}

}  // namespace hotfire::test
