// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/explain.hpp"

#include <atomic>
#include <cmath>
#include <memory>
#include <string>

#include "tests/explain/oscillator.hpp"
#include "tests/support/refusal.hpp"
#include "tools/explain/report/report_json.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire;
using test::declared_oscillator;
using test::oscillator;

constexpr double kNoise = 1e-3;

explain::Explanation explained(const Record& record, explain::ExplainOptions options = {}) {
  options.threads = 2;
  return explain::explain(declared_oscillator(97.0), {record}, options);
}

/// The cubic force of an oscillator explained: tests that need it and change nothing share it, because it takes seconds.
const explain::Explanation& cubic_explained() {
  static const explain::Explanation explanation = explained(oscillator(400.0, kNoise));
  return explanation;
}

/// The cubic force is named from the readings of another sensor alone, and nothing but its noise is left. The oscillator
/// moves at some 10 rad/s: the noise is as large beside a velocity or an acceleration.
void check_cubic_found(model::Direct<double>::Channel channel, double noise, std::size_t rows) {
  Record record = oscillator(400.0, noise, 0.0, channel);
  record.rows = rows;
  for (Channel& values : record.channels) {
    values.values.resize(record.rows);
  }
  const auto found = explained(record);
  CHECK_EQUAL(1U, found.result.effects.size());
  STRCMP_EQUAL("cubic_stiffness", found.result.effects.front().name.c_str());
  for (const auto& error : found.result.channels) {
    if (error.name == record.channels[1].name) {
      DOUBLES_EQUAL(noise, error.explained.rms, 0.1 * noise);
    }
  }
}

std::string text_of(const nlohmann::json& report, const char* key) { return report.at(key).get<std::string>(); }

}  // namespace

TEST_GROUP(Explain){};
TEST_GROUP(ExplainAtLength){};

TEST(Explain, ARecordHeldOutWholeChangesNothingOfWhatIsFoundAndIsJudgedWithTheModelThatIsWritten) {
  Record kept_back = oscillator(400.0, 2.0 * kNoise);
  kept_back.name = "kept_back.csv";
  kept_back.path = kept_back.name;
  explain::ExplainOptions options;
  options.kept_back = {kept_back};
  const auto& alone = cubic_explained();
  const auto beside = explained(oscillator(400.0, kNoise), options);
  STRCMP_EQUAL(model_text(alone.model).c_str(), model_text(beside.model).c_str());
  CHECK(alone.result.held_out_records.empty());
  CHECK(!explain::report_json(alone.result).contains("held_out_records"));
  const explain::HeldOutRecord& judged = beside.result.held_out_records.at(0);
  STRCMP_EQUAL("kept_back.csv", judged.path.c_str());
  const explain::ChannelErrors& position = judged.channels.at(0);
  STRCMP_EQUAL("position", position.name.c_str());
  // The cubic force is there in both, so that the written model leaves what its sensor adds; the declared one does not.
  DOUBLES_EQUAL(2.0 * kNoise, position.explained.rms, 0.1 * kNoise);
  CHECK(position.declared.rms > 2.0 * position.explained.rms);
  // It is what `simulate` says of that model, but for the start, which both take from the record.
  const Record simulated = simulate(beside.model, kept_back);
  double square = 0.0;
  for (std::size_t row = 0; row < kept_back.rows; ++row) {
    const double error = simulated.find("position")->values[row] - kept_back.find("position")->values[row];
    square += error * error / static_cast<double>(kept_back.rows);
  }
  DOUBLES_EQUAL(std::sqrt(square), position.explained.rms, 0.1 * kNoise);
}

TEST(Explain, AMassWhoseVelocityAloneIsMeasuredHasTheSameEffect) {
  check_cubic_found(model::Direct<double>::kVelocity, 10.0 * kNoise, 2000);
}

TEST(ExplainAtLength, AMassWhoseAccelerationAloneIsMeasuredHasTheSameEffect) {
  check_cubic_found(model::Direct<double>::kAcceleration, 100.0 * kNoise, 6000);
}

/// The oscillator whose drive had this input, instead of the force that it then gave: `input(force, row)`.
template <class Input>
explain::Explanation explained_with_drive(Input&& input) {
  Record record = oscillator(0.0, kNoise);
  const std::vector<double> force = record.channels[0].values;
  for (std::size_t row = 0; row < record.rows; ++row) {
    record.channels[0].values[row] = input(force, row);
  }
  return explained(record);
}

TEST(ExplainAtLength, DeadBandOfTheDriveOfAMassIsNamed) {
  const auto found = explained_with_drive(
      [](const std::vector<double>& force, std::size_t row) { return force[row] + std::copysign(4.0, force[row]); });
  CHECK_TRUE(!found.result.effects.empty());
  STRCMP_EQUAL("drive_deadband", found.result.effects.front().name.c_str());
}

TEST(Explain, DelayOfTheDriveOfAMassIsNamedAndLeavesTheNoise) {
  const auto found = explained_with_drive(
      [](const std::vector<double>& force, std::size_t row) { return force[std::min(row + 2, force.size() - 1)]; });
  CHECK_EQUAL(1U, found.result.effects.size());
  STRCMP_EQUAL("command_delay", found.result.effects.front().name.c_str());
  DOUBLES_EQUAL(kNoise, found.result.channels.at(0).explained.rms, 0.1 * kNoise);
}

TEST(Explain, AVelocityInAnotherUnitOfLengthThanThePositionIsRefused) {
  Record record = oscillator(400.0, kNoise);
  record.channels.push_back({"velocity", "mm/s", record.channels[1].values});
  STRCMP_CONTAINS("velocity: unit \"mm/s\" is not m/s", test::refusal([&] { explained(record); }).c_str());
}

TEST(Explain, InterruptedAtAnyMomentItSaysThatItIsUndecidedAndWhatItKnowsByThen) {
  const Record record = oscillator(400.0, kNoise);
  const auto interrupted_after = [&](int calls) {
    explain::ExplainOptions options;
    auto asked = std::make_shared<std::atomic<int>>(0);
    options.watch.interrupted = [asked, calls] { return ++*asked > calls; };
    return explain::report_json(explained(record, options).result);
  };
  // How often the whole search asks is not fixed: a moment before its first round, and one within.
  const auto at_once = interrupted_after(0);
  STRCMP_EQUAL("undecided", text_of(at_once, "verdict").c_str());
  CHECK(text_of(at_once, "sentence").find("interrupted") != std::string::npos);
  const auto in_round = interrupted_after(12);
  STRCMP_EQUAL("undecided", text_of(in_round, "verdict").c_str());
  CHECK(!in_round.at("search").empty());
  for (const auto& row : in_round.at("search")) {
    STRCMP_EQUAL("undecided", text_of(row, "decision").c_str());
  }
  CHECK(in_round.at("effects").empty());
  STRCMP_EQUAL("explained", text_of(explain::report_json(cubic_explained().result), "verdict").c_str());
}

TEST(ExplainAtLength, AMassThatMovesAgainstItsForceIsRefusedForItsSign) {
  Record record = oscillator(400.0, kNoise);
  for (double& position : record.channels[1].values) {
    position = -position;
  }
  STRCMP_CONTAINS("oscillator.csv: the mass moves against its force", test::refusal([&] { explained(record); }).c_str());
}

TEST(Explain, AskedForNoEffectItDoesNotSayThatNoneFits) {
  explain::ExplainOptions options;
  options.most_effects = 0;
  const auto report = explain::report_json(explained(oscillator(400.0, kNoise), options).result);
  STRCMP_EQUAL("undecided", text_of(report, "verdict").c_str());
  CHECK(text_of(report, "sentence").find("no effect was searched for") != std::string::npos);
}

TEST(Explain, OfATermThatNobodyListedItSaysWhatItLooksLikeWithinWhichBoundsAndWhatItIsNot) {
  const auto report = explain::report_json(explained(oscillator(0.0, kNoise, 2.0)).result);
  STRCMP_EQUAL("unlisted-effect", text_of(report, "verdict").c_str());
  const auto& effect = report.at("effects").at(0);
  CHECK(text_of(effect, "looks_like").find("Beyond these bounds the value at the end holds") != std::string::npos);
  CHECK(text_of(effect, "is_not").find("isted effect") != std::string::npos);
}
