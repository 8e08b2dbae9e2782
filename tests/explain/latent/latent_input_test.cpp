#include "tools/explain/latent/latent_input.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <CppUTest/TestHarness.h>

#include "tools/simulate/simulate.hpp"

namespace {

using namespace hotfire;
using explain::Dataset;
using explain::Fitted;
using explain::LatentInput;
using explain::LatentPlace;
using explain::LatentProblem;
using explain::Port;
using explain::SimplexFamily;

constexpr double kTorque = 2e3;  // N m
constexpr double kNoise = 1e-6;  // m, rad

/// A plant at rest under a torque against the engine that is a table over time: a triangle of 4 s.
Record record_of() {
  ModelFile model;
  auto& parameters = std::get<SimplexParameters>(model.parameters = SimplexParameters{});
  model::visit_effects(parameters, [&]<class E>(std::size_t index, auto& effect) {
    if constexpr (std::is_same_v<E, model::UnlistedMotion<model::Site::engine_torque>>) {
      parameters.effects.active[index] = true;
      effect.option = 4;
      effect.table.points = 3;
      effect.table.x = {2.0, 4.0, 6.0};
      effect.table.y = {0.0, kTorque, 0.0};
    }
  });
  Record record;
  record.name = record.path = "torque.csv";
  record.period = 2e-3;
  record.rows = 4000;
  record.channels.push_back({"command", "rad", std::vector<double>(record.rows, 0.0)});
  const Record modelled = simulate(model, record);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const char* name : {"piston", "engine"}) {
    record.channels.push_back(*modelled.find(name));
    for (double& value : record.channels.back().values) {
      value += kNoise * normal(random);
    }
  }
  return record;
}

ModelFile declared() {
  ModelFile model;
  model.parameters = SimplexParameters{};
  model.noise = {{"piston", kNoise}, {"engine", kNoise}};
  return model;
}

}  // namespace

TEST_GROUP(LatentInput){};

TEST(LatentInput, TheSignalAtItsOwnPlaceIsReconstructedFromWhatTheSensorsRead) {
  const ModelFile model = declared();
  const Dataset data = explain::make_dataset(model, {record_of()});
  Fitted<SimplexFamily> about;
  about.base = std::get<SimplexParameters>(model.parameters);
  const LatentProblem problem = explain::latent_problem(data, about, 1);
  const LatentPlace place{Port::engine, 0};
  LatentInput input = explain::most_likely_input(problem, place);
  explain::smooth(problem, place, input);
  CHECK(input.log_likelihood > explain::likelihood_without(problem) + 1e4);
  // What is left is noise: within its own spread, sqrt(2 / rows) = 2 %, and what the signal itself takes up of it.
  for (std::size_t c = 0; c < 2; ++c) {
    CHECK(input.leaves[c] > 0.8);
    CHECK(input.leaves[c] < 1.1);
  }
  const double scale = problem.scales.input(static_cast<int>(Port::engine));
  double square = 0.0;
  for (Eigen::Index row = 0; row < 4000; ++row) {
    const double t = static_cast<double>(row) * 2e-3;
    const double torque = kTorque * std::max(0.0, 1.0 - std::abs(t - 4.0) / 2.0);
    square += std::pow(scale * input.signal[0](row) - torque, 2) / 4000.0;
  }
  // Torque against the engine by 1e-6 rad of noise over its stiffness of about 2e7 N m/rad: some tens of N m.
  CHECK(std::sqrt(square) < 0.05 * kTorque);
}

// The first half of the record is at rest: only a sensor's zero is off there.
TEST(LatentInput, WhatASensorReadsAtRestIsItsZeroAndNoSignal) {
  constexpr double kZero = 5e-6;  // rad
  const ModelFile model = declared();
  Record record = record_of();
  for (double& value : record.channels.back().values) {
    value += kZero;
  }
  const Dataset data = explain::make_dataset(model, {record});
  Fitted<SimplexFamily> about;
  about.base = std::get<SimplexParameters>(model.parameters);
  const LatentProblem problem = explain::latent_problem(data, about, 1);
  const LatentPlace place{Port::engine, 0};
  LatentInput input = explain::most_likely_input(problem, place);
  explain::smooth(problem, place, input);
  CHECK(input.leaves[0] < 1.1);
  CHECK(input.leaves[1] < 1.1);
  LONGS_EQUAL(2, input.move.size());
  const double zero = input.move(1) * data.experiments[0].zero_deviation[1];
  DOUBLES_EQUAL(kZero, zero, 0.1 * kZero);
}

TEST(LatentInput, HeldOutRowsAreNotLookedAt) {
  const ModelFile model = declared();
  Dataset data = explain::make_dataset(model, {record_of()});
  const auto likelihood = [&] {
      Fitted<SimplexFamily> about;
    about.base = std::get<SimplexParameters>(model.parameters);
    return explain::most_likely_input(explain::latent_problem(data, about, 1), {Port::spring, 0}).log_likelihood;
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
  const auto flows = explain::linear_flow(data, parameters, scales, 1);
  LONGS_EQUAL(1, flows.size());
  LONGS_EQUAL(data.experiments[0].rows() - 1, flows[0].rows.size());
  // A hundred rows under a constant torque, by the flow and by the model's own torque.
  ModelFile truth = model;
  auto& loaded = std::get<SimplexParameters>(truth.parameters);
  model::visit_effects(loaded, [&]<class E>(std::size_t index, auto& effect) {
    if constexpr (std::is_same_v<E, model::UnlistedMotion<model::Site::engine_torque>>) {
      loaded.effects.active[index] = true;
      effect.option = 4;
      effect.table.points = 2;
      effect.table.x = {0.0, 1e-4};
      effect.table.y = {0.0, kTorque};
    }
  });
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
