// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "tools/explain/words/conclusions.hpp"

namespace hotfire::explain {

namespace {

/// Output of a memory by row. A search runs thousands of them over all rows: of a kind that the compiler knows, with all
/// that it calls in one function, the constants of the run leave the loop.
template <model::Memory kKind>
[[gnu::flatten]] void run_memory(model::MemoryParameters<double> memory, const Eigen::VectorXd& argument, double period,
                                 Eigen::VectorXd& output) {
  model::MemoryState<double> state;
  memory.kind = kKind;
  for (Eigen::Index row = 0; row < argument.size(); ++row) {
    output(row) = state.step(memory, argument(row), period);
  }
}

template <model::Memory kKind>
[[gnu::flatten]] void run_memory(std::array<model::MemoryParameters<double>, kSideBySide> memories,
                                 const Eigen::VectorXd& argument, double period,
                                 Eigen::Matrix<double, kSideBySide, Eigen::Dynamic>& output) {
  std::array<model::MemoryState<double>, kSideBySide> states;
  for (auto& memory : memories) {
    memory.kind = kKind;
  }
  // Each memory by its own constants: in a loop over them the compiler computes these again in every row.
  const auto step = [&]<std::size_t... kPlaces>(Eigen::Index row, std::index_sequence<kPlaces...> /*all*/) {
    ((output(static_cast<Eigen::Index>(kPlaces), row) = states[kPlaces].step(memories[kPlaces], argument(row), period)),
     ...);
  };
  for (Eigen::Index row = 0; row < argument.size(); ++row) {
    step(row, std::make_index_sequence<kSideBySide>());
  }
}

/// Runs one memory, or several, of the kind `kind`.
template <class Memories, class Output, std::size_t... kKinds>
void run_kind(model::Memory kind, const Memories& memories, const Eigen::VectorXd& argument, double period, Output& output,
              std::index_sequence<kKinds...> /*all*/) {
  ((static_cast<std::size_t>(kind) == kKinds
        ? run_memory<static_cast<model::Memory>(kKinds)>(memories, argument, period, output)
        : void()),
   ...);
}

constexpr double kTurn = 2.0 * std::numbers::pi;

using AllKinds = std::make_index_sequence<model::kMemoryNames.size()>;

/// True for a law of the signal that a site transmits.
template <model::Site at, int channel = -1>
bool is_own(const Form& form) {
  return form.site == at && form.channel == channel && form.argument == model::term::Names<at, channel>::own;
}

/// True for laws of the spool or of its flow at the oil: the opening is the signal that the valve transmits.
bool is_of_opening(const Form& form) {
  return (form.site == model::Site::valve || form.site == model::Site::flow) &&
         (form.argument == model::Argument::spool || form.argument == model::Argument::flow);
}

/// True for a memory that ends at what enters it, or nearly so, once that rests.
bool follows_at_rest(model::Memory kind) {
  using enum model::Memory;
  constexpr std::array kFollowing{delay, lag, resonance, play, slew, hold, quantise, dead_zone, saturation};
  return std::ranges::find(kFollowing, kind) != kFollowing.end();
}

}  // namespace

double Form::entering(double value) const {
  if (values.empty()) {
    return is_oscillator() ? 0.0 : value;
  }
  return model::curve_value<double>(points, values, points.size(), value);
}

Eigen::Index Form::size() const {
  const bool is_linear_in_curve = !points.empty() && values.empty();
  const Eigen::Index own = is_oscillator() ? 2 : is_linear_in_curve ? static_cast<Eigen::Index>(points.size()) : 1;
  return own + (has_direct() ? 1 : 0);
}

std::string in_words(const Form& form) {
  const std::string_view memory = model::kMemoryNames[static_cast<std::size_t>(form.memory.kind)];
  std::string of = words::spoken(model::kArgumentNames[static_cast<std::size_t>(form.argument)]);
  if (form.factor) {
    of += " x " + words::spoken(model::kArgumentNames[static_cast<std::size_t>(*form.factor)]);
  }
  if (form.is_oscillator()) {
    return form.points.empty() ? std::string(memory) : fmt::format("{} tuned by {}", memory, of);
  }
  const bool remembers = form.memory.kind != model::Memory::none;
  const std::string kind = remembers ? words::spoken(memory) : "gain";
  if (!form.has_curve()) {
    return fmt::format("{} of {}", kind, of);
  }
  if (!remembers) {
    return fmt::format("curve over {}", of);
  }
  return form.curve_first ? fmt::format("{} of a curve over {}", kind, of) : fmt::format("curve over {} of {}", kind, of);
}

Eigen::MatrixXd quantities(const LatentProblem& problem, std::size_t experiment, const Eigen::MatrixXd& deviations) {
  const Flow& flow = problem.flows[experiment];
  const auto rows = static_cast<Eigen::Index>(flow.states.size());
  Eigen::MatrixXd values(rows, static_cast<Eigen::Index>(model::kArgumentNames.size()));
  for (Eigen::Index row = 0; row < rows; ++row) {
    const auto at = static_cast<std::size_t>(row);
    const Eigen::Matrix<double, kFlowStates, 1> state =
        flow.states[at] + problem.scales.state.cwiseProduct(deviations.col(row));
    const model::Surroundings<double> seen{state, flow.piston_command[at], problem.parameters.servovalve,
                                           problem.parameters.actuator, problem.data.experiments[experiment].time_of(at)};
    for (Eigen::Index argument = 0; argument < values.cols(); ++argument) {
      values(row, argument) = seen.at(static_cast<model::Argument>(argument));
    }
  }
  return values;
}

Eigen::VectorXd argument_of(const Form& form, const Eigen::MatrixXd& quantities) {
  const Eigen::VectorXd argument = quantities.col(static_cast<Eigen::Index>(form.argument));
  return form.factor ? Eigen::VectorXd(argument.cwiseProduct(quantities.col(static_cast<Eigen::Index>(*form.factor))))
                     : argument;
}

Eigen::VectorXd remembered(const Form& form, const Eigen::VectorXd& entering, double period) {
  Eigen::VectorXd output(entering.size());
  if (form.is_stops()) {
    model::MemoryState<double> state;
    for (Eigen::Index row = 0; row < entering.size(); ++row) {
      output(row) = state.stop(form.points, static_cast<int>(form.points.size()), entering(row))[form.points.size() - 1];
    }
    return output;
  }
  run_kind(form.memory.kind, form.memory, entering, period, output, AllKinds());
  return output;
}

Eigen::Matrix<double, kSideBySide, Eigen::Dynamic> remembered_side_by_side(std::span<const Form, kSideBySide> forms,
                                                                           const Eigen::VectorXd& entering, double period) {
  std::array<model::MemoryParameters<double>, kSideBySide> memories;
  std::ranges::transform(forms, memories.begin(), &Form::memory);
  Eigen::Matrix<double, kSideBySide, Eigen::Dynamic> output(kSideBySide, entering.size());
  run_kind(memories.front().kind, memories, entering, period, output, AllKinds());
  return output;
}

Eigen::MatrixXd regressors(const Form& form, const Eigen::MatrixXd& quantities, double period) {
  const Eigen::VectorXd argument = argument_of(form, quantities);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(argument.size(), form.size());
  const Eigen::Index own = form.size() - (form.has_direct() ? 1 : 0);
  if (form.has_direct()) {
    columns.rightCols(1) = argument;
  }
  if (form.is_oscillator() || !form.values.empty()) {
    const Eigen::VectorXd entering = argument.unaryExpr([&](double value) { return form.entering(value); });
    columns.col(0) = remembered(form, entering, period);
    if (form.is_oscillator()) {
      Form quadrature = form;
      quadrature.memory.phase += 0.5 * std::numbers::pi;
      columns.col(1) = remembered(quadrature, entering, period);
    }
  } else if (form.curve_first) {
    for (Eigen::Index row = 0; row < argument.size(); ++row) {
      add_hats(form.points, argument(row), columns.row(row));
    }
    for (Eigen::Index k = 0; k < own; ++k) {
      columns.col(k) = remembered(form, columns.col(k), period);
    }
  } else if (form.is_stops()) {
    model::MemoryState<double> state;
    for (Eigen::Index row = 0; row < argument.size(); ++row) {
      const auto& stops = state.stop(form.points, static_cast<int>(form.points.size()), argument(row));
      for (Eigen::Index k = 0; k < own; ++k) {
        columns(row, k) = stops[static_cast<std::size_t>(k)];
      }
    }
  } else if (form.has_curve()) {
    const Eigen::VectorXd output = remembered(form, argument, period);
    for (Eigen::Index row = 0; row < argument.size(); ++row) {
      add_hats(form.points, output(row), columns.row(row));
    }
  } else {
    columns.col(0) = remembered(form, argument, period);
  }
  return columns;
}

bool is_replaced(const Form& form) {
  using enum model::Site;
  return !form.factor &&
         (is_own<command>(form) || is_own<valve_command>(form) || is_own<sensor, 0>(form) || is_own<sensor, 1>(form) ||
          is_of_opening(form) || (form.site == load_spring && form.argument == model::Argument::deflection));
}

std::optional<Form> in_place_of_signal(Form form) {
  if (!is_replaced(form) || !follows_at_rest(form.memory.kind)) {
    return std::nullopt;
  }
  if (is_of_opening(form)) {
    form.site = model::Site::valve;
    form.argument = model::Argument::spool;
  }
  form.points.clear();
  form.values.clear();
  form.curve_first = false;
  form.replaces = true;
  return form;
}

std::vector<Form> neighbours(const Form& form, double factor) {
  std::vector<Form> forms;
  const auto add = [&](auto&& change) {
    for (const double by : {factor, 1.0 / factor}) {
      Form moved = form;
      change(moved, by);
      forms.push_back(std::move(moved));
    }
  };
  switch (form.memory.kind) {
    case model::Memory::none:
    case model::Memory::oscillator:
      break;
    case model::Memory::delay:
    case model::Memory::lag:
    case model::Memory::washout:
      add([](Form& f, double by) { f.memory.time *= by; });
      break;
    case model::Memory::hold:
      add([](Form& f, double by) { f.memory.time *= by; });
      // As far in turns as the time in its logarithm.
      add([](Form& f, double by) { f.memory.phase = std::remainder(f.memory.phase + kTurn * std::log(by), kTurn); });
      break;
    case model::Memory::resonance:
    case model::Memory::band_pass:
      add([](Form& f, double by) { f.memory.frequency *= by; });
      add([](Form& f, double by) { f.memory.damping *= by * by; });
      break;
    case model::Memory::stops:
      add([](Form& f, double by) {
        std::ranges::transform(f.points, f.points.begin(), [&](double width) { return width * by; });
      });
      break;
    case model::Memory::periodic:
    case model::Memory::play:
    case model::Memory::stop:
    case model::Memory::slew:
    case model::Memory::quantise:
    case model::Memory::dead_zone:
    case model::Memory::saturation:
      add([](Form& f, double by) { f.memory.width *= by; });
      break;
    case model::Memory::odd_power:
    case model::Memory::even_power:
      add([](Form& f, double by) { f.memory.exponent = std::clamp(f.memory.exponent * by, kLeastExponent, kMostExponent); });
      break;
  }
  return forms;
}

}  // namespace hotfire::explain
