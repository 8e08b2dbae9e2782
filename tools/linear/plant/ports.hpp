// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <type_traits>

#include "model/direct.hpp"
#include "model/sensors/vehicle_sensors.hpp"
#include "model/simplex.hpp"
#include "model/vehicle.hpp"
#include "model/vehicle_keys.hpp"
#include "tools/interface/plant/parameter_table.hpp"

namespace hotfire::linear {

/// A place where a signal from outside enters the equations of an axis, as an effect of that site: it adds what its state
/// says. With it a plant has an input wherever an effect can act, and stays the plant that the rig runs.
template <model::Site at>
struct Port {
  static constexpr std::string_view name = "port";
  static constexpr model::Site site = at;
  static constexpr model::NoOptions options{};
  static constexpr bool is_port = true;

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    static constexpr auto fields() { return std::array<model::Field<Params>, 0>{}; }
  };

  template <class S>
  struct State {
    S added{0.0};
  };

  template <class S, class Input>
  static auto step(const Params<S>&, State<S>& state, const Input& input) noexcept {
    if constexpr (std::is_same_v<Input, model::Signal<S>>) {
      return S(input.value + state.added);
    } else if constexpr (std::is_same_v<Input, model::Spring<S>>) {
      model::Spring<S> output = input;
      output.deflection += state.added;
      return output;
    } else {
      return state.added;
    }
  }
};

template <class E>
inline constexpr bool is_port = requires {
  E::is_port;
};

/// Where a signal enters an axis, in this order: the valve command [1], the flow into the extend chamber [m^3/s], a force
/// against the piston [N], a deflection of the load spring [m], a torque against the engine [N m]; and the friction torque
/// of a vehicle's bearing [N m], which also turns the vehicle's side and twists the bearing.
enum PortIndex { kValvePort, kFlowPort, kPistonPort, kSpringPort, kTorquePort, kFrictionPort };
inline constexpr int kSitePorts = 5;  ///< those that are effects
inline constexpr int kAxisPorts = 6;

template <class List>
struct PortedList;
/// The ports come last: a signal at the load spring is added to what the spring's own effects leave.
template <class... Es>
struct PortedList<model::EffectList<Es...>> {
  using type = model::EffectList<Es..., Port<model::Site::valve_command>, Port<model::Site::flow>, Port<model::Site::piston>,
                                 Port<model::Site::load_spring>, Port<model::Site::engine_torque>>;
};
template <class List>
using WithPorts = typename PortedList<List>::type;

template <class S>
using PortedSimplex = model::Simplex<S, WithPorts<model::SimplexEffects>>;
template <class S>
using PortedTaos = model::Vehicle<S, 1, model::Taos<S>::Modes::kCapacity, WithPorts<model::SimplexEffects>>;
template <class S>
using PortedMasv = model::Vehicle<S, 4, model::Masv<S>::Modes::kCapacity, WithPorts<model::MasvEffects>>;

/// Fills the parameters of a plant with ports from the table of the plant without.
template <class S>
class PortedSlots : public plant::ParameterSlots<S> {
 public:
  using plant::ParameterSlots<S>::ParameterSlots;

  template <class E>
  bool effect(const model::KeyText& prefix, bool& active) {
    if constexpr (is_port<E>) {
      active = true;
      return false;
    } else {
      return plant::ParameterSlots<S>::template effect<E>(prefix, active);
    }
  }
};

}  // namespace hotfire::linear
