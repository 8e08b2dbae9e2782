// SPDX-License-Identifier: Apache-2.0
#include "tools/study/tally/sensitivity.hpp"

#include <filesystem>
#include <fstream>

#include <CppUTest/TestHarness.h>

#include "tools/explain/policy/policy.hpp"
#include "tools/files/text/error.hpp"

namespace {

using namespace hotfire::study;

constexpr const char* kConstant = "clearly_less";

}  // namespace

TEST_GROUP(Sensitivity){};

TEST(Sensitivity, EveryConstantIsVariedBothWaysAfterThePolicyAsItIs) {
  const auto varied = variations({});
  CHECK_EQUAL(1 + 2 * hotfire::explain::kPolicyConstants.size(), varied.size());
  CHECK(varied.front().constant.empty());
  CHECK_EQUAL(std::size_t{3}, variations({kConstant}).size());
}

TEST(Sensitivity, AConstantThatThePolicyDoesNotHaveIsRefused) {
  CHECK_THROWS(hotfire::UsageError, variations({"no_such_constant"}));
}

TEST(Sensitivity, ThePolicyHasTwentyConstantsAtMost) { CHECK(hotfire::explain::kPolicyConstants.size() <= 20); }

TEST(Sensitivity, APolicyIsInForceWhileItLivesAndNoLonger) {
  const double before = hotfire::explain::policy().clearly_less;
  {
    hotfire::explain::Policy other;
    other.clearly_less = 0.5 * before;
    const hotfire::explain::WithPolicy with(other);
    DOUBLES_EQUAL(0.5 * before, hotfire::explain::policy().clearly_less, 0.0);
  }
  DOUBLES_EQUAL(before, hotfire::explain::policy().clearly_less, 0.0);
}

TEST(Sensitivity, OnlyCasesThatWereRuledOnBothWaysAreCompared) {
  const std::vector<Ruling> rulings{{"", 1.0, "a", true},         {"", 1.0, "b", false},       {"", 1.0, "c", true},
                                    {kConstant, 0.7, "a", false}, {kConstant, 0.7, "b", true}, {kConstant, 0.7, "c", true},
                                    {kConstant, 0.7, "d", true},  {kConstant, 1.4, "a", true}};
  const auto changes = changes_of(rulings, variations({kConstant}));
  CHECK_EQUAL(std::size_t{2}, changes.size());
  CHECK_EQUAL(std::size_t{1}, changes[0].worse);
  CHECK_EQUAL(std::size_t{1}, changes[0].better);
  CHECK_EQUAL(std::size_t{3}, changes[0].of);
  CHECK_EQUAL(std::size_t{0}, changes[1].worse + changes[1].better);
  CHECK_EQUAL(std::size_t{1}, changes[1].of);
}

TEST(Sensitivity, RulingsAreReadBackAndALineThatIsNoneIsRefused) {
  const auto path = std::filesystem::temp_directory_path() / "hotfire-sensitivity-test.jsonl";
  const Ruling ruling{kConstant, 0.7, "wild-1", true};
  std::ofstream(path) << json_of(ruling).dump() << '\n';
  const auto known = load_rulings(path);
  CHECK_EQUAL(std::size_t{1}, known.size());
  CHECK(known[0].constant == ruling.constant && known[0].factor == ruling.factor && known[0].name == ruling.name &&
        known[0].good);
  std::ofstream(path) << "{\"constant\": 3}\n";
  CHECK_THROWS(hotfire::FileError, load_rulings(path));
  std::filesystem::remove(path);
  CHECK(load_rulings(path).empty());
}

// Nothing is explained again that is known.
TEST(Sensitivity, ARunGoesOnFromWhatIsKnown) {
  const auto varied = variations({kConstant});
  std::vector<Ruling> known;
  for (const Variation& variation : varied) {
    known.push_back({std::string(variation.constant), variation.factor, "no_such_case", true});
  }
  int said = 0;
  const auto rulings = sensitivity({"no_such_case"}, varied, known, 1, [&](const Ruling&) { ++said; });
  CHECK_EQUAL(0, said);
  CHECK_EQUAL(known.size(), rulings.size());
}
