#include "tools/explain/evaluator.hpp"

#include <cmath>
#include <numeric>

#include "tools/explain/candidates.hpp"
#include "tools/explain/slopes.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire::explain;

/// Two records of an axis under a smooth command, measured as zero: what counts are derivatives.
Dataset smooth_dataset() {
  Dataset data;
  data.channels = {"piston", "engine", "load_pressure"};
  data.used = {true, true, false};
  data.noise = {8e-6, 6e-5, 1.0};
  data.noise_declared = {true, true, false};
  for (int e = 0; e < 2; ++e) {
    Experiment experiment;
    experiment.name = "smooth";
    experiment.period = 0.002;
    for (int i = 0; i < 500; ++i) {
      experiment.input.push_back(0.01 * std::sin((e + 2.0) * 3.0 * i * 0.002));
    }
    experiment.measured = {std::vector<double>(500, 0.0), std::vector<double>(500, 0.0), {}};
    experiment.fitted = {{0, 100}, {200, 500}};
    experiment.held_out = {{100, 200}};
    data.experiments.push_back(experiment);
  }
  return data;
}

}  // namespace

TEST_GROUP(Evaluator){};

TEST(Evaluator, ExactGradientsMeetCentralDifferencesForEveryDeclaredParameterAndAnEffect) {
  const Dataset data = smooth_dataset();
  const Evaluator<SimplexFamily> evaluator(data, Resolution::fine);
  PlainParameters<SimplexFamily> base;
  std::map<std::string, double> tolerance;
  hotfire::model::visit_parameters(base, [&](const hotfire::model::Key& key, const auto& field, const double&) {
    if (!key.is_effect) {
      tolerance[std::string(key.section) + "." + std::string(field.name)] = 0.05;
    }
  });
  std::vector<FreeParameter> free = declared_parameters<SimplexFamily>(base, tolerance);
  for (const Candidate& candidate : all_candidates<SimplexFamily>(data)) {
    if (candidate.name == "structural_mode") {
      activate<SimplexFamily>(base, candidate);
      const auto own = effect_parameters<SimplexFamily>(base, candidate, {});
      free.insert(free.end(), own.begin(), own.end());
    }
  }
  std::vector<double> u;
  u.reserve(free.size());
  for (const FreeParameter& parameter : free) {
    u.push_back(parameter.is_declared() ? 0.1 : parameter.coordinate(parameter.unit_size));
  }
  std::vector<std::size_t> all(free.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  Eigen::MatrixXd jacobian;
  CHECK(evaluator.differentiate(base, free, u, all, 2, jacobian));
  LONGS_EQUAL(2 * 2 * 400, jacobian.rows());
  for (std::size_t k = 0; k < free.size(); ++k) {
    // Central differences: truncation h^2 = 1e-8 of the third derivative; rounding of a simulation, 1e-13 of a residual of a
    // thousand, over 2 h in 1600 rows is 2e-5.
    const double h = 1e-4;
    Prediction high;
    Prediction low;
    std::vector<double> moved = u;
    moved[k] = u[k] + h;
    CHECK(evaluator.predict(base, free, moved, 1, high));
    moved[k] = u[k] - h;
    CHECK(evaluator.predict(base, free, moved, 1, low));
    const Eigen::VectorXd difference = (evaluator.residuals(high) - evaluator.residuals(low)) / (2.0 * h);
    const Eigen::VectorXd exact = jacobian.col(static_cast<Eigen::Index>(k));
    CHECK_TEXT((difference - exact).norm() <= 1e-5 * exact.norm() + 1e-4, free[k].key.c_str());
  }
}

TEST(Evaluator, TheResultDoesNotDependOnTheNumberOfThreads) {
  const Dataset data = smooth_dataset();
  const Evaluator<SimplexFamily> evaluator(data, Resolution::fine);
  const PlainParameters<SimplexFamily> base;
  const auto free = declared_parameters<SimplexFamily>(base, {{"engine.inertia", 0.02}, {"structure.stiffness", 0.05}});
  const std::vector<double> u{0.3, -0.2};
  const std::vector<std::size_t> all{0, 1};
  Eigen::MatrixXd one;
  Eigen::MatrixXd two;
  evaluator.differentiate(base, free, u, all, 1, one);
  evaluator.differentiate(base, free, u, all, 2, two);
  CHECK((one.array() == two.array()).all());
  Prediction one_prediction;
  Prediction two_prediction;
  evaluator.predict(base, free, u, 1, one_prediction);
  evaluator.predict(base, free, u, 2, two_prediction);
  CHECK(one_prediction == two_prediction);
}

TEST(Evaluator, DerivativesMayBeThoseOfLongerStepsThanItsReadings) {
  const Dataset data = smooth_dataset();
  const PlainParameters<SimplexFamily> base;
  const auto free = declared_parameters<SimplexFamily>(base, {{"engine.inertia", 0.02}, {"structure.stiffness", 0.05}});
  const std::vector<double> u{0.3, -0.2};
  const std::vector<std::size_t> all{0, 1};
  const Evaluator<SimplexFamily> mixed(data, Resolution::coarse, Resolution::rough);
  Eigen::MatrixXd slopes;
  Eigen::MatrixXd rough_slopes;
  mixed.differentiate(base, free, u, all, 1, slopes);
  Evaluator<SimplexFamily>(data, Resolution::rough).differentiate(base, free, u, all, 1, rough_slopes);
  CHECK((slopes.array() == rough_slopes.array()).all());
  Prediction readings;
  Prediction coarse_readings;
  mixed.predict(base, free, u, 1, readings);
  Evaluator<SimplexFamily>(data, Resolution::coarse).predict(base, free, u, 1, coarse_readings);
  CHECK(readings == coarse_readings);
}

TEST(Evaluator, ShiftedLongStepsAreRightWhereTheShiftWasTakenAndNearlySoNearby) {
  const Dataset data = smooth_dataset();
  const PlainParameters<SimplexFamily> base;
  const auto free = declared_parameters<SimplexFamily>(base, {{"engine.inertia", 0.02}, {"structure.stiffness", 0.05}});
  const std::vector<double> there{0.3, -0.2};
  const std::vector<double> nearby{0.8, 0.3};
  const Evaluator<SimplexFamily> fine(data, Resolution::fine);
  const Evaluator<SimplexFamily> rough(data, Resolution::rough);
  const auto readings = [&](const Evaluator<SimplexFamily>& evaluator, const std::vector<double>& u) {
    Prediction prediction;
    CHECK(evaluator.predict(base, free, u, 1, prediction));
    return evaluator.residuals(prediction);
  };
  Prediction by_rough;
  Prediction by_fine;
  CHECK(rough.predict(base, free, there, 1, by_rough) && fine.predict(base, free, there, 1, by_fine));
  const Evaluator<SimplexFamily> shifted = rough.shifted(by_rough, by_fine);
  const double lost = (readings(rough, there) - readings(fine, there)).norm();
  // What is left is the rounding of two subtractions.
  CHECK((readings(shifted, there) - readings(fine, there)).norm() <= 1e-9 * lost);
  // Half a tolerance away in each: by a hundredth of the inertia and a fortieth of the stiffness, and the error of a step
  // with both. A fifth leaves room for its higher powers.
  CHECK((readings(shifted, nearby) - readings(fine, nearby)).norm() <= 0.2 * lost);
}

TEST(Evaluator, DerivativesThatAreAskedForWideAreDifferencesOverTheWidthOfARipple) {
  const Dataset data = smooth_dataset();
  const Evaluator<SimplexFamily> evaluator(data, Resolution::coarse);
  PlainParameters<SimplexFamily> base;
  std::vector<FreeParameter> free = declared_parameters<SimplexFamily>(base, {{"engine.inertia", 0.05}});
  for (const Candidate& candidate : all_candidates<SimplexFamily>(data)) {
    if (candidate.name == "valve_hysteresis") {
      activate<SimplexFamily>(base, candidate);
      const auto own = effect_parameters<SimplexFamily>(base, candidate, {});
      free.insert(free.end(), own.begin(), own.end());
    }
  }
  LONGS_EQUAL(2, free.size());
  const std::vector<double> u{0.2, free.back().coordinate(free.back().unit_size)};
  const std::vector<std::size_t> all{0, 1};
  Eigen::MatrixXd wide;
  CHECK(differentiate<SimplexFamily>(evaluator, base, free, u, all, Slopes::wide, 2, wide) == Slopes::wide);
  for (std::size_t k = 0; k < free.size(); ++k) {
    const double step = wide_step(free[k]);
    std::vector<double> at = u;
    Prediction high;
    Prediction low;
    at[k] = u[k] + step;
    CHECK(evaluator.predict(base, free, at, 1, high));
    at[k] = u[k] - step;
    CHECK(evaluator.predict(base, free, at, 1, low));
    const Eigen::VectorXd difference = (evaluator.residuals(high) - evaluator.residuals(low)) / (2.0 * step);
    // The same simulations; the quotient's width is rounded once more.
    CHECK((difference - wide.col(static_cast<Eigen::Index>(k))).norm() <= 1e-12 * difference.norm());
  }
  Eigen::MatrixXd exact;
  CHECK(differentiate<SimplexFamily>(evaluator, base, free, u, all, Slopes::exact, 2, exact) == Slopes::exact);
  CHECK((exact - wide).norm() > 0.0);
}
