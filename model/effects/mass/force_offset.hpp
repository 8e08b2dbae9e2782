// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"

namespace hotfire::model {

/// A constant force on the mass (drive offset, gravity), against positive motion if positive.
struct ForceOffset {
  static constexpr std::string_view name = "force_offset";
  static constexpr Site site = Site::mass_force;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S force{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"force", "force", -1e9, 1e9, 0.05, "constant force against positive motion", &Params::force}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Motion<S>&) noexcept {
    return params.force;
  }
};

}  // namespace hotfire::model
