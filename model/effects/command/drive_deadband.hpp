// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// Dead band of a drive (`at`: of a mass, `command`; of a motor, `drive`): nothing until its input is beyond half_width, and
/// the input less half_width from there on (the overlap of a spool, the starting voltage of an amplifier).
template <Site at>
struct DriveDeadbandAt {
  static constexpr std::string_view name = "drive_deadband";
  static constexpr Site site = at;
  static constexpr std::string_view unit = at == Site::drive ? "command" : "force";
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S half_width{0.0};
    static constexpr auto fields() {
      return std::array{Field<Params>{"half_width", unit, 0.0, 1e9, 0.2, "half of the dead band", &Params::half_width}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Signal<S>& input) noexcept {
    return input.value - clamp_symmetric<S>(input.value, params.half_width);
  }
};

/// Of a mass that a force drives.
using DriveDeadband = DriveDeadbandAt<Site::command>;

}  // namespace hotfire::model
