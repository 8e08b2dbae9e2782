// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/numerics/scalar.hpp"

namespace hotfire::model {

/// Limit of a drive (`at`: of a mass, `command`; of a motor, `drive`): the force, or the voltage or current, follows its
/// input up to `limit` in either direction. A limit beyond every input has no action.
template <Site at>
struct DriveSaturationAt {
  static constexpr std::string_view name = "drive_saturation";
  static constexpr Site site = at;
  static constexpr std::string_view unit = at == Site::drive ? "command" : "force";
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S limit{1e12};
    static constexpr auto fields() {
      return std::array{Field<Params>{"limit", unit, 0.0, 1e12, 1.0, "largest output in either direction", &Params::limit}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Signal<S>& input) noexcept {
    return clamp_symmetric<S>(input.value, params.limit);
  }
};

/// Of a mass that a force drives.
using DriveSaturation = DriveSaturationAt<Site::command>;

}  // namespace hotfire::model
