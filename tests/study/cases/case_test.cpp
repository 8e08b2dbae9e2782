// SPDX-License-Identifier: Apache-2.0
#include "tools/study/cases/case.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "tests/files/scratch.hpp"
#include "tests/support/rms_difference.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/study/tally/candidate_fit.hpp"

namespace hotfire::study {
namespace {

/// How far a record is from what a model says of it, in sensor noise.
double off(const ModelFile& model, const Record& record, const SensorGrade& grade) {
  return test::rms_difference(simulate(model, record).find(grade.channel)->values, record.find(grade.channel)->values) /
         grade.noise;
}

/// The model with the true parameters meets the kept record to a fiftieth of the sensor noise, half a permille of what the
/// agreement with CVODE allows.
void check_kept(const ModelFile& model, const StudyCase& made) {
  for (std::size_t c = 0; c < 2; ++c) {
    CHECK_TRUE_TEXT(off(model, made.unseen, kSensorGrades[c]) < 0.02, kSensorGrades[c].channel);
  }
}

/// ... and the given records down to their noise and quantum.
void check_truth(const ModelFile& model, const StudyCase& made) {
  check_kept(model, made);
  for (std::size_t c = 0; c < 2; ++c) {
    const SensorGrade& grade = kSensorGrades[c];
    // Rounding to a quantum adds quantum^2 / 12; of 12500 rows or more the rms is known to 1 %, five standard deviations are
    // 3 %.
    const double expected = std::sqrt(1.0 + std::pow(grade.quantum / grade.noise, 2) / 12.0);
    for (const Record& record : made.given) {
      DOUBLES_EQUAL_TEXT(1.0, off(model, record, grade) / expected, 0.035, record.name.c_str());
    }
  }
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

TEST_GROUP(StudyCases) { test::Scratch scratch; };

TEST(StudyCases, ANullCaseIsTheModelWithTheTrueParameters) {
  const StudyCase made = make_case({"null-1", {}, 1});
  write_case(made, scratch.path("null-1"));
  check_truth(load_model(scratch.path("null-1") / "kept/true.toml"), made);
}

TEST(StudyCases, ACaseWithAnEffectIsTheModelWithThatEffect) {
  const StudyCase made = make_case({"valve_deadband-1", {"valve_deadband"}, 1});
  write_case(made, scratch.path("valve_deadband-1"));
  const ModelFile declared = load_model(scratch.path("valve_deadband-1") / "given/declared.toml");
  CHECK_TRUE(test::rms_difference(simulate(declared, made.unseen).find("piston")->values,
                                  made.unseen.find("piston")->values) > kSmallestEffect * kSensorGrades[0].noise);
  check_truth(load_model(scratch.path("valve_deadband-1") / "kept/true.toml"), made);
}

TEST(StudyCases, TheMissingEffectFittedByItselfMeetsTheUnseenRecordAndAnUnknownOneIsRefused) {
  write_case(make_case({"valve_deadband-1", {"valve_deadband"}, 1}), scratch.path("valve_deadband-1"));
  const CandidateFit fit = fit_candidate(scratch.path("valve_deadband-1"), "valve_deadband", "", 1);
  STRCMP_EQUAL("valve_deadband", fit.candidate.c_str());
  CHECK_TRUE(fit.after.at("piston") < 1.0 && fit.after.at("engine") < 1.0);
  CHECK_THROWS(UsageError, fit_candidate(scratch.path("valve_deadband-1"), "gimbal_friction", "", 1));
}

TEST(StudyCases, TheSameOrderGivesTheSameBytesAndAnotherSeedDoesNot) {
  const std::array<std::filesystem::path, 3> folders{scratch.path("first"), scratch.path("second"), scratch.path("third")};
  write_case(make_case({"null-1", {}, 1}), folders[0]);
  write_case(make_case({"null-1", {}, 1}), folders[1]);
  write_case(make_case({"null-1", {}, 3}), folders[2]);
  for (const char* file : {"given/declared.toml", "given/sweep.csv", "kept/score_noisefree.csv", "kept/truth.json"}) {
    CHECK_TRUE_TEXT(bytes_of(folders[0] / file) == bytes_of(folders[1] / file), file);
    CHECK_TRUE_TEXT(bytes_of(folders[0] / file) != bytes_of(folders[2] / file), file);
  }
  // Every third seed measures the load pressure as well.
  CHECK_TRUE(load_record(folders[0] / "given/steps.csv").find("load_pressure") == nullptr);
  CHECK_TRUE(load_record(folders[2] / "given/steps.csv").find("load_pressure") != nullptr);
}

TEST(StudyCases, ACaseWithAFaultOfAChannelKeepsThePlantWithoutItAndSaysIt) {
  CaseOrder order{"mis-scaled-null-1", {}, 1};
  order.condition = "mis-scaled";
  const StudyCase made = make_case(order);
  write_case(made, scratch.path("mis-scaled-null-1"));
  const ModelFile plant = load_model(scratch.path("mis-scaled-null-1") / "kept/true.toml");
  check_kept(plant, made);
  const Record given = load_record(scratch.path("mis-scaled-null-1") / "given/sweep.csv");
  const std::vector<double>& reading = given.find("engine")->values;
  const std::vector<double> angle = simulate(plant, given).find("engine")->values;
  const double product = std::inner_product(reading.begin(), reading.end(), angle.begin(), 0.0);
  const double square = std::inner_product(angle.begin(), angle.end(), angle.begin(), 0.0);
  // The noise of 13,000 readings moves the ratio by 1e-6 or so.
  DOUBLES_EQUAL(1.05, product / square, 1e-3);
  const auto truth = nlohmann::json::parse(bytes_of(scratch.path("mis-scaled-null-1") / "kept/truth.json"));
  STRCMP_EQUAL("sensor_scale", truth["effects"][0].get<std::string>().c_str());
}

TEST(StudyCases, ANullBiasOfTheValveIsInTheUnseenRecordAndInTheTrueModel) {
  CaseOrder order{"null-bias-null-1", {}, 1};
  order.condition = "null-bias";
  const StudyCase made = make_case(order);
  write_case(made, scratch.path("null-bias-null-1"));
  const std::vector<double>& unseen = made.unseen.find("piston")->values;
  const ModelFile plant = load_model(scratch.path("null-bias-null-1") / "kept/true.toml");
  CHECK_COMPARE(test::rms_difference(simulate(plant, made.unseen).find("piston")->values, unseen), <,
                kSensorGrades[0].noise);
  const ModelFile declared = load_model(scratch.path("null-bias-null-1") / "given/declared.toml");
  // 2 % of the full command over a position gain of 86 per metre is 0.23 mm, 29 times the noise.
  CHECK_COMPARE(test::rms_difference(simulate(declared, made.unseen).find("piston")->values, unseen), >,
                20.0 * kSensorGrades[0].noise);
}

TEST(StudyCases, AnUnlistedCaseSaysWhereItsEffectActs) {
  const StudyCase made = make_case({"track_wear-1", {"track_wear"}, 1});
  write_case(made, scratch.path("track_wear-1"));
  const auto truth = nlohmann::json::parse(bytes_of(scratch.path("track_wear-1") / "kept/truth.json"));
  STRCMP_EQUAL("unlisted@sensor.piston|sensor", truth["effects"][0].get<std::string>().c_str());
}

}  // namespace hotfire::study
