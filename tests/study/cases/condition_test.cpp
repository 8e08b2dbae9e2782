// SPDX-License-Identifier: Apache-2.0
#include "tools/study/cases/condition.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>
#include <set>

#include "tests/support/refusal.hpp"
#include "tools/explain/data/dataset.hpp"
#include "tools/explain/data/statistics.hpp"
#include "tools/files/text/error.hpp"
#include "tools/study/cases/orders.hpp"
#include "tools/study/cases/recording.hpp"

namespace hotfire::study {
namespace {

/// At rest for a second, then a step; as long as three seconds of a record are.
std::vector<Profile> step() {
  std::vector<double> commands(1500, 0.5 * kDegree);
  std::fill_n(commands.begin(), 500, 0.0);
  return {{"step", commands}};
}

/// An order and its like without the condition: same name and seed, so the same random streams.
Record record_under(const char* condition, const std::vector<Profile>& profiles) {
  CaseOrder order{"any", {}, 1};
  order.condition = condition;
  return recorded(order, {}, profiles).records.front();
}

const std::vector<double>& values(const Record& record, const char* channel) { return record.find(channel)->values; }

}  // namespace

TEST_GROUP(Conditions){};

TEST(Conditions, TheUsualOneDrivesARigThroughTheGivenProfiles) {
  const std::vector<Profile> usual = given_profiles(Random("any", 2, 3));
  const std::vector<Profile> profiles = conditioned_profiles(condition_of(""), "any", 2);
  CHECK_EQUAL(usual.size(), profiles.size());
  for (std::size_t i = 0; i < usual.size(); ++i) {
    CHECK_TRUE(usual[i].commands == profiles[i].commands && usual[i].name == profiles[i].name);
  }
}

TEST(Conditions, ASlowRecordHoldsEveryTenthCommandAndAFastOneEveryCommandForTenRows) {
  const std::vector<Profile> usual = given_profiles(Random("any", 1, 3));
  const std::vector<double> slow = conditioned_profiles(condition_of("50-hertz"), "any", 1)[1].commands;
  CHECK_EQUAL(usual[1].commands.size() / 10, slow.size());
  const std::vector<double> fast = conditioned_profiles(condition_of("5-kilohertz"), "any", 1).front().commands;
  CHECK_EQUAL(usual[1].commands.size() * 10, fast.size());
  for (std::size_t i = 0; i < slow.size(); ++i) {
    CHECK_EQUAL(usual[1].commands[10 * i], slow[i]);
  }
  for (std::size_t i = 0; i < fast.size(); ++i) {
    CHECK_EQUAL(usual[1].commands[i / 10], fast[i]);
  }
}

TEST(Conditions, TenRecordsAreOfTenLengthsAndNamesAndBeginAtRest) {
  std::set<std::size_t> lengths;
  std::set<std::string> names;
  for (const Profile& profile : conditioned_profiles(condition_of("ten-records"), "any", 1)) {
    lengths.insert(profile.commands.size());
    names.insert(profile.name);
    CHECK_EQUAL(0.0, profile.commands.front());
  }
  CHECK_TRUE(names.size() == 10 && lengths.size() >= 9);
}

TEST(Conditions, AnUnknownOneIsRefusedWithThoseThatThereAre) {
  STRCMP_CONTAINS("50-hertz, 5-kilohertz", test::refusal<UsageError>([] { condition_of("1-hertz"); }).c_str());
}

TEST(Conditions, EachIsMetWithAnEffectThatChangesWithTheSeedAndWithNothingMissing) {
  const std::vector<CaseOrder> first = hard_orders({1, 1, {}});
  const std::vector<CaseOrder> second = hard_orders({2, 1, {}});
  CHECK_EQUAL(2 * hard_conditions().size(), first.size());
  for (std::size_t i = 0; i < first.size(); i += 2) {
    CHECK_TRUE(first[i].effects != second[i].effects && first[i].condition == second[i].condition);
    CHECK_TRUE(first[i + 1].effects.empty() && first[i + 1].condition == first[i].condition);
  }
}

TEST(Conditions, AControllerSendsWhatItMakesOfItsReadingsAndTheAxisFollowsThat) {
  const Record record = record_under("closed-loop", step());
  const std::vector<double> asked = step().front().commands;
  const std::vector<double>& sent = values(record, "command");
  for (std::size_t i = 0; i < asked.size(); ++i) {
    DOUBLES_EQUAL(asked[i] + 0.3 * (asked[i] - values(record, "engine")[i]), sent[i], 1e-12);
  }
  const ReferenceRows rows = study::run({}, {"sent", sent});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // Six standard deviations of the noise, and half a quantum.
    DOUBLES_EQUAL(rows[i][0], values(record, "piston")[i], 6.0 * 8e-6 + 2.5e-6);
  }
}

TEST(Conditions, AFaultIsInTheEnginesChannelAndInNoOther) {
  const Record usual = record_under("", step());
  const Record late = record_under("clock-offset", step());
  const Record scaled = record_under("mis-scaled", step());
  CHECK_TRUE(values(usual, "piston") == values(late, "piston") && values(usual, "piston") == values(scaled, "piston"));
  // The noise of two rows, six standard deviations each, and a quantum.
  const double close = 6.0 * std::sqrt(2.0) * 6e-5 + 2e-5;
  for (std::size_t i = 2; i < usual.rows; ++i) {
    DOUBLES_EQUAL(values(usual, "engine")[i - 2], values(late, "engine")[i], close);
    DOUBLES_EQUAL(1.05 * values(usual, "engine")[i], values(scaled, "engine")[i], close);
  }
}

TEST(Conditions, ARecordThatStartsInMotionIsTheEndOfAWholeOne) {
  std::vector<Profile> twice = step();
  const std::vector<double> once = twice.front().commands;
  twice.front().commands.insert(twice.front().commands.end(), once.begin(), once.end());
  const Record whole = record_under("", twice);
  const Record cut = record_under("moving-start", twice);
  DOUBLES_EQUAL(5.4, cut.start, 1e-9);
  CHECK_EQUAL(300U, cut.rows);
  for (std::size_t i = 0; i < cut.rows; ++i) {
    CHECK_EQUAL(values(whole, "engine")[2700 + i], values(cut, "engine")[i]);
  }
}

TEST(Conditions, ColouredNoiseIsAsLargeAsTheUsualAndForgetsItselfAsItsCornerSays) {
  const Record record = record_under("coloured-noise", {{"rest", std::vector<double>(10'000, 0.0)}});
  const std::vector<double>& engine = values(record, "engine");
  const double stays = std::exp(-2.0 * std::numbers::pi * 20.0 * kSample);
  // The quantum adds a twelfth of its square, white. The rms of n rows with such a memory is told to
  // sqrt((1 + a^2) / (1 - a^2) / 2n), the first lag's share to sqrt((1 - a^2) / n): five standard deviations.
  const double quantum = 2e-5 * 2e-5 / 12.0 / (6e-5 * 6e-5);
  DOUBLES_EQUAL(std::sqrt(1.0 + quantum), explain::root_mean_square(engine) / 6e-5, 0.073);
  const std::vector<double> correlation = explain::autocorrelation(engine, 1);
  DOUBLES_EQUAL(stays / (1.0 + quantum), correlation[1] / correlation[0], 0.032);
}

TEST(Conditions, DropOutsReadZeroAndAreDeclared) {
  CaseOrder order{"any", {}, 1};
  order.condition = "drop-outs";
  const Given given = recorded(order, {}, {{"steady", std::vector<double>(5000, 0.5 * kDegree)}});
  const Record& record = given.records.front();
  CHECK_EQUAL(3U, given.exclusions.size());
  std::vector<bool> declared(record.rows, false);
  for (const std::string& text : given.exclusions) {
    const explain::Exclusion exclusion = explain::exclusion_from(text);
    for (std::size_t i = 0; i < record.rows; ++i) {
      const double time = static_cast<double>(i) * record.period;
      declared[i] = declared[i] || exclusion.stretch.holds(time);
    }
  }
  std::size_t zeros = 0;
  // The engine is half a degree off zero, 145 times its noise, once it has come there.
  for (std::size_t i = 500; i < record.rows; ++i) {
    if (values(record, "engine")[i] == 0.0) {
      ++zeros;
      CHECK_TRUE(declared[i]);
    }
  }
  // Three of at least 0.3 s, which may overlap, or begin in the first second.
  CHECK_TRUE(zeros > 75);
}

}  // namespace hotfire::study
