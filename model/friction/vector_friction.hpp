// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "model/friction/friction.hpp"

namespace hotfire::model {

/// Two numbers about pitch and yaw, and a symmetric matrix over them.
template <class S>
struct Pair {
  S pitch{0.0};
  S yaw{0.0};

  friend Pair operator+(const Pair& a, const Pair& b) noexcept { return {a.pitch + b.pitch, a.yaw + b.yaw}; }
  friend Pair operator-(const Pair& a, const Pair& b) noexcept { return {a.pitch - b.pitch, a.yaw - b.yaw}; }
  friend Pair operator*(const S& s, const Pair& a) noexcept { return {s * a.pitch, s * a.yaw}; }
  /// At zero it has no slope: that of the root would be infinite.
  S length() const noexcept {
    const S squared = pitch * pitch + yaw * yaw;
    return select(value_of(squared) != 0.0, S(sqrt(squared)), S{0.0});
  }
};

/// In lanes: as `select` of a number.
template <class Mask, class S>
requires are_lanes<S> Pair<S> select(const Mask& condition, const Pair<S>& where_true, const Pair<S>& where_false)
noexcept {
  return {select(condition, where_true.pitch, where_false.pitch), select(condition, where_true.yaw, where_false.yaw)};
}

template <class S>
struct SymmetricPair {
  S pitch{0.0};
  S yaw{0.0};
  S cross{0.0};

  Pair<S> times(const Pair<S>& x) const noexcept { return {pitch * x.pitch + cross * x.yaw, cross * x.pitch + yaw * x.yaw}; }
  /// Solves (scale * this + shift * identity) x = b for a positive definite sum.
  Pair<S> solve(const S& scale, const S& shift, const Pair<S>& b) const noexcept {
    const S p = scale * pitch + shift;
    const S y = scale * yaw + shift;
    const S c = scale * cross;
    const S determinant = p * y - c * c;
    return {(y * b.pitch - c * b.yaw) / determinant, (p * b.yaw - c * b.pitch) / determinant};
  }
};

/// Input of the friction of a ball joint over one step: `Motion` in two directions. Its torque obeys velocity =
/// free_velocity - compliance torque; `velocity` is the result of the last pass.
template <class S>
struct Slip {
  Pair<S> velocity;
  Pair<S> free_velocity;
  SymmetricPair<S> compliance;
  double h = 0.0;
};

/// Rigid Coulomb friction of a ball joint: the torque that brings it to rest within the step, or of size `level` along the
/// slip. Slip is velocity = lambda torque with |torque| = level, so torque = (compliance + lambda)^-1 free_velocity: the
/// secular equation of a trust region, solved for lambda by four steps of Newton on 1/|torque| [More and Sorensen 1983, SIAM
/// J. Sci. Stat. Comput. 4(3)], exact after the first for equal compliances. Reduces to `coulomb_force` along one direction.
template <class S>
Pair<S> coulomb_torque(const Slip<S>& slip, const S& level) noexcept {
  const auto rubs = value_of(level) > 0.0;
  if (!anywhere(rubs)) {
    return {};
  }
  const auto where_compliant = [&](const S& compliant, const S& imposed) {
    return select(value_of(slip.compliance.pitch) != 0.0, compliant,
                  select(value_of(slip.compliance.yaw) != 0.0, compliant, imposed));
  };
  // Without compliance there is only slip: the start is the root itself, and without slip there is no torque.
  const S of_slip = slip.free_velocity.length() / level;
  const auto acts = value_of(where_compliant(S{1.0}, of_slip)) > 0.0;
  S lambda = where_compliant(S{0.0}, of_slip);
  for (int i = 0; i < 4; ++i) {
    const Pair<S> torque = slip.compliance.solve(S(1.0), lambda, slip.free_velocity);
    const Pair<S> slope = slip.compliance.solve(S(1.0), lambda, torque);
    const S size = torque.length();
    const S along = torque.pitch * slope.pitch + torque.yaw * slope.yaw;
    const S change = select(value_of(along) > 0.0, S((size / level - 1.0) * size * size / along), S{0.0});
    lambda = select(value_of(lambda + change) > 0.0, S(lambda + change), S{0.0});
  }
  return select(rubs, select(acts, slip.compliance.solve(S(1.0), lambda, slip.free_velocity), Pair<S>{}), Pair<S>{});
}

/// One step of one bristle over both directions (Dahl, LuGre): z' = v - sigma0 |v| z / g(|v|), T = sigma0 z + sigma1 z' +
/// sigma2 v, with z, v and T vectors. Slip in one direction lowers the friction in the other: in steady sliding
/// T = g v / |v|. Discretised as `bristle_force`, with the velocity solved for in two dimensions; reduces to it along one.
/// `speed` is |v| as far as it is known, `level` is g there.
/// [GF] slides Dahl, LuGre, Multi-Axis Modeling; [Velenis, Tsiotras and Canudas de Wit 2002] for the vector form.
template <class S>
Pair<S> bristle_torque(Pair<S>& deflection, const Slip<S>& slip, const S& speed, const S& level,
                       const Bristle<S>& bristle) noexcept {
  const BristleStep<S> step = bristle_step<S>(speed, level, bristle, slip.h);
  const Pair<S> at_rest = step.at_rest * deflection;
  const Pair<S> velocity =
      slip.compliance.solve(step.per_velocity, S(1.0), slip.free_velocity - slip.compliance.times(at_rest));
  deflection = step.decay * deflection + (step.psi * slip.h) * velocity;
  return at_rest + step.per_velocity * velocity;
}

}  // namespace hotfire::model
