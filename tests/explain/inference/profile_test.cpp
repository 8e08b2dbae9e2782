// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/profile.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <random>

#include "tools/explain/inference/uncertainty.hpp"
#include "tools/explain/terms/candidates.hpp"

namespace {

using namespace hotfire::explain;

/// A leaking axis whose leak, searched in logarithms, is identified to the relative deviation `deviation`: the noise of the
/// record is chosen for it. The declared leakage, which does the same, is free if `with_other`.
struct LeakingAxis {
  Dataset data;
  Fitted fitted;

  LeakingAxis(double deviation, bool with_other) {
    data.channels = {"piston", "engine", "load_pressure"};
    data.used = {true, true, false};
    data.noise = {1.0, 1.0, 1.0};
    data.noise_source = {NoiseSource::declared, NoiseSource::declared, NoiseSource::estimated};
    Experiment experiment;
    experiment.name = "smooth";
    experiment.period = 0.002;
    for (int i = 0; i < 1500; ++i) {
      experiment.input.push_back(0.01 * std::sin(0.012 * i) * std::sin(0.05 * i));
    }
    experiment.measured = {std::vector<double>(1500, 0.0), std::vector<double>(1500, 0.0), {}};
    experiment.fitted = {{0, 1500}};
    experiment.noise = data.noise;
    experiment.zero_deviation.assign(data.channels.size(), 0.0);
    data.experiments.push_back(experiment);

    for (const Candidate& candidate : all_candidates(fitted.base, data)) {
      if (candidate.name == "leakage" && candidate.option_name == "laminar") {
        activate(fitted.base, candidate);
        fitted.free = effect_parameters(fitted.base, candidate, {});
      }
    }
    // No prior but the data's.
    fitted.free.front().prior_deviation = 0.0;
    fitted.u = {std::log(2e-11)};
    measure(deviation);
    if (with_other) {
      const auto other = declared_parameters(fitted.base, {{"actuator.leakage", 1.0}});
      fitted.free.insert(fitted.free.end(), other.begin(), other.end());
      fitted.u.push_back(0.0);
    }
    const Evaluator evaluator(data, Resolution::fine);
    fitted.temper.assign(data.channels.size(), 1.0);
    CHECK_TRUE(fit(evaluator, fitted, {30, 1, 1e-9, Slopes::narrow, nullptr}));
  }

  const Address& leak() const { return fitted.free.front().address; }
  double value() const { return fitted.free.front().value(fitted.u.front()); }
  Intervals profile() const { return profile_intervals(Evaluator(data, Resolution::fine), fitted, 1); }
  double half_of_curvature() const {
    const auto interval = estimates(fitted.free, fitted.u, fitted.normal).front().interval;
    CHECK_TRUE(interval.has_value());
    return 0.5 * std::log(interval->second / interval->first);
  }

 private:
  void measure(double deviation) {
    const std::vector<std::size_t> all{0};
    Eigen::MatrixXd jacobian;
    const Evaluator silent(data, Resolution::fine);
    CHECK_TRUE(silent.differentiate(fitted.base, fitted.free, fitted.u, all, 1, jacobian));
    data.noise.assign(3, deviation * jacobian.norm());
    data.experiments.front().noise = data.noise;
    Prediction truth;
    CHECK_TRUE(silent.predict(fitted.base, fitted.free, fitted.u, 1, truth));
    std::mt19937_64 generator(3);
    std::normal_distribution<double> normal(0.0, data.noise.front());
    for (std::size_t c = 0; c < 2; ++c) {
      for (std::size_t i = 0; i < truth[0][c].size(); ++i) {
        data.experiments.front().measured[c][i] = truth[0][c][i] + normal(generator);
      }
    }
  }
};

}  // namespace

TEST_GROUP(Profile){};

// What an axis does answers a leak in proportion, so that the error is a parabola over the leak itself and its interval
// symmetric there. Over its logarithm the curvature gives an interval that reaches twice as far up as down, exp(1.96
// deviation).
TEST(Profile, OfAParameterThatIsSearchedInLogarithmsAndIsKnownInProportionTheIntervalIsSymmetricInItself) {
  const LeakingAxis axis(0.35, false);
  const Intervals intervals = axis.profile();
  CHECK_EQUAL(1U, intervals.size());
  const auto [low, high] = intervals.at(axis.leak());
  const double ratio = (high - axis.value()) / (axis.value() - low);
  // Either end is found to 2 % of it; a tenth is left for what is not in proportion.
  DOUBLES_EQUAL(1.0, ratio, 0.14);
  CHECK_TRUE(std::exp(axis.half_of_curvature()) > 1.6);
}

TEST(Profile, AParameterThatIsIdentifiedToAPercentKeepsTheIntervalOfTheCurvature) {
  CHECK_TRUE(LeakingAxis(0.01, false).profile().empty());
}

TEST(Profile, AnotherParameterOfTheSameEffectWidensTheInterval) {
  const LeakingAxis alone(0.25, false);
  const LeakingAxis with_other(0.25, true);
  const auto width = [](const LeakingAxis& axis) {
    const auto intervals = axis.profile();
    const auto [low, high] = intervals.at(axis.leak());
    return high - low;
  };
  CHECK_TRUE(width(with_other) > width(alone));
}
