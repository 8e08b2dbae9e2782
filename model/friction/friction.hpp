// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/sites.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// Friction level that steady sliding reaches (Stribeck):
///   g(v) = level (1 + (ratio - 1) e^{-(v / stribeck_velocity)^2}),  ratio >= 1.
/// [Canudas de Wit et al. 1995] A New Model for Control of Systems with Friction, IEEE TAC 40(3), eq. 5.
template <class S>
S stribeck_level(const S& velocity, const S& level, const S& ratio, const S& stribeck_velocity) noexcept {
  const S relative = velocity / stribeck_velocity;
  const S squared = relative * relative;
  return level * (1.0 + (ratio - 1.0) * fading_exponential<S>(squared));
}

/// Rigid Coulomb friction of the given level: the force that brings the body to rest within the step, limited to the level.
/// Solves velocity = free_velocity - compliance * force exactly, so it never reverses a motion.
template <class S>
S coulomb_force(const Motion<S>& motion, const S& level) noexcept {
  return clamp_symmetric<S>(motion.free_velocity / motion.compliance, level);
}

/// Elastic-perfectly-plastic friction: a spring `stiffness` that slips at `level` (one Jenkin element, as in Iwan 1966).
/// `deflection` is the spring's, advanced over the step. Returns the mean force, solved together with the body's velocity.
template <class S>
S elastoplastic_force(S& deflection, const Motion<S>& motion, const S& level, const S& stiffness) noexcept {
  const S half_step_stiffness = stiffness * (0.5 * motion.h);
  const S stuck_velocity =
      (motion.free_velocity - motion.compliance * stiffness * deflection) / (1.0 + motion.compliance * half_step_stiffness);
  S force = clamp_symmetric<S>(stiffness * deflection + half_step_stiffness * stuck_velocity, level);
  const S velocity = motion.free_velocity - motion.compliance * force;
  deflection = clamp_symmetric<S>(deflection + motion.h * velocity, level / stiffness);
  return force;
}

/// Constants of a bristle. Dahl: damping and viscous are zero and the level does not depend on the velocity.
template <class S>
struct Bristle {
  S stiffness;  ///< sigma0, force per deflection
  S damping;    ///< sigma1, force per deflection rate
  S viscous;    ///< sigma2, force per velocity
};

/// Friction level under vibration: level (1 + (ratio - 1) e^{-|v| / vibration_velocity}), ratio <= 1. [GF] slide Vibration.
template <class S>
S vibrated_level(const S& speed, const S& level, const S& ratio, const S& vibration_velocity) noexcept {
  return level * (1.0 + (ratio - 1.0) * fading_exponential<S>(speed / vibration_velocity));
}

/// The Stribeck level of a friction that vibration lowers at low speed.
template <class S>
S vibrated_stribeck_level(const S& speed, const S& level, const S& static_ratio, const S& stribeck_velocity,
                          const S& vibration_ratio, const S& vibration_velocity) noexcept {
  const S vibrated = vibrated_level<S>(speed, level, vibration_ratio, vibration_velocity);
  // Friction that vibration takes away altogether leaves a level of zero at rest, and a bristle that follows at once.
  const S least = level * S(1e-9);
  return stribeck_level<S>(speed, select(value_of(vibrated) > value_of(least), vibrated, least), static_ratio,
                           stribeck_velocity);
}

/// The limit of a sequence whose errors shrink by a constant factor (Aitken), held to what three members can say. Of a
/// speed: never below zero.
template <class S>
S extrapolated_speed(const S& guess, const S& first, const S& second) noexcept {
  const S before = first - guess;
  const S ratio = select(value_of(before) != 0.0, S((second - first) / before), S{0.0});
  const S factor = select(value_of(ratio) > 0.9, S{0.9}, select(value_of(ratio) < -10.0, S{-10.0}, ratio));
  const S limit = (second - factor * first) / (1.0 - factor);
  return select(value_of(limit) > 0.0, limit, S{0.0});
}

/// Bristle damping that dies with speed, damping e^{-(v/v_d)^2} with v_d = 2 sqrt(2e) level / damping: half of the bound
/// that is sufficient for passivity, whatever the Stribeck ratio [Astrom and Canudas de Wit 2008, Revisiting the LuGre
/// Friction Model, IEEE Control Systems 28(6), p. 107].
template <class S>
S passive_damping(const S& damping, const S& level, const S& velocity) noexcept {
  constexpr double kHalfOfSufficientBound = 4.663288;  // 2 sqrt(2 e)
  const S relative = velocity * damping / (level * kHalfOfSufficientBound);
  return damping * fading_exponential<S>(relative * relative);
}

/// One step of a bristle, with its speed and level held: z+ = decay z + psi h v, F = at_rest z + per_velocity v, in any
/// number of dimensions. v is the mean velocity, F the mean force.
template <class S>
struct BristleStep {
  S decay;
  S psi;
  S at_rest;
  S per_velocity;
};

/// The exact hold of z' = v - sigma0 |v| z / g over h: with a = sigma0 speed h / level,
/// decay = e^-a, psi = (1 - e^-a)/a and chi = (1 - psi)/a the end and the mean of z are z decay + v h psi and z psi + v h
/// chi.
template <class S>
BristleStep<S> bristle_step(const S& speed, const S& level, const Bristle<S>& bristle, double h) noexcept {
  constexpr double kSmall = 0.02;
  const S relaxation = bristle.stiffness * speed / level;
  const S exponent = relaxation * h;
  // Below `kSmall` the quotients lose digits and the series is exact to 2e-15. Both are computed at every step and blended
  // by a weight of 0 or 1, which changes no bit, so that sticking and slipping cost the same: a choice would become a
  // branch.
  const auto small = one_where(value_of(exponent) < kSmall);
  const auto large = 1.0 - small;
  const S within = small * exponent;
  const S series =
      0.5 - within * (1.0 / 6 - within * (1.0 / 24 - within * (1.0 / 120 - within * (1.0 / 720 - within * (1.0 / 5040)))));
  const S exact = fading_exponential<S>(exponent);
  const S divisor = large * exponent + small;
  const S quotient = (1.0 - exact) / divisor;
  const S chi = small * series + large * ((1.0 - quotient) / divisor);
  const S psi = small * (1.0 - within * series) + large * quotient;
  const S decay = small * (1.0 - within * psi) + large * exact;
  return {decay, psi, S((bristle.stiffness - bristle.damping * relaxation) * psi),
          S(bristle.stiffness * h * chi + bristle.damping * psi + bristle.viscous)};
}

/// One step of the bristle equation (Dahl, LuGre):
///   z' = v - sigma0 |v| z / g,   F = sigma0 z + sigma1 z' + sigma2 v.
///
/// Discretisation: z is advanced by the exact hold of |v| and g over the step, e^{-a} with a = sigma0 |v| h / g, so it is
/// stable at any step in slip; with |v| and g held the force is linear in the mean velocity, and velocity = free_velocity -
/// compliance * force is solved in closed form, so it is stable in stick as well. The mean bristle rate (z+ - z)/h is used
/// for z', which keeps sigma1 z' bounded where the bristle relaxes within one step. Second order for smooth motion.
/// [Canudas de Wit et al. 1995], eq. 1-3; exact hold as in [SD]'s companion literature and MuJoCo's dcmotor note, sec.
/// LuGre.
///
/// `speed` is |v|, of which v may be one component: those of a bristle vector meet through |v| alone. `level` is g at that
/// speed. Returns the mean force over the step.
template <class S>
S bristle_force(S& deflection, const Motion<S>& motion, const S& speed, const S& level, const Bristle<S>& bristle) noexcept {
  const BristleStep<S> step = bristle_step<S>(speed, level, bristle, motion.h);
  const S start = deflection;
  const S at_rest = start * step.at_rest;
  const S velocity = (motion.free_velocity - motion.compliance * at_rest) / (1.0 + motion.compliance * step.per_velocity);
  deflection = start * step.decay + velocity * motion.h * step.psi;
  return at_rest + step.per_velocity * velocity;
}

/// The same along one direction: `motion.velocity` sets |v|.
template <class S>
S bristle_force(S& deflection, const Motion<S>& motion, const S& level, const Bristle<S>& bristle) noexcept {
  return bristle_force<S>(deflection, motion, S(motion.velocity * sign_of(motion.velocity)), level, bristle);
}

}  // namespace hotfire::model
