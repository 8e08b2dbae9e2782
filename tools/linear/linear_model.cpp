// SPDX-License-Identifier: Apache-2.0
#include "tools/linear/linear_model.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"

namespace hotfire::linear {

namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;

/// A step in the states that are kept, and what the outputs at its end and the load forces over it are.
struct Step {
  MatrixXd a;
  MatrixXd b;
  MatrixXd read_by_state;
  MatrixXd read_by_input;
  MatrixXd force_by_state;
  MatrixXd force_by_input;
};

MatrixXd load_force_rows(const StepMap& map, const MatrixXd& of) {
  MatrixXd rows(static_cast<Index>(map.load_force.size()), of.cols());
  for (Index i = 0; i < rows.rows(); ++i) {
    rows.row(i) = of.row(map.load_force[static_cast<std::size_t>(i)]);
  }
  return rows;
}

/// Of all inputs of a map, ports included.
Step step_of(const StepMap& map, const ReducedMap& reduced) {
  const MatrixXd force = load_force_rows(map, map.by_state);
  return {reduced.a,
          reduced.b,
          map.output_by_state * reduced.of_kept,
          map.output_by_state * reduced.of_input + map.output_by_input,
          force * reduced.of_kept,
          force * reduced.of_input + load_force_rows(map, map.by_input)};
}

LinearModel model_of(const Plant& plant, const StepMap& map, const ReducedMap& reduced, const Step& step, double period) {
  const auto inputs = static_cast<Index>(map.inputs.size());
  LinearModel model;
  model.topology = plant.topology();
  model.inputs = map.inputs;
  model.outputs = map.outputs;
  for (const int force : map.load_force) {
    model.outputs.push_back(map.states[static_cast<std::size_t>(force)]);
  }
  for (const int kept : reduced.kept) {
    model.states.push_back(map.states[static_cast<std::size_t>(kept)]);
  }
  const MatrixXd b = step.b.leftCols(inputs);
  const ContinuousMap flow = continuous(step.a, b, map.step);
  model.a = flow.a;
  model.b = flow.b;
  model.by_logarithm = flow.by_logarithm;
  // Outputs at the end of a step as a function of the state there, and not of the one before: what a step brought about is
  // undone. A load force is the mean of those over the steps before and after.
  const Eigen::PartialPivLU<MatrixXd> back(step.a.transpose());
  const auto before = [&](const MatrixXd& rows) { return MatrixXd(back.solve(rows.transpose()).transpose()); };
  const MatrixXd read = before(step.read_by_state);
  const MatrixXd force = before(step.force_by_state);
  const auto outputs = static_cast<Index>(model.outputs.size());
  model.c = MatrixXd(outputs, step.a.cols());
  model.d = MatrixXd(outputs, inputs);
  model.c << read, 0.5 * (force + step.force_by_state);
  model.d << step.read_by_input.leftCols(inputs) - read * b, step.force_by_input.leftCols(inputs) - 0.5 * force * b;
  model.period = period;
  model.step_a = MatrixXd::Identity(step.a.rows(), step.a.cols());
  model.step_b = MatrixXd::Zero(b.rows(), b.cols());
  for (int k = 0; k < static_cast<int>(std::lround(period / map.step)); ++k) {
    model.step_b += model.step_a * b;
    model.step_a = (step.a * model.step_a).eval();
  }
  model.delays = plant.delays();
  return model;
}

/// Spring and damper in the place of a law: force = spring x + damper x' for x = argument.
struct Equivalent {
  double spring = 0.0;
  double damper = 0.0;  ///< [s]
};

Equivalent equivalent(const Wave& signal, Complex argument, double frequency) {
  if (!(std::abs(argument) > 0.0)) {
    return {};
  }
  const Complex gain = signal.fundamental() / argument;
  return {gain.real(), gain.imag() / (2.0 * std::numbers::pi * frequency)};
}

/// What the friction of every bearing is at a balance, of the axis that slips more.
std::vector<BearingSpring> bearings_of(const Plant& plant, const Balance& balance) {
  constexpr double kLeast = 1.0;  // N m/rad: next to nothing, and still a spring
  std::vector<BearingSpring> bearings;
  for (std::size_t e = 0; 2 * e + 1 < balance.axes.size(); ++e) {
    const auto slips = [&](std::size_t axis) { return std::abs(balance.axes[axis].slip.fundamental()); };
    const std::size_t axis = slips(2 * e) >= slips(2 * e + 1) ? 2 * e : 2 * e + 1;
    const Complex slip = balance.axes[axis].slip.fundamental();
    BearingSpring own = plant.bearing_spring(static_cast<int>(e));
    if (std::abs(slip) > 0.0) {
      const Complex gain = own.stiffness * (1.0 - balance.ports[axis].ports[kFrictionPort].fundamental() / slip);
      own = {std::max(gain.real(), kLeast), gain.imag() / (2.0 * std::numbers::pi * balance.frequency)};
    }
    bearings.push_back(own);
  }
  return bearings;
}

}  // namespace

LinearModel small_signal_model(const Plant& plant, double period) {
  const StepMap map = plant.map(With::all_effects);
  const ReducedMap own = reduced(map);
  return model_of(plant, map, own, step_of(map, own), period);
}

LinearModel quasi_linear_model(const HarmonicBalance& system, double period, const Balance& balance) {
  const LinearParts parts(system.plant(), system.plant().map(With::linear_parts, bearings_of(system.plant(), balance)));
  const StepMap& map = parts.map();
  const ReducedMap& own = parts.reduced_map();
  Step step = step_of(map, own);
  const double h = map.step;
  const auto kept = step.a.rows();
  const auto inputs = static_cast<Index>(map.inputs.size());
  // Of each law: its argument as a row of the kept states, its gains, and its port.
  const auto count = static_cast<Index>(parts.ports().size());
  MatrixXd now(count, kept);   // the signal by the state at the start of a step
  MatrixXd then(count, kept);  // and at its end
  for (Index k = 0; k < count; ++k) {
    const auto [axis, port] = parts.ports()[static_cast<std::size_t>(k)];
    const auto i = static_cast<std::size_t>(axis);
    const int first = map.first[i];
    const auto state = [&](int index) { return MatrixXd(own.of_kept.row(first + index)); };
    const AxisWaves& moved = balance.axes[i];
    const double arm = system.plant().moment_arm(axis);
    MatrixXd row;
    Complex argument;
    switch (port) {
      case kFlowPort:
      case kValvePort: {
        const int own_state = port == kFlowPort ? model::AxisStates::kOpening : model::AxisStates::kPiston;
        row = state(own_state);
        argument = moved.states[static_cast<std::size_t>(own_state)].fundamental();
        break;
      }
      case kPistonPort:
        row = state(model::AxisStates::kPiston);
        argument = moved.states[model::AxisStates::kPiston].fundamental();
        break;
      case kSpringPort:
        row = state(model::AxisStates::kPiston) - arm * state(model::AxisStates::kAngle);
        argument = moved.states[model::AxisStates::kPiston].fundamental() -
                   arm * moved.states[model::AxisStates::kAngle].fundamental();
        break;
      case kTorquePort:
        row = state(model::AxisStates::kAngle);
        argument = moved.states[model::AxisStates::kAngle].fundamental();
        break;
      default:
        row = MatrixXd::Zero(1, kept);  // the bearing: its spring has it
    }
    const Equivalent law = equivalent(balance.ports[i].ports[static_cast<std::size_t>(port)], argument, balance.frequency);
    now.row(k) = (0.5 * law.spring - law.damper / h) * row;
    then.row(k) = (0.5 * law.spring + law.damper / h) * row;
  }
  const MatrixXd& columns = parts.port_columns();
  const Eigen::PartialPivLU<MatrixXd> implicit(MatrixXd::Identity(kept, kept) - columns * then);
  const MatrixXd a = implicit.solve(step.a + columns * now);
  const MatrixXd b = implicit.solve(MatrixXd(step.b.leftCols(inputs)));
  // The signals over the step, as what they add to its readings and forces.
  const MatrixXd signal_by_state = now + then * a;
  const MatrixXd signal_by_input = then * b;
  const MatrixXd read_by_port = parts.outputs_by_port();
  const MatrixXd force_by_port = parts.forces_by_port();
  Step closed{a,
              b,
              step.read_by_state + read_by_port * signal_by_state,
              step.read_by_input.leftCols(inputs) + read_by_port * signal_by_input,
              step.force_by_state + force_by_port * signal_by_state,
              step.force_by_input.leftCols(inputs) + force_by_port * signal_by_input};
  return model_of(system.plant(), map, own, closed, period);
}

std::vector<Complex> poles(const LinearModel& model) {
  const Eigen::VectorXd scale = balancing(model.a);
  const MatrixXd balanced = scale.asDiagonal().inverse() * model.a * scale.asDiagonal();
  const VectorXcd all = Eigen::EigenSolver<MatrixXd>(balanced, false).eigenvalues();
  std::vector<Complex> sorted(all.begin(), all.end());
  std::sort(sorted.begin(), sorted.end(), [](Complex a, Complex b) {
    const double sizes = std::abs(a) - std::abs(b);
    return std::abs(sizes) > 1e-9 * std::abs(a) ? sizes < 0.0 : a.imag() < b.imag();
  });
  return sorted;
}

int place_of(const std::vector<Quantity>& quantities, const std::string& name, const std::string& option) {
  const auto found =
      std::find_if(quantities.begin(), quantities.end(), [&](const Quantity& own) { return own.name == name; });
  if (found == quantities.end()) {
    std::vector<std::string_view> names;
    std::transform(quantities.begin(), quantities.end(), std::back_inserter(names),
                   [](const Quantity& own) { return std::string_view(own.name); });
    throw UsageError(option + " " + name + ": the model has no such signal; " + suggestion(name, names));
  }
  return static_cast<int>(found - quantities.begin());
}

Complex response(const LinearModel& model, int output, int input, double frequency, bool held) {
  const double angle = 2.0 * std::numbers::pi * frequency;
  const Complex pole = held ? std::polar(1.0, angle * model.period) : Complex(0.0, angle);
  const auto states = model.a.rows();
  const MatrixXcd dynamics = pole * MatrixXcd::Identity(states, states) - (held ? model.step_a : model.a).cast<Complex>();
  const VectorXcd driven = (held ? model.step_b : model.b).col(input).cast<Complex>();
  Complex gain =
      model.d(output, input) + (model.c.row(output).cast<Complex>() * dynamics.partialPivLu().solve(driven)).value();
  for (const Delay& delay : model.delays) {
    if (delay.name == model.inputs[static_cast<std::size_t>(input)].name ||
        delay.name == model.outputs[static_cast<std::size_t>(output)].name) {
      gain *= std::polar(1.0, -angle * delay.seconds);
    }
  }
  return gain;
}

analysis::FrequencyResponse response(const LinearModel& model, int output, int input, const std::vector<double>& frequencies,
                                     bool held) {
  analysis::FrequencyResponse points;
  for (const double frequency : frequencies) {
    points.push_back({frequency, response(model, output, input, frequency, held), 1.0});
  }
  return points;
}

DescribedResponse described_response(const HarmonicBalance& system, int axis, double amplitude, double period,
                                     const std::vector<double>& frequencies, const std::vector<std::string>& outputs) {
  DescribedResponse described;
  described.amplitude = amplitude;
  std::vector<int> places;
  std::transform(outputs.begin(), outputs.end(), std::back_inserter(places),
                 [&](const std::string& output) { return place_of(system.parts().map().outputs, output, "output"); });
  for (const double frequency : frequencies) {
    std::vector<Complex> commands(static_cast<std::size_t>(system.plant().axes()));
    commands[static_cast<std::size_t>(axis)] = amplitude * hold_factor(frequency, period, system.parts().map().step);
    Balance* near = described.balances.empty() ? nullptr : &described.balances.back();
    std::optional<Balance> balance = system.solve(frequency, commands, near);
    if (!balance && near != nullptr) {
      balance = system.solve(frequency, commands);
    }
    if (balance && near != nullptr) {
      near->slopes.reset();
    }
    if (!balance) {
      described.without.push_back(frequency);
      continue;
    }
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      const Complex gain = balance->outputs[static_cast<std::size_t>(places[k])] / amplitude;
      described.outputs[outputs[k]].push_back({frequency, gain, 1.0});
    }
    described.balances.push_back(std::move(*balance));
  }
  return described;
}

}  // namespace hotfire::linear
