// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/operations.hpp"

#include "tests/model/cvode/axis_comparison.hpp"
#include "tools/simulate/scalar_parameters.hpp"

namespace hotfire::test {

namespace {

StepContents contents_of(const std::string& name, const AxisCase& axis) {
  using Plant = model::Simplex<Counted>;
  const Plant plant(with_scalar<Plant::Parameters>(axis.parameters), 0.5 * kAxisSample);
  Plant::State state = plant.steady(Counted{0.0});
  const std::vector<double> commands = axis_commands();
  Counted::operations = {};
  for (const double command : commands) {
    plant.step(state, Counted{command});
  }
  Operations mean = Counted::operations;
  const auto steps = static_cast<long>(commands.size());
  for (long* kind :
       {&mean.additions, &mean.multiplications, &mean.divisions, &mean.roots, &mean.exponentials, &mean.comparisons}) {
    *kind = (*kind + steps / 2) / steps;
  }
  return {name, mean, sizeof(model::Simplex<double>) + sizeof(model::Simplex<double>::State)};
}

}  // namespace

std::vector<StepContents> contents_of_steps() {
  return {contents_of("one axis as declared", AxisCase{}),
          contents_of("one axis, friction, soft spring, dead band", hot_fire_axis())};
}

}  // namespace hotfire::test
