#include "tools/explain/search.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <CppUTest/TestHarness.h>

namespace {

using namespace hotfire;

/// A mass on a spring under a smooth random force, stepped by fourth-order Runge-Kutta of its own: shares no code with the
/// model. What the declared model lacks: the stiffness `cubic`, and detents, 2 pi / 8 m apart, of up to so many newtons.
Record oscillator(double cubic, double noise, double detents = 0.0) {
  constexpr double kMass = 1.0;
  constexpr double kDamping = 1.5;
  constexpr double kStiffness = 100.0;
  constexpr double kPeriod = 0.01;
  constexpr int kSubsteps = 20;
  constexpr double kDetentWavenumber = 8.0;
  std::mt19937_64 generator(1918);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> phases(40);
  for (double& phase : phases) {
    phase = 6.2831853 * std::generate_canonical<double, 53>(generator);
  }
  const auto force_at = [&](double t) {
    double force = 0.0;
    for (std::size_t k = 0; k < phases.size(); ++k) {
      force += 6.0 * std::cos((1.0 + 0.5 * static_cast<double>(k)) * t + phases[k]);
    }
    return force;
  };
  const auto acceleration = [&](double t, double x, double v) {
    return (force_at(t) - kDamping * v - kStiffness * x - cubic * x * x * x - detents * std::sin(kDetentWavenumber * x)) /
           kMass;
  };
  Record record;
  record.name = "oscillator.csv";
  record.period = kPeriod;
  record.rows = 6000;
  record.channels = {{"force", "N", {}}, {"position", "m", {}}};
  double x = 0.0;
  double v = 0.0;
  for (std::size_t row = 0; row < record.rows; ++row) {
    const double t = static_cast<double>(row) * kPeriod;
    record.channels[0].values.push_back(force_at(t));
    record.channels[1].values.push_back(x + noise * normal(generator));
    const double h = kPeriod / kSubsteps;
    for (int k = 0; k < kSubsteps; ++k) {
      const double s = t + k * h;
      const double k1 = acceleration(s, x, v);
      const double k2 = acceleration(s + h / 2, x + h / 2 * v, v + h / 2 * k1);
      const double k3 = acceleration(s + h / 2, x + h / 2 * v + h * h / 4 * k1, v + h / 2 * k2);
      const double k4 = acceleration(s + h, x + h * v + h * h / 2 * k2, v + h * k3);
      x += h * v + h * h / 6 * (k1 + k2 + k3);
      v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
  }
  return record;
}

explain::SearchResult<explain::DirectFamily> found_in(const Record& record, int most_effects = 4,
                                                      double declared_stiffness = 97.0) {
  ModelFile model;
  DirectParameters declared;
  declared.mass.inertia = 1.02;
  declared.mass.damping = 1.3;
  declared.mass.stiffness = declared_stiffness;
  model.parameters = declared;
  model.tolerance = {{"mass.inertia", 0.05}, {"mass.damping", 0.3}, {"mass.stiffness", 0.05}};
  const auto data = explain::make_dataset(model, {record});
  return explain::search<explain::DirectFamily>(data, model, {2, most_effects, {}});
}

}  // namespace

TEST_GROUP(Search){};

TEST(Search, ACubicStiffnessNobodyDeclaredIsFoundWithItsValueAndNothingElse) {
  const auto found = found_in(oscillator(400.0, 1e-3));
  LONGS_EQUAL(1, found.kept.size());
  STRCMP_EQUAL("cubic_stiffness", found.kept[0].trial.candidate.name.c_str());
  const auto& model = found.explained.model;
  for (std::size_t k = 0; k < model.free.size(); ++k) {
    if (model.free[k].key == "effects.cubic_stiffness.stiffness") {
      // The cubic force is rms 5 % of the linear one: noise of 1e-3 over 4500 samples leaves it known to a few per cent.
      DOUBLES_EQUAL(400.0, model.free[k].value(model.u[k]), 0.1 * 400.0);
    }
  }
  // Held-out error down to the noise: rms of residual over noise within 5 % of 1.
  DOUBLES_EQUAL(1.0, explain::Goodness::combined(found.explained.goodness.held_out), 0.1);
}

TEST(Search, AWrongDeclaredValueIsCalibratedAndNotTakenForAMissingEffect) {
  const auto found = found_in(oscillator(0.0, 1e-3));
  LONGS_EQUAL(0, found.kept.size());
  LONGS_EQUAL(0, found.trials.size());
  CHECK(explain::Goodness::combined(found.declared.goodness.held_out) > 2.0);
  DOUBLES_EQUAL(1.0, explain::Goodness::combined(found.calibrated.goodness.held_out), 0.1);
}

// Seven tolerances of 5 % below 100: no effect is missing, but the declaration cannot be trusted that far without a look.
TEST(Search, ACalibrationFarBeyondItsTolerancesIsLookedBeyondAndStillGetsNoEffectsName) {
  const auto found = found_in(oscillator(0.0, 1e-3), 4, 74.0);
  DOUBLES_EQUAL(1.0, explain::Goodness::combined(found.calibrated.goodness.held_out), 0.1);
  CHECK(!found.trials.empty());
  LONGS_EQUAL(0, found.kept.size());
}

TEST(Search, AForceThatNoListedEffectHasIsTakenDownAsATableOverWhatItDependsOn) {
  const auto found = found_in(oscillator(0.0, 1e-3, 2.0));
  LONGS_EQUAL(1, found.kept.size());
  STRCMP_EQUAL("unlisted_force", found.kept[0].trial.candidate.name.c_str());
  STRCMP_EQUAL("position", found.kept[0].trial.candidate.option_name.c_str());
  CHECK(explain::held_out_ratio(found.explained, found.calibrated) < 0.5);
  // What was tried is told in the order in which it was.
  CHECK(std::is_sorted(found.trials.begin(), found.trials.end(),
                       [](const auto& a, const auto& b) { return a.round < b.round; }));
}

TEST(Search, AllowedNoEffectItCalibratesAndLooksForNoneUnlistedEither) {
  const auto found = found_in(oscillator(400.0, 1e-3), 0);
  LONGS_EQUAL(0, found.trials.size());
  LONGS_EQUAL(0, found.kept.size());
  CHECK(found.explained.model.u == found.calibrated.model.u);
  // What is missing is still there, where the effect leaves the noise alone.
  CHECK(explain::Goodness::combined(found.explained.goodness.held_out) > 2.0);
}
