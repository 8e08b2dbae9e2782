// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/field.hpp"

namespace hotfire::model {

/// The declared parameters of the parts of one axis, physics.md section 1. Defaults are its reference values:
/// representative, tuned to the published frequencies; NASA's own are not public.

template <class S>
struct Servovalve {
  using Scalar = S;
  static constexpr std::string_view name = "servovalve";
  S rated_flow{3.155e-3};
  S natural_frequency{377.0};
  S damping_ratio{0.8};
  S position_gain{86.2};
  S position_feedback{1.0};
  S pressure_feedback_gain{1e-7};
  S pressure_feedback_corner{6.283};
  static constexpr auto fields() {
    using P = Servovalve;
    return std::array{
        Field<P>{"rated_flow", "m^3/s", 1e-6, 1.0, 3.155e-3, "no-load flow at full spool travel", &P::rated_flow},
        Field<P>{"natural_frequency", "rad/s", 1.0, 1e5, 377.0, "natural frequency of the spool", &P::natural_frequency},
        Field<P>{"damping_ratio", "1", 0.01, 10.0, 0.8, "damping ratio of the spool", &P::damping_ratio},
        Field<P>{"position_gain", "1/m", 1e-3, 1e6, 86.2, "valve command per piston error", &P::position_gain},
        Field<P>{"position_feedback", "1", 0.0, 10.0, 0.0,
                 "piston position that is fed back, per piston position; 0: no position feedback", &P::position_feedback},
        Field<P>{"pressure_feedback_gain", "1/Pa", 0.0, 1e-3, 1e-7, "valve command per changing load pressure",
                 &P::pressure_feedback_gain},
        Field<P>{"pressure_feedback_corner", "rad/s", 1e-3, 1e5, 6.283, "corner of the pressure washout",
                 &P::pressure_feedback_corner}};
  }
};

template <class S>
struct Actuator {
  using Scalar = S;
  static constexpr std::string_view name = "actuator";
  S piston_area{0.0160};
  S supply_pressure{20.684e6};
  S bulk_modulus{1.034e9};
  S trapped_volume{4.72e-3};
  S leakage{2e-12};
  S piston_mass{50.0};
  S piston_damping{2e4};
  S stiffness{1.2e8};
  S moment_arm{0.7544};
  static constexpr auto fields() {
    using P = Actuator;
    return std::array{
        Field<P>{"piston_area", "m^2", 1e-6, 10.0, 0.016, "piston area A", &P::piston_area},
        Field<P>{"supply_pressure", "Pa", 1e4, 1e9, 20.684e6, "supply pressure P_s", &P::supply_pressure},
        Field<P>{"bulk_modulus", "Pa", 1e6, 1e11, 1.034e9, "effective bulk modulus B of the oil", &P::bulk_modulus},
        Field<P>{"trapped_volume", "m^3", 1e-8, 10.0, 4.72e-3, "oil volume V_t of both chambers", &P::trapped_volume},
        Field<P>{"leakage", "m^3/s/Pa", 0.0, 1e-6, 2e-12, "leakage C_l across the piston", &P::leakage},
        Field<P>{"piston_mass", "kg", 1e-3, 1e6, 50.0, "piston mass M_p", &P::piston_mass},
        Field<P>{"piston_damping", "N.s/m", 0.0, 1e9, 2e4, "viscous damping B_p of the piston", &P::piston_damping},
        Field<P>{"stiffness", "N/m", 1e3, 1e13, 1.2e8, "actuator stiffness K_act, loaded", &P::stiffness},
        Field<P>{"moment_arm", "m", 1e-3, 100.0, 0.7544, "moment arm R", &P::moment_arm}};
  }
};

template <class S>
struct Structure {
  using Scalar = S;
  static constexpr std::string_view name = "structure";
  S stiffness{5.75e7};
  static constexpr auto fields() {
    using P = Structure;
    return std::array{
        Field<P>{"stiffness", "N/m", 1e3, 1e13, 5.75e7, "load stiffness K_L at the attach point", &P::stiffness}};
  }
};

template <class S>
struct Engine {
  using Scalar = S;
  static constexpr std::string_view name = "engine";
  S inertia{9490.0};
  S viscous_damping{1.2e4};
  S duct_stiffness{4e5};
  static constexpr auto fields() {
    using P = Engine;
    return std::array{Field<P>{"inertia", "kg.m^2", 1e-6, 1e9, 9490.0, "inertia J about the gimbal", &P::inertia},
                      Field<P>{"viscous_damping", "N.m.s/rad", 0.0, 1e9, 1.2e4, "viscous damping D", &P::viscous_damping},
                      Field<P>{"duct_stiffness", "N.m/rad", 0.0, 1e10, 4e5, "duct stiffness K_n", &P::duct_stiffness}};
  }
};

/// The moving mass of a `direct` model. Units are whatever consistent set the record has.
template <class S>
struct Mass {
  using Scalar = S;
  static constexpr std::string_view name = "mass";
  S inertia{1.0};
  S damping{0.0};
  S stiffness{0.0};
  static constexpr auto fields() {
    using P = Mass;
    return std::array{Field<P>{"inertia", "force.time^2/position", 1e-12, 1e12, 1.0, "inertia", &P::inertia},
                      Field<P>{"damping", "force.time/position", 0.0, 1e12, 1.0, "viscous damping", &P::damping},
                      Field<P>{"stiffness", "force/position", 0.0, 1e15, 1.0, "stiffness to ground", &P::stiffness}};
  }
};

/// The body of an `imposed_motion` model. Units are whatever consistent set the record has.
template <class S>
struct MovedBody {
  using Scalar = S;
  static constexpr std::string_view name = "body";
  S inertia{0.0};
  S damping{0.0};
  S stiffness{0.0};
  static constexpr auto fields() {
    using P = MovedBody;
    return std::array{
        Field<P>{"inertia", "force.time^2/position", 0.0, 1e12, 1.0, "inertia that moves with the path", &P::inertia},
        Field<P>{"damping", "force.time/position", 0.0, 1e12, 1.0, "viscous damping", &P::damping},
        Field<P>{"stiffness", "force/position", 0.0, 1e15, 1.0, "stiffness to ground", &P::stiffness}};
  }
};

}  // namespace hotfire::model
