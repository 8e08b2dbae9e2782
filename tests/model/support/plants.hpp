// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "model/direct.hpp"
#include "model/electromechanical.hpp"
#include "model/simplex.hpp"
#include "tests/model/support/every_effect.hpp"

namespace hotfire::test {

/// Where effect E stands in a list.
template <class E, class... Es>
constexpr std::size_t index_in(const model::EffectList<Es...>&) {
  constexpr std::array<bool, sizeof...(Es)> same{std::is_same_v<E, Es>...};
  return static_cast<std::size_t>(std::find(same.begin(), same.end(), true) - same.begin());
}

/// Makes effect E active in a plant's parameters.
template <class E, class Plant>
void activate(typename Plant::Parameters& parameters, const ParamsOf<E, typename Plant::Scalar>& values) {
  constexpr std::size_t index = index_in<E>(typename Plant::Effects{});
  std::get<index>(parameters.effects.values) = values;
  parameters.effects.active[index] = true;
}

/// The reference hydraulic axis, and a lightly damped mass on a spring: what effects are planted in.
template <class S, class List>
typename model::Simplex<S, List>::Parameters reference_parameters(const model::Simplex<S, List>*) {
  return {};
}
template <class S, class List>
typename model::Direct<S, List>::Parameters reference_parameters(const model::Direct<S, List>*) {
  typename model::Direct<S, List>::Parameters parameters;
  parameters.mass = {S(1.0), S(0.5), S(40.0)};
  return parameters;
}
/// A motor in a position loop with a mass of one on a soft transmission.
template <class S, class List>
typename model::Electromechanical<S, List>::Parameters reference_parameters(const model::Electromechanical<S, List>*) {
  typename model::Electromechanical<S, List>::Parameters parameters;
  parameters.controller = {S(40.0), S(5.0), S(8.0), S(1.0), S(0.0), S(0.5), S(0.0)};
  parameters.motor = {S(1.0), S(0.5), S(0.2), S(500.0), S(0.0), S(0.0)};
  parameters.transmission = {S(1.0), S(400.0), S(1.0)};
  parameters.mass = {S(1.0), S(0.5), S(0.0)};
  return parameters;
}
template <class Plant>
typename Plant::Parameters reference_parameters() {
  return reference_parameters(static_cast<const Plant*>(nullptr));
}

/// What effect E is planted in: the reference parameters, with the effect that E carries at its typical values.
template <class Plant, class E>
typename Plant::Parameters parameters_around() {
  auto parameters = reference_parameters<Plant>();
  if constexpr (carries_another<E>()) {
    Plant::Effects::for_each([&]<class Carried, std::size_t>() {
      if constexpr (Carried::name == E::carries) {
        activate<Carried, Plant>(parameters, typical<Carried, typename Plant::Scalar>(1));
      }
    });
  }
  return parameters;
}

/// At rest: the steady state under a zero command, a mass at zero.
template <class S, class List>
typename model::Simplex<S, List>::State rest(const model::Simplex<S, List>& plant) {
  return plant.steady(S(0.0));
}
template <class S, class List>
typename model::Direct<S, List>::State rest(const model::Direct<S, List>& plant) {
  return plant.at_rest(S(0.0));
}

template <class S, class List>
typename model::Electromechanical<S, List>::State rest(const model::Electromechanical<S, List>& plant) {
  return plant.steady(S(0.0));
}

/// An input that wakes every effect at its typical values: angles of a few hundredths [rad], forces that move the mass by
/// about one.
template <class S, class List>
double lively_input(const model::Simplex<S, List>&, double t) {
  return 0.02 * std::sin(9.0 * t) + 0.012 * std::sin(23.0 * t);
}
template <class S, class List>
double lively_input(const model::Direct<S, List>&, double t) {
  return 40.0 * std::sin(4.0 * t) + 30.0 * std::sin(9.0 * t);
}
template <class S, class List>
double lively_input(const model::Electromechanical<S, List>&, double t) {
  return 0.6 * std::sin(4.0 * t) + 0.4 * std::sin(9.0 * t);
}

/// One step under an input. A hydraulic axis has another one beside it, on the same engine and in motion.
template <class S, class List>
void step_beside(const model::Simplex<S, List>& plant, typename model::Simplex<S, List>::State& state, const S& input) {
  const double t = model::value_of(state.clock.at(plant.step_size(), 0.5));
  const S arm = plant.parameters().actuator.moment_arm;
  plant.step(state, input, [&](const S&) {
    return model::Coupling<S>{S(0.0), arm, S(0.0), S(0.02 * std::sin(7.0 * t)), S(0.14 * std::cos(7.0 * t))};
  });
}
template <class S, class List>
void step_beside(const model::Direct<S, List>& plant, typename model::Direct<S, List>::State& state, const S& input) {
  plant.step(state, input);
}
template <class S, class List>
void step_beside(const model::Electromechanical<S, List>& plant, typename model::Electromechanical<S, List>::State& state,
                 const S& input) {
  plant.step(state, input);
}

/// What the sensors read under the lively input, held over samples of `sample` seconds that are split into `parts` steps:
/// one row a sample.
template <class Plant>
std::vector<std::array<typename Plant::Scalar, Plant::channels.size()>> record(const typename Plant::Parameters& parameters,
                                                                               double duration, double sample, int parts) {
  const Plant plant(parameters, sample / parts);
  auto state = rest(plant);
  std::vector<std::array<typename Plant::Scalar, Plant::channels.size()>> rows;
  const int samples = static_cast<int>(std::lround(duration / sample));
  for (int i = 0; i < samples; ++i) {
    const typename Plant::Scalar input(lively_input(plant, i * sample));
    for (int part = 0; part < parts; ++part) {
      step_beside(plant, state, input);
    }
    rows.push_back(Plant::measured(state));
  }
  return rows;
}

/// Root of the mean square of `a - b` in one channel, over the root of the mean square of `b`.
template <class Rows>
double relative_rms(const Rows& a, const Rows& b, std::size_t channel) {
  double difference = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    const double gap = model::value_of(a[i][channel]) - model::value_of(b[i][channel]);
    const double value = model::value_of(b[i][channel]);
    difference += gap * gap;
    size += value * value;
  }
  return std::sqrt(difference / size);
}

/// Calls `f.template operator()<Plant, E>(option)` for every law of every effect with the plant that knows it.
template <class F>
void for_each_planted_law(F&& f) {
  for_each_law([&]<class E>(int option) {
    if constexpr (index_in<E>(model::SimplexEffects{}) < model::SimplexEffects::size) {
      f.template operator()<model::Simplex<double>, E>(option);
    } else if constexpr (index_in<E>(model::DirectEffects{}) < model::DirectEffects::size) {
      f.template operator()<model::Direct<double>, E>(option);
    } else {
      f.template operator()<model::Electromechanical<double>, E>(option);
    }
  });
}

}  // namespace hotfire::test
