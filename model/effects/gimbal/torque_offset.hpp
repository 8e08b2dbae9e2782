// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"

namespace hotfire::model {

/// A constant torque on the engine (thrust misalignment, gravity). It opposes positive angles if positive.
struct TorqueOffset {
  static constexpr std::string_view name = "torque_offset";
  static constexpr Site site = Site::engine_torque;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S torque{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"torque", "N.m", -1e7, 1e7, 2e3, "constant torque against positive angles", &Params::torque}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Motion<S>&) noexcept {
    return params.torque;
  }
};

}  // namespace hotfire::model
