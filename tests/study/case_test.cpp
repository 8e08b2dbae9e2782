#include "tools/study/case.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "model/effects/valve_deadband.hpp"
#include "tests/files/scratch.hpp"
#include "tests/model/plants.hpp"
#include "tools/files/model_file.hpp"
#include "tools/simulate/simulate.hpp"

namespace hotfire::study {
namespace {

/// The declared model with the parameters of the true axis.
ModelFile true_model(const StudyCase& made, const std::filesystem::path& folder) {
  ModelFile model = load_model(folder / "given/declared.toml");
  auto& parameters = std::get<SimplexParameters>(model.parameters);
  const ReferenceAxis& axis = made.plan.axis;
  parameters.servovalve.natural_frequency = axis.valve_frequency;
  parameters.servovalve.position_gain = axis.position_gain;
  parameters.servovalve.pressure_feedback_gain = axis.pressure_gain;
  parameters.actuator.bulk_modulus = axis.bulk_modulus;
  parameters.actuator.leakage = axis.leakage;
  parameters.actuator.piston_damping = axis.piston_damping;
  parameters.structure.stiffness = axis.load_stiffness;
  parameters.engine.inertia = axis.inertia;
  parameters.engine.viscous_damping = axis.damping;
  parameters.engine.duct_stiffness = axis.duct_stiffness;
  return model;
}

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - b[i]) * (a[i] - b[i]);
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// The model with the true parameters meets the kept record to a fiftieth of the sensor noise, half a permille of what the
/// agreement with CVODE allows, and the given records down to their noise and quantum.
void check_truth(const ModelFile& model, const StudyCase& made) {
  for (std::size_t c = 0; c < 2; ++c) {
    const SensorGrade& grade = kSensorGrades[c];
    const auto off = [&](const Record& record) {
      return rms(simulate(model, record).find(grade.channel)->values, record.find(grade.channel)->values) / grade.noise;
    };
    CHECK_TRUE_TEXT(off(made.unseen) < 0.02, grade.channel);
    // Rounding to a quantum adds quantum^2 / 12; of 12500 rows or more the rms is known to 1 %, five standard deviations are
    // 3 %.
    const double expected = std::sqrt(1.0 + std::pow(grade.quantum / grade.noise, 2) / 12.0);
    for (const Record& record : made.given) {
      DOUBLES_EQUAL_TEXT(1.0, off(record) / expected, 0.035, record.name.c_str());
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
  check_truth(true_model(made, scratch.path("null-1")), made);
}

TEST(StudyCases, ACaseWithAnEffectIsTheModelWithThatEffect) {
  const StudyCase made = make_case({"valve_deadband-1", {"valve_deadband"}, 1});
  write_case(made, scratch.path("valve_deadband-1"));
  ModelFile model = true_model(made, scratch.path("valve_deadband-1"));
  CHECK_TRUE(rms(simulate(model, made.unseen).find("piston")->values, made.unseen.find("piston")->values) >
             kSmallestEffect * kSensorGrades[0].noise);
  test::activate<model::ValveDeadband, model::Simplex<double>>(std::get<SimplexParameters>(model.parameters),
                                                               {0, made.plan.axis.deadband});
  check_truth(model, made);
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

TEST(StudyCases, AnUnlistedCaseSaysWhereItsEffectActs) {
  const StudyCase made = make_case({"track_wear-1", {"track_wear"}, 1});
  write_case(made, scratch.path("track_wear-1"));
  const auto truth = nlohmann::json::parse(bytes_of(scratch.path("track_wear-1") / "kept/truth.json"));
  STRCMP_EQUAL("unlisted@sensor.piston|sensor", truth["effects"][0].get<std::string>().c_str());
}

}  // namespace hotfire::study
