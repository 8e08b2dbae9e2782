// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"

namespace hotfire::model {

/// A mis-scaled command channel: the axis was commanded (1 + error) times the recorded value. It is a fault of a calibration
/// and not of the plant: correct the record instead of running the plant with it.
struct CommandScale {
  static constexpr std::string_view name = "command_scale";
  static constexpr Site site = Site::command;
  static constexpr NoOptions options{};

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S error{0.0};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"error", "1", -0.8, 4.0, 0.02, "relative error of the command's scale", &Params::error}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Signal<S>& input) noexcept {
    return input.value * (1.0 + params.error);
  }
};

}  // namespace hotfire::model
