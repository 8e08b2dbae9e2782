// Prints docs/performance.md: hotfire-benchmark --benchmark_repetitions=5 > docs/performance.md

#include <benchmark/benchmark.h>

#include <cmath>
#include <iostream>

#include "tests/benchmark/page.hpp"
#include "tests/model/taos_comparison.hpp"

namespace hotfire::test {
namespace {

using Axis = model::Simplex<double>;

constexpr double kStep = 5e-4;

/// One axis with the effects that an axis of the vehicle and its bearing have.
Axis::Parameters one_axis() {
  Axis::Parameters parameters;
  activate<model::GimbalFriction, Axis>(parameters, {2, 15e3, 1e8, 1.2, 0.01, 3e3});
  activate<model::SoftStiffness, Axis>(parameters, {0, 4e7, 8e3, {}});
  activate<model::ValveDeadband, Axis>(parameters, {0, 0.02});
  return parameters;
}

/// A command that goes on moving the engine, cheap beside a step.
double command_at(long step) { return (step / 400) % 2 == 0 ? 0.01 : -0.01; }

void step_axis(benchmark::State& run) {
  const Axis plant(one_axis(), kStep);
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

Taos::Parameters every_effect() {
  Taos::Parameters parameters = hot_fire<Taos>();
  parameters.modes = four_modes();
  return parameters;
}

double largest_error(const Rows& rows) {
  static const Rows reference = run_reference(every_effect());
  double largest = 0.0;
  for (std::size_t channel = 0; channel < 4; ++channel) {
    largest = std::max(largest, relative_rms(rows, reference, channel));
  }
  return largest;
}

/// Argument: steps a millisecond. The start is worked out before.
void work_hotfire(benchmark::State& run) {
  const auto parts = static_cast<int>(run.range(0));
  const Taos plant(every_effect(), kSample / parts);
  const Taos::State start = plant.steady({});
  Rows rows;
  for (auto _ : run) {
    rows = run_model(plant, start, parts);
  }
  run.counters["error"] = largest_error(rows);
}

/// Argument: digits of the relative tolerance. The start is worked out before.
void work_cvode(benchmark::State& run) {
  const Taos::Parameters parameters = every_effect();
  const Taos plant(parameters, kSample);
  const ReferenceTaos reference = reference_of(parameters, plant);
  const ReferenceTaos::Start start = start_of(plant.steady({}), parameters.modes.modes);
  Rows rows;
  for (auto _ : run) {
    rows = integrate_reference(reference, start, command_profile(), kSample,
                               std::pow(10.0, -static_cast<double>(run.range(0))));
  }
  run.counters["error"] = largest_error(rows);
}

BENCHMARK(step_axis);
BENCHMARK(step_taos);
BENCHMARK(step_masv)->Arg(0)->Arg(16)->Arg(32)->Arg(48)->Arg(64);
BENCHMARK(work_hotfire)->RangeMultiplier(2)->Range(1, 16);
BENCHMARK(work_cvode)->DenseRange(2, 7)->Iterations(1);

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
