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

void holds_for_short_cases(const Transformation& transformation) { holds(transformation, {&kListed, &kUnlisted, &kNull}); }

}  // namespace

TEST_GROUP(LawsOfTheFinder){};

TEST(LawsOfTheFinder, TheCasesHaveTheirRightAnswers) {
  for (const LawCase* law_case : {&kListed, &kUnlisted, &kNull}) {
    const Answer& answer = original(*law_case);
    if (law_case->found == nullptr) {
      STRCMP_EQUAL("nothing-missing", answer.verdict.c_str());
      LONGS_EQUAL(0, answer.finds.size());
    } else {
      LONGS_EQUAL(1, answer.finds.size());
      STRCMP_EQUAL(law_case->found, answer.finds.front().name.c_str());
      STRCMP_EQUAL(law_case->site, answer.finds.front().site.c_str());
    }
    // Else a comparison in standard errors would be of nothing.
    for (const auto& [key, value] : answer.values) {
      CHECK_TEXT(value.error > 0.0, key.c_str());
    }
  }
}

TEST(LawsOfTheFinder, FilesInOtherUnitsGiveTheSameAnswer) { holds_for_short_cases(kOtherUnits); }

TEST(LawsOfTheFinder, AMirroredRigHasTheMirroredAnswer) { holds_for_short_cases(kMirror); }

TEST(LawsOfTheFinder, TheOrderOfTheRecordsHasNoEffect) { holds_for_short_cases(kOtherOrder); }

TEST(LawsOfTheFinder, ARecordCutInTwoGivesTheSameAnswer) { holds_for_short_cases(kCutInTwo); }

TEST(LawsOfTheFinder, AClockThatStartsLaterGivesTheSameAnswer) { holds_for_short_cases(kLater); }

TEST(LawsOfTheFinder, AClockThatCountsSinceTheEpochGivesTheSameAnswer) { holds_for_short_cases(kSinceEpoch); }

TEST(LawsOfTheFinder, AChannelThatTheModelDoesNotHaveChangesNoBit) { holds_for_short_cases(kUnusedChannel); }

TEST(LawsOfTheFinder, AChannelOfNoiseAloneChangesNoAnswer) { holds_for_short_cases(kDeafChannel); }

TEST(LawsOfTheFinder, HalfTheRateGivesTheSameAnswerWithLargerErrors) { holds_for_short_cases(kHalfTheRate); }

TEST(LawsOfTheFinder, TwiceTheNoiseGivesTheSameAnswerWithLargerErrors) { holds_for_short_cases(kTwiceTheNoise); }

TEST(LawsOfTheFinder, ASmallAndFastRigHasTheSimilarAnswer) {
  // A load and a stiffness start at sizes of the rig; the effects of the other cases have none.
  holds(kSmallAndFastRig, {&kListed, &kUnlisted, &kNull, &kSoft});
}

TEST(LawsOfTheFinder, OneThreadGivesTheBitsOfTwo) { holds_for_short_cases(kOneThread); }

TEST_GROUP(LawsOfTheFinderAtLength){};

TEST(LawsOfTheFinderAtLength, AllHoldForASoftActuator) {
  for (const Transformation* transformation :
       {&kOtherUnits, &kMirror, &kOtherOrder, &kCutInTwo, &kLater, &kSinceEpoch, &kUnusedChannel, &kDeafChannel,
        &kHalfTheRate, &kTwiceTheNoise, &kSmallAndFastRig, &kOneThread}) {
    holds(*transformation, {&kSoft});
  }
}
