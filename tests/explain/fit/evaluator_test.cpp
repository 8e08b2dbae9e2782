// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/fit/evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/explain/fit/slopes.hpp"
#include "tools/explain/terms/candidates.hpp"
#include "tools/explain/terms/trial.hpp"
#include "tools/explain/terms/unlisted.hpp"
#include "tools/simulate/gradients.hpp"

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire::explain;

/// Two records of an axis under a smooth command, measured as zero: what counts are derivatives.
Dataset smooth_dataset() {
  Dataset data;
  data.channels = {"piston", "engine", "load_pressure"};
  data.used = {true, true, false};
  data.noise = {8e-6, 6e-5, 1.0};
  data.noise_source = {NoiseSource::declared, NoiseSource::declared, NoiseSource::estimated};
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
    experiment.noise = data.noise;
    experiment.zero_deviation.assign(data.channels.size(), 0.0);
    data.experiments.push_back(experiment);
  }
  return data;
}

/// The command of an experiment, as a record.
hotfire::Record record_of(const Experiment& experiment) {
  hotfire::Record record;
  record.period = experiment.period;
  record.rows = experiment.rows();
  record.channels.push_back({"command", "rad", experiment.input});
  return record;
}

/// That axis with two of its declared parameters free.
struct InertiaAndStiffness {
  const Dataset data = smooth_dataset();
  const hotfire::SimplexParameters base;
  const std::vector<FreeParameter> free =
      declared_parameters(base, {{"engine.inertia", 0.02}, {"structure.stiffness", 0.05}});

  Prediction predicted(const Evaluator& evaluator, const std::vector<double>& u, unsigned threads = 1) const {
    Prediction prediction;
    CHECK(evaluator.predict(base, free, u, threads, prediction));
    return prediction;
  }
  Eigen::MatrixXd slopes(const Evaluator& evaluator, const std::vector<double>& u, unsigned threads = 1) const {
    const std::vector<std::size_t> all{0, 1};
    Eigen::MatrixXd jacobian;
    CHECK(evaluator.differentiate(base, free, u, all, threads, jacobian));
    return jacobian;
  }
};

}  // namespace

TEST_GROUP(Evaluator){};

TEST(Evaluator, GradientsMeetCentralDifferencesForEveryDeclaredParameterAndAnEffect) {
  const Dataset data = smooth_dataset();
  const Evaluator evaluator(data, Resolution::fine);
  ModelParameters base = hotfire::SimplexParameters();
  std::map<std::string, double> tolerance;
  visit_parameters(base, [&](const hotfire::model::Key& key, const auto& field, const double&) {
    if (!key.is_effect) {
      tolerance[std::string(key.section) + "." + std::string(field.name)] = 0.05;
    }
  });
  std::vector<FreeParameter> free = declared_parameters(base, tolerance);
  for (const Candidate& candidate : all_candidates(base, data)) {
    if (candidate.name == "structural_mode") {
      activate(base, candidate);
      const auto own = effect_parameters(base, candidate, {});
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
    const Eigen::VectorXd narrow = jacobian.col(static_cast<Eigen::Index>(k));
    // Differences over 1e-5: that share of the second derivative, ten times the first at a resonance, and rounding of 2e-4
    // in 1600 rows.
    CHECK_TEXT((difference - narrow).norm() <= 2e-4 * narrow.norm() + 5e-4, free[k].key.c_str());
  }
}

TEST(Evaluator, GradientsAreThoseOfDualNumbersForEveryListedEffectHoweverItBranches) {
  const Dataset data = smooth_dataset();
  const Evaluator evaluator(data, Resolution::fine);
  const hotfire::Record inputs = record_of(data.experiments.front());
  const hotfire::SimplexParameters plain;
  int compared = 0;
  for (const Candidate& candidate : all_candidates(plain, data)) {
    if (is_unlisted(plain, candidate) || !candidate.choices.empty()) {
      continue;
    }
    ModelParameters base = plain;
    activate(base, candidate);
    std::vector<FreeParameter> free = effect_parameters(base, candidate, {});
    std::erase_if(free, [](const FreeParameter& p) { return p.is_ordinate() || p.is_initial_state(); });
    std::vector<double> u;
    std::vector<std::string> keys;
    for (const FreeParameter& parameter : free) {
      u.push_back(parameter.coordinate(std::clamp(parameter.unit_size, parameter.lower, parameter.upper)));
      keys.push_back(parameter.key);
    }
    std::vector<std::size_t> all(free.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    Eigen::MatrixXd jacobian;
    CHECK_TRUE_TEXT(evaluator.differentiate(base, free, u, all, 2, jacobian), label(candidate).c_str());
    hotfire::ModelFile model;
    model.parameters = with_values(base, free, u);
    const auto exact = hotfire::gradients(model, inputs, keys);
    for (const Stretch& s : evaluator.stretches()) {
      for (std::size_t k = 0; s.experiment == 0 && k < free.size(); ++k) {
        double off = 0.0;
        double size = 0.0;
        for (std::size_t row = s.first; row < s.last; ++row) {
          const double slope = exact[s.channel].slopes[row * free.size() + k] * free[k].slope(u[k]) / data.noise[s.channel];
          const double narrow = jacobian(static_cast<Eigen::Index>(s.offset + row - s.first), static_cast<Eigen::Index>(k));
          off += (narrow - slope) * (narrow - slope);
          size += slope * slope;
        }
        // A resonance bends most over a unit. The elastoplastic law extrapolates what it iterates: it moves by rounding,
        // 1e-10 of a reading, and the quotient of its least parameter by a half.
        const double bend = candidate.option_name == "elastoplastic" ? 0.5 : 2e-4;
        CHECK_TRUE_TEXT(std::sqrt(off) <= bend * std::sqrt(size) + 5e-4, (label(candidate) + " " + free[k].key).c_str());
        ++compared;
      }
    }
  }
  CHECK_TRUE(compared > 100);
}

TEST(Evaluator, TheResultDoesNotDependOnTheNumberOfThreads) {
  const InertiaAndStiffness axis;
  const Evaluator evaluator(axis.data, Resolution::fine);
  const std::vector<double> u{0.3, -0.2};
  CHECK((axis.slopes(evaluator, u, 1).array() == axis.slopes(evaluator, u, 2).array()).all());
  CHECK(axis.predicted(evaluator, u, 1) == axis.predicted(evaluator, u, 2));
}

TEST(Evaluator, DerivativesMayBeThoseOfLongerStepsThanItsReadings) {
  const InertiaAndStiffness axis;
  const std::vector<double> u{0.3, -0.2};
  const Evaluator coarse(axis.data, Resolution::coarse);
  const Evaluator rough(axis.data, Resolution::rough);
  const Evaluator mixed(axis.data, Resolution::coarse, Resolution::rough);
  CHECK((axis.slopes(mixed, u).array() == axis.slopes(rough, u).array()).all());
  CHECK(axis.predicted(mixed, u) == axis.predicted(coarse, u));
}

TEST(Evaluator, ShiftedLongStepsAreRightWhereTheShiftWasTakenAndNearlySoNearby) {
  const InertiaAndStiffness axis;
  const std::vector<double> there{0.3, -0.2};
  const std::vector<double> nearby{0.8, 0.3};
  const Evaluator fine(axis.data, Resolution::fine);
  const Evaluator rough(axis.data, Resolution::rough);
  const Evaluator shifted = rough.shifted(axis.predicted(rough, there), axis.predicted(fine, there));
  const auto off = [&](const Evaluator& evaluator, const std::vector<double>& u) {
    return (evaluator.residuals(axis.predicted(evaluator, u)) - fine.residuals(axis.predicted(fine, u))).norm();
  };
  const double lost = off(rough, there);
  // What is left is the rounding of two subtractions.
  CHECK(off(shifted, there) <= 1e-9 * lost);
  // Half a tolerance away in each: by a hundredth of the inertia and a fortieth of the stiffness, and the error of a step
  // with both. A fifth leaves room for its higher powers.
  CHECK(off(shifted, nearby) <= 0.2 * lost);
}

TEST(Evaluator, DerivativesThatAreAskedForWideAreDifferencesOverTheWidthOfARipple) {
  const Dataset data = smooth_dataset();
  const Evaluator evaluator(data, Resolution::coarse);
  ModelParameters base = hotfire::SimplexParameters();
  std::vector<FreeParameter> free = declared_parameters(base, {{"engine.inertia", 0.05}});
  for (const Candidate& candidate : all_candidates(base, data)) {
    if (candidate.name == "valve_hysteresis") {
      activate(base, candidate);
      const auto own = effect_parameters(base, candidate, {});
      free.insert(free.end(), own.begin(), own.end());
    }
  }
  LONGS_EQUAL(2, free.size());
  const std::vector<double> u{0.2, free.back().coordinate(free.back().unit_size)};
  const std::vector<std::size_t> all{0, 1};
  Eigen::MatrixXd wide;
  CHECK(differentiate(evaluator, base, free, u, all, Slopes::wide, 2, wide) == Slopes::wide);
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
  CHECK(differentiate(evaluator, base, free, u, all, Slopes::narrow, 2, exact) == Slopes::narrow);
  CHECK((exact - wide).norm() > 0.0);
}
