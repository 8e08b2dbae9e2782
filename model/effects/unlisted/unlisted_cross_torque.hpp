// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/effects/unlisted/unlisted.hpp"

namespace hotfire::model {

/// A torque from the motion of the engine about its other axis that `cross_axis` cannot represent, against positive motion.
/// It is a table over the other angle or over its rate, or a stiffness against the own angle that is a table over the other
/// angle. Without a second axis the effect is zero.
struct UnlistedCrossTorque {
  static constexpr std::string_view name = "unlisted_cross_torque";
  static constexpr Site site = Site::engine_torque;
  static constexpr bool is_unlisted = true;
  static constexpr bool needs_other_axis = true;
  enum class Law { other_angle, other_rate, stiffness_along_other_angle };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 3> options{"other_angle", "other_rate", "stiffness_along_other_angle"};
  static constexpr std::string_view option_key = "depends_on";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    UnlistedTable<S> table{};
    static constexpr auto fields() { return std::array<Field<Params>, 0>{}; }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      using Names = UnlistedNames<Site::engine_torque>;
      return std::array{T{"other_angle", "rad", "torque_at_other_angle", "N.m", -1e12, 1e12,
                          "torque against positive motion at an angle of the other axis", &Params::table,
                          only(Law::other_angle), Names::typical},
                        T{"other_rate", "rad/s", "torque_at_other_rate", "N.m", -1e12, 1e12,
                          "torque against positive motion at a rate of the other axis", &Params::table,
                          only(Law::other_rate), Names::typical},
                        T{"other_angle_of_stiffness", "rad", "stiffness_at_other_angle", "N.m/rad", -1e8, 1e8,
                          "stiffness against the own angle at an angle of the other axis", &Params::table,
                          only(Law::stiffness_along_other_angle), 1e5}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Motion<S>& input) noexcept {
    switch (law_of<UnlistedCrossTorque>(params)) {
      case Law::other_angle:
        return unlisted::value_at<S>(params.table, input.other_angle);
      case Law::other_rate:
        return unlisted::value_at<S>(params.table, input.other_rate);
      case Law::stiffness_along_other_angle:
        return unlisted::value_at<S>(params.table, input.other_angle) * input.position;
    }
    return S{0.0};
  }
};

}  // namespace hotfire::model
