// SPDX-License-Identifier: Apache-2.0
// An effect of one's own in the model, without a change to Hotfire: a filter between the servovalve and its command.
//
// An effect is a type with a name, a site, parameters, a state and a step (docs/architecture.md). A plant takes its list of
// effects as a template parameter, so that a list with one more is another plant.

#include <hotfire/effects/gimbal/gimbal_friction.hpp>
#include <hotfire/keys.hpp>
#include <hotfire/simplex.hpp>

#include <cmath>
#include <cstdio>

namespace {

namespace model = hotfire::model;

/// The valve's command through a first-order filter: c' = (command - c) / time_constant, exact for a command that is held.
struct CommandFilter {
  static constexpr std::string_view name = "command_filter";
  static constexpr model::Site site = model::Site::valve_command;
  static constexpr model::NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S time_constant{0.0};  // neutral: no action
    static constexpr auto fields() {
      return std::array{
          model::Field<Params>{"time_constant", "s", 0.0, 1.0, 5e-3, "time constant of the filter", &Params::time_constant}};
    }
  };

  template <class S>
  struct State {
    S output{0.0};
  };

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const model::Signal<S>& input) noexcept {
    if (!(model::value_of(params.time_constant) > 0.0)) {
      return input.value;
    }
    using std::exp;
    const S kept = exp(-input.h / params.time_constant);
    state.output = kept * state.output + (1.0 - kept) * input.value;
    return state.output;
  }
};

using Axis = model::Simplex<double, model::EffectList<CommandFilter, model::GimbalFriction>>;

double angle_after(double seconds, double time_constant) {
  constexpr double kStep = 5e-4;
  Axis::Parameters parameters;
  std::get<0>(parameters.effects.values).time_constant = time_constant;
  parameters.effects.active[0] = true;
  const Axis axis(parameters, kStep);
  Axis::State state = axis.steady(0.0);
  for (int step = 0; step < static_cast<int>(std::lround(seconds / kStep)); ++step) {
    axis.step(state, 0.010);
  }
  return Axis::measured(state)[1];
}

}  // namespace

int main() {
  for (const double time_constant : {0.0, 0.01, 0.05}) {
    std::printf("filter %.2f s: engine at 0.03 s %.6f rad, at 2 s %.6f rad\n", time_constant,
                angle_after(0.03, time_constant), angle_after(2.0, time_constant));
  }
  // The filter delays the engine and does not change where it comes to rest.
  const bool late = angle_after(0.03, 0.05) < angle_after(0.03, 0.0);
  const bool arrives = std::abs(angle_after(2.0, 0.05) - angle_after(2.0, 0.0)) < 1e-5;
  return late && arrives ? 0 : 1;
}
