// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>
#include <fmt/format.h>

#include <map>

#include "tests/explain/laws/answer.hpp"

namespace {

using namespace hotfire::test;

/// What the finder says of a case as it is: every law compares with it.
const Answer& original(const LawCase& law_case) {
  static std::map<std::string, Answer> answers;
  const auto found = answers.find(law_case.name);
  return found != answers.end() ? found->second : answers.emplace(law_case.name, answer_of(law_case.make())).first->second;
}

void holds(const Transformation& transformation, std::initializer_list<const LawCase*> cases) {
  for (const LawCase* law_case : cases) {
    const Answer transformed = answer_of(transformation.apply(law_case->make()));
    const std::string text = broken(transformation, original(*law_case), transformed);
    CHECK_TEXT(text.empty(), fmt::format("{}, {}: {}", law_case->name, transformation.name, text).c_str());
  }
}

/// For the case that takes the least time; the others have their turn in the group `AtLength`.
void holds(const Transformation& transformation) { holds(transformation, {&kListed}); }

void has_its_right_answer(const LawCase& law_case) {
  const Answer& answer = original(law_case);
  if (law_case.found == nullptr) {
    STRCMP_EQUAL("nothing-missing", answer.verdict.c_str());
    LONGS_EQUAL(0, answer.finds.size());
  } else {
    LONGS_EQUAL(1, answer.finds.size());
    STRCMP_EQUAL(law_case.found, answer.finds.front().name.c_str());
    STRCMP_EQUAL(law_case.site, answer.finds.front().site.c_str());
  }
  // Else a comparison in standard errors would be of nothing.
  for (const auto& [key, value] : answer.values) {
    CHECK_TEXT(value.error > 0.0, key.c_str());
  }
}

}  // namespace

TEST_GROUP(LawsOfTheFinder){};

TEST(LawsOfTheFinder, TheListedEffectIsNamed) { has_its_right_answer(kListed); }

TEST(LawsOfTheFinder, FilesInOtherUnitsGiveTheSameAnswer) { holds(kOtherUnits); }

TEST(LawsOfTheFinder, AMirroredRigHasTheMirroredAnswer) { holds(kMirror); }

TEST(LawsOfTheFinder, TheOrderOfTheRecordsHasNoEffect) { holds(kOtherOrder); }

TEST(LawsOfTheFinder, ARecordCutInTwoGivesTheSameAnswer) { holds(kCutInTwo); }

TEST(LawsOfTheFinder, AClockThatStartsLaterGivesTheSameAnswer) { holds(kLater); }

TEST(LawsOfTheFinder, AClockThatCountsSinceTheEpochGivesTheSameAnswer) { holds(kSinceEpoch); }

TEST(LawsOfTheFinder, AChannelThatTheModelDoesNotHaveChangesNoBit) { holds(kUnusedChannel); }

TEST(LawsOfTheFinder, AChannelOfNoiseAloneChangesNoAnswer) { holds(kDeafChannel); }

TEST(LawsOfTheFinder, HalfTheRateGivesTheSameAnswerWithLargerErrors) { holds(kHalfTheRate); }

TEST(LawsOfTheFinder, TwiceTheNoiseGivesTheSameAnswerWithLargerErrors) { holds(kTwiceTheNoise); }

TEST(LawsOfTheFinder, ASmallAndFastRigHasTheSimilarAnswer) { holds(kSmallAndFastRig); }

TEST(LawsOfTheFinder, OneThreadGivesTheBitsOfTwo) { holds(kOneThread); }

TEST_GROUP(LawsOfTheFinderAtLength){};

TEST(LawsOfTheFinderAtLength, TheUnlistedTermIsFoundAndNothingWhereNothingIsMissing) {
  has_its_right_answer(kUnlisted);
  has_its_right_answer(kNull);
}

TEST(LawsOfTheFinderAtLength, AllHoldForAnUnlistedTermForNoneAndForASoftActuator) {
  for (const Transformation* transformation :
       {&kOtherUnits, &kMirror, &kOtherOrder, &kCutInTwo, &kLater, &kSinceEpoch, &kUnusedChannel, &kDeafChannel,
        &kHalfTheRate, &kTwiceTheNoise, &kSmallAndFastRig, &kOneThread}) {
    holds(*transformation, {&kUnlisted, &kNull, &kSoft});
  }
}
