// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// The place in the equations where an effect acts. After `sensor` comes the channel's name in configuration and report.
enum class Site {
  command,
  valve_command,
  valve,
  flow,
  pressure,
  piston,
  load_spring,
  structure,
  engine_torque,
  mass_force,
  drive,
  motor,
  transmission,
  sensor
};

constexpr std::string_view site_name(Site site) noexcept {
  constexpr std::array<std::string_view, 14> names{"command", "valve_command", "valve",        "flow",          "pressure",
                                                   "piston",  "load_spring",   "structure",    "engine_torque", "mass_force",
                                                   "drive",   "motor",         "transmission", "sensor"};
  return names[static_cast<std::size_t>(site)];
}

/// Sites at which effects are applied one after the other, in the order of the effect list. At all other sites they add up.
constexpr bool is_serial(Site site) noexcept {
  return site == Site::command || site == Site::valve_command || site == Site::valve || site == Site::load_spring ||
         site == Site::drive || site == Site::transmission || site == Site::sensor;
}

template <class S>
struct Surroundings;

/// Input of an effect at the sites `command`, `valve_command`, `valve`, `drive` and `sensor`, over one step of `h` [s]. The
/// effect returns the new value.
template <class S>
struct Signal {
  using Scalar = S;
  S value;  ///< mean over the step
  double h = 0.0;
  Precise<S> time{0.0};                   ///< of the record, mean over the step [s]
  S change{0.0};                          ///< end of the step less its start; known at `valve_command` only
  const Surroundings<S>* seen = nullptr;  ///< the axis around it
};

/// Input of an effect at the site `flow`. The effect returns flow added into the extend chamber [m^3/s].
template <class S>
struct Hydraulics {
  using Scalar = S;
  S load_pressure;  ///< mean over the step [Pa]
  S opening;        ///< mean spool position after the valve's effects [-]
  S supply_pressure;
  double h = 0.0;
  Precise<S> time{0.0};  ///< of the record, mean over the step [s]
  S flow{0.0};           ///< through the valve's orifices into the extend chamber, mean over the step [m^3/s]
  const Surroundings<S>* seen = nullptr;  ///< the axis around it
};

/// Input of an effect at the site `pressure`. The effect returns flow added to the flow that builds up pressure [m^3/s].
///
/// The piston yields to the pressure within the step. `free_flow` is the net flow without this effect. `relief`, in [0, 1),
/// is the share of a unit of added flow that the piston takes away. The law can therefore solve net = free_flow - relief *
/// added in closed form. An explicit step would be unstable at the oil's resonance.
template <class S>
struct Compression {
  using Scalar = S;
  S free_flow;      ///< into the extend chamber less what the piston takes, mean over the step [m^3/s]
  S relief;         ///< [-]
  S load_pressure;  ///< mean over the step [Pa]
  double h;
};

/// Input of an effect at the sites `piston`, `engine_torque`, `mass_force` and `motor`. The effect returns the force or
/// torque that opposes the motion, mean over the step.
///
/// `velocity` is the mean velocity over the step from the last pass. `free_velocity` is its value without this effect.
/// `compliance` is the reduction of the velocity by a unit of mean force. A stiff law can therefore solve velocity =
/// free_velocity - compliance * force in closed form instead of an explicit step.
template <class S>
struct Motion {
  using Scalar = S;
  S position;  ///< mean over the step
  S velocity;
  S free_velocity;
  S compliance;
  double h = 0.0;
  Precise<S> time{0.0};  ///< of the record, mean over the step [s]
  S other_angle{0.0};    ///< of the engine about its other axis, mean over the step [rad]; known at `engine_torque` only
  S other_rate{0.0};     ///< its rate [rad/s]; both zero for an axis alone
  S load{0.0};           ///< A p_L at `piston`, the load spring's force at `engine_torque`, mean over the step [N]
  S declared_stiffness{0.0};  ///< of the declared spring to ground; this and the damping known at `mass_force` only
  S declared_damping{0.0};
  const Surroundings<S>* seen = nullptr;  ///< the axis around it
};

/// Input of an effect at the sites `load_spring` and `transmission`. The effect returns it with its change. The spring's
/// force is `stiffness * deflection`, so a nonlinear spring returns the deflection that gives its force.
template <class S>
struct Spring {
  using Scalar = S;
  S deflection;          ///< x_a - stroke(beta) - w, mean over the step [m]
  S angle;               ///< engine angle beta, mean over the step [rad]
  S nominal_arm;         ///< moment arm of the declared model [m]
  S arm;                 ///< moment arm that turns force into torque, as the effects leave it [m]
  S stiffness;           ///< K_T of the declared model [N/m]
  S actuator_stiffness;  ///< K_act [N/m]
  S load_stiffness;      ///< K_L [N/m]
  double h = 0.0;
  Precise<S> time{0.0};                   ///< of the record, mean over the step [s]
  const Surroundings<S>* seen = nullptr;  ///< the axis around it
};

/// Input of an effect at the site `structure`. The effect returns the further motion of the attach point, mean over the step
/// [m].
template <class S>
struct AttachPoint {
  using Scalar = S;
  S force;  ///< F of the load spring, mean over the step [N]
  double h;
};

/// The input type of a site.
template <Site site, class S>
struct SiteInput {
  using type = Signal<S>;
};
template <class S>
struct SiteInput<Site::flow, S> {
  using type = Hydraulics<S>;
};
template <class S>
struct SiteInput<Site::pressure, S> {
  using type = Compression<S>;
};
template <class S>
struct SiteInput<Site::piston, S> {
  using type = Motion<S>;
};
template <class S>
struct SiteInput<Site::engine_torque, S> {
  using type = Motion<S>;
};
template <class S>
struct SiteInput<Site::mass_force, S> {
  using type = Motion<S>;
};
template <class S>
struct SiteInput<Site::motor, S> {
  using type = Motion<S>;
};
template <class S>
struct SiteInput<Site::load_spring, S> {
  using type = Spring<S>;
};
template <class S>
struct SiteInput<Site::transmission, S> {
  using type = Spring<S>;
};
template <class S>
struct SiteInput<Site::structure, S> {
  using type = AttachPoint<S>;
};

}  // namespace hotfire::model
