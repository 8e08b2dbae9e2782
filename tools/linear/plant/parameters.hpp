// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "tools/files/text/error.hpp"
#include "tools/linear/plant/scalars.hpp"

namespace hotfire::linear {

// What a linear map changes of a plant's parameters, and refuses in them. `Topology` is the plant in a scalar.

/// True if an effect of the site is active.
template <model::Site site, class List, class S>
bool acts(const model::EffectParameters<S, List>& effects) {
  bool any = false;
  List::for_each([&]<class E, std::size_t I>() {
    if constexpr (E::site == site && !is_port<E>) {
      any = any || effects.active[I];
    }
  });
  return any;
}

/// Puts the constant torques `loads` [N m] on the engines, and takes out the transport delays, and noise and steps of
/// readings.
template <class Topology>
void set_operating_point(typename Topology::Parameters& parameters, const std::vector<double>& loads) {
  if constexpr (Topology::is_vehicle) {
    Topology::Adapter::smooth(parameters);
  }
  for (std::size_t i = 0; i < loads.size(); ++i) {
    auto& effects = Topology::axis(parameters, i).effects;
    Topology::Axis::Effects::for_each([&]<class E, std::size_t I>() {
      if constexpr (std::is_same_v<E, model::TorqueOffset>) {
        auto& offset = std::get<I>(effects.values);
        if (!effects.active[I]) {
          offset = {};
        }
        effects.active[I] = effects.active[I] || loads[i] != 0.0;
        offset.torque -= loads[i];
      }
      if constexpr (std::is_same_v<E, model::CommandDelay> || std::is_same_v<E, model::SensorDelay>) {
        effects.active[I] = false;
      }
    });
  }
}

/// Leaves only what `With::linear_parts` has, with `bearings` in the place of friction.
template <class Topology>
void leave_linear_parts(typename Topology::Parameters& parameters, const std::vector<BearingSpring>& bearings) {
  using S = typename Topology::Scalar;
  for (std::size_t i = 0; i < static_cast<std::size_t>(Topology::kAxes); ++i) {
    auto& effects = Topology::axis(parameters, i).effects;
    Topology::Axis::Effects::for_each([&]<class E, std::size_t I>() {
      if constexpr (!is_port<E> && E::site != model::Site::structure && E::site != model::Site::sensor) {
        effects.active[I] = false;
      }
    });
  }
  constexpr double kNeverSlides = 1e15;  // N m
  if constexpr (Topology::is_vehicle) {
    for (std::size_t e = 0; e < bearings.size(); ++e) {
      auto& gimbal = parameters.vehicle.gimbals[e];
      if (gimbal.friction.rubs()) {
        gimbal.friction = {};
        gimbal.friction.choose(model::BearingFriction<S>::Law::dahl);
        gimbal.friction.coulomb_torque = S(kNeverSlides);
        gimbal.friction.coefficient = S(0.0);
        gimbal.friction.viscous = S(bearings[e].viscous);
        gimbal.friction.exponent = S(1.0);
        gimbal.friction.stiffness = S(bearings[e].stiffness);
      }
    }
  }
}

/// The transport delays of the parameters. Throws UsageError for what has no small deviations.
template <class Topology>
std::vector<Delay> delays_of(const typename Topology::Parameters& parameters) {
  std::vector<Delay> delays;
  for (std::size_t i = 0; i < static_cast<std::size_t>(Topology::kAxes); ++i) {
    const auto& effects = Topology::axis(parameters, i).effects;
    Topology::Axis::Effects::for_each([&]<class E, std::size_t I>() {
      const auto& values = std::get<I>(effects.values);
      if (!effects.active[I]) {
        return;
      }
      if constexpr (std::is_same_v<E, model::CommandDelay>) {
        delays.push_back({"command" + Topology::suffix(i), values.delay});
      } else if constexpr (std::is_same_v<E, model::SensorDelay>) {
        delays.push_back(
            {std::string(E::options[static_cast<std::size_t>(values.option)]) + Topology::suffix(i), values.delay});
      } else if constexpr (hides<typename E::template State<double>>()) {
        if (values.option != 0) {
          throw UsageError(
              fmt::format("effects.{}: a term with the memory \"{}\" has no small deviations that this command follows; "
                          "allowed: listed effects, and terms with the memory \"none\"",
                          E::name, E::options[static_cast<std::size_t>(values.option)]));
        }
      }
    });
  }
  if constexpr (Topology::is_vehicle) {
    for (const auto& gimbal : parameters.vehicle.gimbals) {
      if (gimbal.vibration.pitch_velocity > 0.0 || gimbal.vibration.yaw_velocity > 0.0) {
        throw UsageError(
            "gimbal.vibration: a simulated vibration never rests; give its averaged law instead, gimbal.friction.law = "
            "\"vibrated_lugre\"");
      }
    }
  }
  return delays;
}

}  // namespace hotfire::linear
