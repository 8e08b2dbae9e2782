// SPDX-License-Identifier: Apache-2.0
// The runs of the benchmark by the solvers that a rig engineer would take instead of the model's step.

#include <benchmark/benchmark.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <cmath>
#include <limits>

#include "tests/benchmark/rivals/cases.hpp"
#include "tools/study/reference/cvode_integrator.hpp"

namespace hotfire::test {
namespace {

using FrictionRun = AxisRun<true>;
using PlainRun = AxisRun<false>;
using TaosRun = VehicleRun<Taos, 4>;
using MasvRun = VehicleRun<Masv, 12>;

/// Beyond this a state of any unit has run away: the step is not stable.
constexpr double kRunaway = 1e12;

/// Argument: steps a millisecond. An error of infinity is a step that is not stable.
template <class Run, class Method>
void rival(benchmark::State& state) {
  Run run;
  const auto parts = static_cast<int>(state.range(0));
  const auto start = run.start();
  typename Run::Rows rows;
  bool is_stable = true;
  for (auto _ : state) {
    auto x = start;
    rows.clear();
    for (std::size_t i = 0; i < run.samples() && is_stable; ++i) {
      run.drive(i);
      for (int part = 0; part < parts; ++part) {
        Method::step(run.system, Run::sample / parts, x);
      }
      rows.push_back(Run::read(x));
      is_stable = x.cwiseAbs().maxCoeff() < kRunaway;
    }
  }
  state.counters["error"] = is_stable ? run.error(rows) : std::numeric_limits<double>::infinity();
}

template <class Run>
int rate_for_cvode(double, N_Vector state, N_Vector result, void* user) {
  const auto& system = *static_cast<const typename Run::System*>(user);
  using Point = PointOf<typename Run::System>;
  Point rate;
  system.derivative(Point(Eigen::Map<const Point>(N_VGetArrayPointer(state))), rate);
  Eigen::Map<Point>(N_VGetArrayPointer(result)) = rate;
  return 0;
}

template <class Run>
int jacobian_for_cvode(double, N_Vector state, N_Vector, SUNMatrix matrix, void* user, N_Vector, N_Vector, N_Vector) {
  const auto& system = *static_cast<const typename Run::System*>(user);
  using Point = PointOf<typename Run::System>;
  JacobianOf<typename Run::System> jacobian;
  system.jacobian(Point(Eigen::Map<const Point>(N_VGetArrayPointer(state))), jacobian);
  Eigen::Map<JacobianOf<typename Run::System>>(SUNDenseMatrix_Data(matrix)) = jacobian;
  return 0;
}

/// CVODE (BDF) with the analytic Jacobian, started afresh at every command. Argument: digits of the relative tolerance.
template <class Run>
void cvode_with_jacobian(benchmark::State& state) {
  Run run;
  typename Run::Rows rows;
  for (auto _ : state) {
    study::CvodeIntegrator integrator(rate_for_cvode<Run>, &run.system, Run::scales(),
                                      std::pow(10.0, -static_cast<double>(state.range(0))));
    integrator.use_jacobian(jacobian_for_cvode<Run>);
    using Point = PointOf<typename Run::System>;
    Eigen::Map<Point> x(integrator.state());
    x = run.start();
    rows.clear();
    for (std::size_t i = 0; i < run.samples(); ++i) {
      run.drive(i);
      integrator.advance(static_cast<double>(i + 1) * Run::sample);
      rows.push_back(Run::read(Point(x)));
    }
  }
  state.counters["error"] = run.error(rows);
}

void ours_plain(benchmark::State& state) {
  const AxisCase declared;
  const PlainRun run;
  study::ReferenceRows rows;
  for (auto _ : state) {
    rows = run_axis(declared.parameters, static_cast<int>(state.range(0)));
  }
  state.counters["error"] = run.error(rows);
}

/// All rivals of a plant; page.cpp reads the names.
template <class Run>
void against(const std::string& plant) {
  const auto add = [&](const char* method, void (*function)(benchmark::State&), std::initializer_list<int> arguments) {
    auto* own = benchmark::RegisterBenchmark((std::string(method) + "_" + plant).c_str(), function);
    for (const int argument : arguments) {
      own->Arg(argument);
    }
  };
  const auto parts = {1, 2, 3, 4, 6, 8, 12, 16};
  add("rk4", rival<Run, RungeKutta>, parts);
  add("extrapolation2", rival<Run, Extrapolation<2>>, parts);
  add("extrapolation3", rival<Run, Extrapolation<3>>, parts);
  add("midpoint2", rival<Run, ImplicitMidpoint<2>>, parts);
  add("midpoint3", rival<Run, ImplicitMidpoint<3>>, parts);
  add("jacobian", cvode_with_jacobian<Run>, {2, 3, 4, 5, 6, 7});
}

[[maybe_unused]] const bool kRegistered = [] {
  benchmark::RegisterBenchmark("ours_plain", ours_plain)->Arg(1)->Arg(2)->Arg(4)->Arg(8);
  against<PlainRun>("plain");
  against<FrictionRun>("axis");
  against<TaosRun>("taos");
  against<MasvRun>("masv");
  return true;
}();

}  // namespace
}  // namespace hotfire::test
