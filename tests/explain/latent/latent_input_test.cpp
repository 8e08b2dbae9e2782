// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/latent_input.hpp"
#include "tools/explain/latent/locate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <CppUTest/TestHarness.h>

#include "tests/explain/latent/missing_effect.hpp"
#include "tests/explain/readings.hpp"
#include "tests/support/add_effect.hpp"
#include "tools/simulate/simulate.hpp"

namespace {

using namespace hotfire;
using explain::Dataset;
using explain::Fitted;
using explain::LatentInput;
using explain::LatentPlace;
using explain::LatentProblem;
using explain::Port;

constexpr double kTorque = 2e3;  // N m
constexpr double kNoise = 1e-6;  // m, rad

/// Adds a torque against the engine that is a table over time.
void add_torque_over_time(ModelFile& model, const std::vector<double>& times, const std::vector<double>& torques) {
  using Torque = model::UnlistedMotion<model::Site::engine_torque>;
  test::add_effect<Torque>(std::get<SimplexParameters>(model.parameters), [&](auto& effect) {
    effect.option = 4;
    effect.table.points = static_cast<int>(times.size());
    std::ranges::copy(times, effect.table.x.begin());
    std::ranges::copy(torques, effect.table.y.begin());
  });
}

/// A plant at rest under a torque against the engine that is a table over time: a triangle of 4 s.
Record record_of() {
  ModelFile model;
  model.parameters = SimplexParameters{};
  add_torque_over_time(model, {2.0, 4.0, 6.0}, {0.0, kTorque, 0.0});
  Record record;
  record.name = record.path = "torque.csv";
  record.period = 2e-3;
  record.rows = 4000;
  record.channels.push_back({"command", "rad", std::vector<double>(record.rows, 0.0)});
  const Record modelled = simulate(model, record);
  std::mt19937_64 random(3);
  test::add_readings(record, modelled, {{"piston", kNoise}, {"engine", kNoise}}, random);
  return record;
}

ModelFile declared() {
  ModelFile model;
  model.parameters = SimplexParameters{};
  model.noise = {{"piston", kNoise}, {"engine", kNoise}};
  return model;
}

/// The torque that is smoothed from a record.
struct Smoothed {
  explicit Smoothed(const Record& record)
      : model(declared()),
        data(explain::make_dataset(model, {record})),
        problem(explain::latent_problem(data, data, about(model), explain::Resolution::coarse, 1)),
        input(explain::most_likely_input(problem, kEngine)) {
    explain::smooth(problem, kEngine, input);
  }

  static Fitted about(const ModelFile& model) {
    Fitted fitted;
    fitted.base = model.parameters;
    return fitted;
  }

  Eigen::VectorXd torque() const { return problem.scales.input(static_cast<int>(Port::engine)) * input.signal[0]; }

  static constexpr LatentPlace kEngine{Port::engine, 0};
  ModelFile model;
  Dataset data;
  LatentProblem problem;
  LatentInput input;
};

double rms_about_mean(const Eigen::VectorXd& values) { return std::sqrt((values.array() - values.mean()).square().mean()); }

}  // namespace

TEST_GROUP(LatentInput){};

// A constant torque and constant zeros are told apart by their priors alone, so a record may divide its level among them.
TEST(LatentInput, TheSignalAtItsOwnPlaceIsReconstructedFromWhatTheSensorsRead) {
  const Smoothed of(record_of());
  CHECK(of.input.log_likelihood > explain::likelihood_without(of.problem) + 1e4);
  // What is left is noise: within its own spread, sqrt(2 / rows) = 2 %, and what the signal itself takes up of it.
  for (std::size_t c = 0; c < 2; ++c) {
    CHECK(of.input.leaves[c] > 0.8);
    CHECK(of.input.leaves[c] < 1.1);
  }
  Eigen::VectorXd off = of.torque();
  for (Eigen::Index row = 0; row < off.size(); ++row) {
    off(row) -= kTorque * std::max(0.0, 1.0 - std::abs(static_cast<double>(row) * 2e-3 - 4.0) / 2.0);
  }
  CHECK(std::abs(off.mean()) < 0.2 * kTorque);
  // Torque against the engine by 1e-6 rad of noise over its stiffness of about 2e7 N m/rad: some tens of N m.
  CHECK(rms_about_mean(off) < 0.02 * kTorque);
}

TEST(LatentInput, TheZeroOfASensorChangesNothingOfTheSignalButItsLevel) {
  Record record = record_of();
  const Smoothed before(record);
  for (double& value : record.channels.back().values) {
    value += 5.0 * kNoise;
  }
  const Smoothed of(record);
  CHECK(of.input.leaves[0] < 1.1);
  CHECK(of.input.leaves[1] < 1.1);
  CHECK(rms_about_mean(of.torque() - before.torque()) < 2e-3 * kTorque);
  LONGS_EQUAL(2, of.input.move.size());
  CHECK(of.input.move(1) > before.input.move(1));
}

// A tone of 37 Hz, and the same at a tenth of a hertz: the first is faster than the servo by far, the second slower.
TEST(LatentInput, TheSignalOfASensorIsAsFastAsItIsAndThatOfAPortIsSlow) {
  constexpr LatentPlace kPistonSensor{std::nullopt, 0};
  const auto most_likely = [](double frequency, const LatentPlace& place) {
    Record record = record_of();
    for (std::size_t row = 0; row < record.rows; ++row) {
      const double t = static_cast<double>(row) * record.period;
      record.channels[1].values[row] += 10.0 * kNoise * std::sin(2.0 * std::numbers::pi * frequency * t);
    }
    const ModelFile model = declared();
    const Dataset data = explain::make_dataset(model, {record});
    return explain::most_likely_input(
               explain::latent_problem(data, data, Smoothed::about(model), explain::Resolution::coarse, 1), place)
        .prior;
  };
  const double fast = most_likely(37.0, kPistonSensor).correlation_time;
  CHECK(fast < 1.0);
  CHECK(most_likely(0.1, kPistonSensor).correlation_time > fast);
  CHECK(most_likely(37.0, {Port::engine, 0}).correlation_time > 5.0);
}

TEST(LatentInput, WhatAnEffectRepresentsOfTheSignalIsGivenBack) {
  using Scale = model::SensorScale;
  const auto set_error = [](double error) {
    return [error](auto& effect) {
      effect.option = 1;  // engine
      effect.error = error;
    };
  };
  ModelFile truth = test::with_effect<model::TorqueOffset>({2e3});
  test::add_effect<Scale>(std::get<SimplexParameters>(truth.parameters), set_error(0.05));
  const Dataset data = explain::make_dataset(test::declared(), {test::record_of(truth)});
  Fitted fitted;
  fitted.base = test::declared().parameters;
  const std::size_t effect = test::add_effect<Scale>(std::get<SimplexParameters>(fitted.base), set_error(0.03));
  const auto smoothed = [&] {
    const LatentProblem problem = explain::latent_problem(data, data, fitted, explain::Resolution::coarse, 1);
    LatentInput input = explain::most_likely_input(problem, Smoothed::kEngine);
    explain::smooth(problem, Smoothed::kEngine, input);
    return input;
  };
  // A torque cannot imitate a twentieth of a reading that the piston does not have.
  CHECK(smoothed().leaves[1] > 1.5);

  explain::Candidate candidate;
  candidate.effect = effect;
  fitted.free = explain::effect_parameters(fitted.base, candidate, explain::scales_of(fitted.base, data));
  fitted.u = {fitted.free.front().coordinate(0.03)};
  const LatentInput beside = smoothed();
  CHECK(beside.leaves[1] < 1.1);
  DOUBLES_EQUAL(0.05, fitted.free.front().value(fitted.u.front() + beside.move(0)), 1e-3);
}

TEST(LatentInput, WhatAModelLeavesOfThinnedRecordsIsWhatItLeavesOfTheRecords) {
  const ModelFile truth = test::with_effect<model::RateLimit>({0.1});
  const Dataset logged = explain::make_dataset(test::declared(), {test::record_of(truth, 3.0)});
  const Dataset thin = explain::thinned(logged, 4.0 * logged.experiments[0].period);
  const auto mean_square = [&](const Dataset& of_rows) {
    const LatentProblem problem =
        explain::latent_problem(of_rows, thin, Smoothed::about(truth), explain::Resolution::coarse, 1);
    const Eigen::ArrayXd left = problem.left[0].col(0).array();
    const Eigen::ArrayXd square = left.isNaN().select(0.0, left.square());
    return square.sum() / static_cast<double>(left.size() - left.isNaN().count());
  };
  // 2,500 rows of noise scatter by 3 %.
  DOUBLES_EQUAL(1.0, mean_square(logged), 0.15);
  CHECK(mean_square(thin) > 2.0);
}

TEST(LatentInput, HeldOutRowsAreNotLookedAt) {
  const ModelFile model = declared();
  Dataset data = explain::make_dataset(model, {record_of()});
  const auto likelihood = [&] {
    Fitted about;
    about.base = model.parameters;
    return explain::most_likely_input(explain::latent_problem(data, data, about, explain::Resolution::coarse, 1),
                                      {Port::spring, 0})
        .log_likelihood;
  };
  const double before = likelihood();
  for (std::size_t row = data.experiments[0].held_out[0].first; row < data.experiments[0].held_out[0].last; ++row) {
    data.experiments[0].measured[0][row] += 1.0;
  }
  DOUBLES_EQUAL(before, likelihood(), 0.0);
}

TEST(LatentInput, TheFlowOfARowIsThatOfTheSimulation) {
  const ModelFile model = declared();
  const Dataset data = explain::make_dataset(model, {record_of()});
  const auto& parameters = std::get<SimplexParameters>(model.parameters);
  const explain::FlowScales scales = explain::flow_scales(parameters);
  const auto flows = explain::linear_flow(data, parameters, scales, explain::Resolution::coarse, 1);
  LONGS_EQUAL(1, flows.size());
  LONGS_EQUAL(data.experiments[0].rows() - 1, flows[0].rows.size());
  // A hundred rows under a constant torque, by the flow and by the model's own torque.
  ModelFile truth = model;
  add_torque_over_time(truth, {0.0, 1e-4}, {0.0, kTorque});
  Record record = record_of();
  const Record modelled = simulate(truth, record);
  Eigen::Matrix<double, 8, 1> deviation = Eigen::Matrix<double, 8, 1>::Zero();
  const double input = kTorque / scales.input(static_cast<int>(Port::engine));
  for (std::size_t row = 0; row < 100; ++row) {
    deviation =
        flows[0].rows[row].transition * deviation + flows[0].rows[row].response.col(static_cast<int>(Port::engine)) * input;
  }
  const double angle = scales.state(model::Simplex<double>::kAngle) * deviation(model::Simplex<double>::kAngle);
  const double simulated = modelled.find("engine")->values[100];
  // Half as many steps as `simulate` takes, and a torque that starts within the first of them.
  DOUBLES_EQUAL(simulated, angle, 0.01 * std::abs(simulated));
}

// A stiff seal whose friction falls to three quarters within 6 mm/s, beside a piston of 50 kg: while it breaks away, a
// deviation grows by a thousand in a row.
TEST(LatentInput, ASealThatBreaksAwayLeavesEveryPlaceALikelihood) {
  const std::initializer_list<double> seal{7000.0, 1.3, 0.006, 5e8};
  const auto problem_of = [](const Dataset& data, const ModelFile& model) {
    return explain::latent_problem(data, data, Smoothed::about(model), explain::Resolution::coarse, 1);
  };
  const auto rows_that_forget = [](const LatentProblem& problem) {
    return std::ranges::count_if(problem.flows[0].rows, [](const explain::RowFlow& row) { return row.forgets.any(); });
  };
  const ModelFile sticking = test::with_effect<model::PistonFriction>(seal);
  ModelFile truth = sticking;
  test::add_effect<model::TorqueOffset>(std::get<SimplexParameters>(truth.parameters),
                                        [](auto& effect) { effect.torque = kTorque; });
  const Dataset data = test::data_of(truth);
  const LatentProblem problem = problem_of(data, sticking);
  CHECK(rows_that_forget(problem) > 10);
  CHECK(rows_that_forget(problem) < static_cast<std::ptrdiff_t>(data.experiments[0].rows() / 10));
  LONGS_EQUAL(0, rows_that_forget(problem_of(data, test::declared())));
  const double without = explain::likelihood_without(problem);
  for (int port = 0; port < explain::kPorts; ++port) {
    const LatentPlace place{static_cast<Port>(port), 0};
    LatentInput input = explain::most_likely_input(problem, place);
    CHECK(input.log_likelihood > without);
    explain::smooth(problem, place, input);
    CHECK(input.signal[0].allFinite());
    CHECK(input.states[0].allFinite());
  }
}

TEST(LatentInput, WhatAnEffectMayLeaveOfItsOwnLawRefutesNoOtherSite) {
  explain::Place torque;
  torque.sites = {"engine_torque"};
  torque.is_possible = true;
  torque.is_likely = true;
  explain::Place sensor;
  sensor.sites = {"sensor.engine"};
  const explain::Located single{{torque, sensor}, true};
  CHECK(single.refutes("sensor.engine", {}));
  CHECK(single.refutes("sensor.engine", {"flow"}));
  CHECK(!single.refutes("sensor.engine", {"flow", "engine_torque"}));
  CHECK(!single.refutes("engine_torque", {}));
  const explain::Located several{{torque, sensor}, false};
  CHECK(!several.refutes("sensor.engine", {}));
}
