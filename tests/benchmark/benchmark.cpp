// SPDX-License-Identifier: Apache-2.0
// Prints docs/performance.md: hotfire-benchmark --benchmark_min_time=0.2 > docs/performance.md

#include <benchmark/benchmark.h>

#include <cmath>
#include <iostream>

#include "tests/benchmark/page.hpp"
#include "tests/benchmark/rivals/cases.hpp"
#include "tests/simulate/parameter_sets.hpp"

namespace hotfire::test {
namespace {

using Axis = model::Simplex<double>;

constexpr double kStep = 5e-4;

/// A command that goes on moving the engine, cheap beside a step.
double command_at(long step) { return (step / 400) % 2 == 0 ? 0.01 : -0.01; }

void step_axis(benchmark::State& run) {
  const Axis plant(hot_fire_axis().parameters, kStep);
  Axis::State state = plant.steady(0.0);
  long step = 0;
  for (auto _ : run) {
    plant.step(state, command_at(step++));
    benchmark::DoNotOptimize(state);
  }
  run.counters["bytes"] = static_cast<double>(sizeof(Axis) + sizeof(Axis::State));
}

template <class Vehicle>
void step_vehicle(benchmark::State& run, int modes) {
  typename Vehicle::Parameters parameters = hot_fire<Vehicle>();
  parameters.modes = random_modes<typename Vehicle::Modes>(modes, 1.0 / 1.05e8, 5);
  const Vehicle plant(parameters, kStep);
  typename Vehicle::State state = plant.steady({});
  typename Vehicle::Inputs inputs;
  long step = 0;
  for (auto _ : run) {
    inputs.commands.fill(command_at(step++));
    plant.step(state, inputs);
    benchmark::DoNotOptimize(state);
  }
  run.counters["bytes"] = static_cast<double>(sizeof(Vehicle) + sizeof(typename Vehicle::State));
}

void step_taos(benchmark::State& run) { step_vehicle<Taos>(run, 4); }
void step_masv(benchmark::State& run) { step_vehicle<Masv>(run, static_cast<int>(run.range(0))); }

/// The largest error of piston and engine of one axis, rms over the signal's rms.
double axis_error(const study::ReferenceRows& rows) {
  static const study::ReferenceRows reference =
      study::integrate_reference(hot_fire_axis().reference, axis_commands(), kAxisSample, 0.0);
  return std::max(relative_rms(rows, reference, 0), relative_rms(rows, reference, 1));
}

// Argument of ours: steps a millisecond. Of CVODE: digits of the relative tolerance. Starts are worked out before.

void ours_axis(benchmark::State& run) {
  const AxisCase axis = hot_fire_axis();
  study::ReferenceRows rows;
  for (auto _ : run) {
    rows = run_axis(axis.parameters, static_cast<int>(run.range(0)));
  }
  run.counters["error"] = axis_error(rows);
}

void cvode_axis(benchmark::State& run) {
  const AxisCase axis = hot_fire_axis();
  study::ReferenceRows rows;
  long evaluations = 0;
  for (auto _ : run) {
    rows = study::integrate_reference(axis.reference, axis_commands(), kAxisSample, 0.0,
                                      std::pow(10.0, -static_cast<double>(run.range(0))), &evaluations);
  }
  run.counters["error"] = axis_error(rows);
  run.counters["evaluations"] = static_cast<double>(evaluations) / static_cast<double>(run.iterations());
}

template <class Vehicle>
void ours_vehicle(benchmark::State& run) {
  const auto parts = static_cast<int>(run.range(0));
  const Vehicle plant(every_effect<Vehicle>(), kSample / parts);
  const typename Vehicle::State start = plant.steady({});
  VehicleRows rows;
  for (auto _ : run) {
    rows = run_model(plant, start, parts);
  }
  run.counters["error"] = vehicle_error<Vehicle>(rows);
}

template <class Vehicle>
void cvode_vehicle(benchmark::State& run) {
  const typename Vehicle::Parameters parameters = every_effect<Vehicle>();
  const Vehicle plant(parameters, kSample);
  const ReferenceVehicle reference = reference_of(parameters, plant);
  const ReferenceVehicle::Start start = start_of(plant.steady({}), parameters.modes.modes);
  VehicleRows rows;
  long evaluations = 0;
  for (auto _ : run) {
    rows = integrate_reference(reference, start, command_profile<Vehicle>(), kSample,
                               std::pow(10.0, -static_cast<double>(run.range(0))), &evaluations);
  }
  run.counters["error"] = vehicle_error<Vehicle>(rows);
  run.counters["evaluations"] = static_cast<double>(evaluations) / static_cast<double>(run.iterations());
}

void ours_taos(benchmark::State& run) { ours_vehicle<Taos>(run); }
void ours_masv(benchmark::State& run) { ours_vehicle<Masv>(run); }
void cvode_taos(benchmark::State& run) { cvode_vehicle<Taos>(run); }
void cvode_masv(benchmark::State& run) { cvode_vehicle<Masv>(run); }

/// As many parameter sets as a dispersion has; 2 s of each.
constexpr int kSets = 1000;
constexpr std::size_t kRows = 1000;

template <class Simulate>
void batch(benchmark::State& run, Simulate&& simulate) {
  const ParameterSets sets(kSets, kRows);
  for (auto _ : run) {
    simulate(sets);
  }
  run.counters["simulated"] = sets.simulated_seconds();
}

void batch_alone(benchmark::State& run) {
  batch(run, [](const ParameterSets& sets) { sets.simulate_alone(); });
}
void batch_together(benchmark::State& run) {
  batch(run, [](const ParameterSets& sets) { sets.simulate_together(); });
}

BENCHMARK(batch_alone);
BENCHMARK(batch_together);
BENCHMARK(step_axis);
BENCHMARK(step_taos);
BENCHMARK(step_masv)->Arg(0)->Arg(16)->Arg(32)->Arg(48)->Arg(64);
BENCHMARK(ours_axis)->RangeMultiplier(2)->Range(1, 16);
BENCHMARK(cvode_axis)->DenseRange(2, 7)->Iterations(1);
BENCHMARK(ours_taos)->RangeMultiplier(2)->Range(1, 16);
BENCHMARK(cvode_taos)->DenseRange(2, 7)->Iterations(1);
BENCHMARK(ours_masv)->RangeMultiplier(2)->Range(1, 16);
BENCHMARK(cvode_masv)->DenseRange(2, 7)->Iterations(1);

}  // namespace
}  // namespace hotfire::test

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  hotfire::test::Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  std::cout << hotfire::test::performance_page(collector.measured());
  return 0;
}
