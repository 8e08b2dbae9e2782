// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"

namespace hotfire::model {

/// Further leakage across the piston, beside the declared one.
/// Law `laminar`: Q_leak = coefficient P; law `orifice`: Q_leak = coefficient P sqrt(P_s / (|P| + P_s / 1000)), which is
/// coefficient sqrt(P_s |P|) sgn(P) above a thousandth of the supply pressure and laminar below, as a real orifice is.
/// [Merritt 1967] Hydraulic Control Systems, sec. 3-3 (laminar gap) and 3-4 (orifice).
struct Leakage {
  static constexpr std::string_view name = "leakage";
  static constexpr Site site = Site::flow;
  enum class Law { laminar, orifice };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 2> options{"laminar", "orifice"};
  static constexpr std::string_view option_key = "law";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S coefficient{0.0};
    static constexpr auto fields() {
      return std::array{Field<Params>{"coefficient", "m^3/s/Pa", 0.0, 1e-9, 1e-11, "leakage flow per load pressure",
                                      &Params::coefficient}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Hydraulics<S>& input) noexcept {
    if (law_of<Leakage>(params) == Law::laminar) {
      return -params.coefficient * input.load_pressure;
    }
    const S magnitude = input.load_pressure * sign_of(input.load_pressure);
    return -params.coefficient * input.load_pressure *
           sqrt(input.supply_pressure / (magnitude + input.supply_pressure * 1e-3));
  }
};

}  // namespace hotfire::model
