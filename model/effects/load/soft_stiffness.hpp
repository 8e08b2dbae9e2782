// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/declaration/effect.hpp"
#include "model/numerics/scalar.hpp"
#include "model/numerics/table.hpp"

namespace hotfire::model {

/// Actuator that is softer below a load ([SD] fig. 4), in series with the load stiffness K_L: the force solves
///   F / K_L + x_act(F) = deflection.
///
/// Laws for the tangent stiffness K(F) of the actuator, x_act being the integral of dF / K:
/// - `compliance`: 1/K falls exponentially with the load, 1/K = 1/K_act + (1/K_low - 1/K_act) e^{-|F|/F_0};
/// - `stiffness`: K rises exponentially with the load, K = K_act - (K_act - K_low) e^{-|F|/F_0};
/// - `saturation`: the soft part's deflection saturates, x_act = F/K_act + (1/K_low - 1/K_act) F_0 tanh(F/F_0);
/// - `table`: K given at loads, x_act linear between them with the mean compliance of the two ends, K constant beyond.
/// K_act is the declared stiffness, K_low = `low_stiffness` but no more than K_act (so that the default is neutral), F_0 =
/// `load_scale`. All are odd in F and passive (F is a function of the deflection).
///
/// The smooth laws are solved by Newton's method from the last force. x_act is concave in F, so every iterate after the
/// first lies below the root and rises to it; three plain iterations and one in the model's scalar reach rounding for the
/// change of one step and carry the exact gradient.
struct SoftStiffness {
  static constexpr std::string_view name = "soft_stiffness";
  static constexpr Site site = Site::load_spring;
  enum class Law { compliance, stiffness, table, saturation };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 4> options{"compliance", "stiffness", "table", "saturation"};
  static constexpr std::string_view option_key = "law";
  static constexpr std::size_t kTablePoints = 16;
  static constexpr unsigned kSmooth = only(Law::compliance, Law::stiffness, Law::saturation);

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S low_stiffness{1e12};
    S load_scale{1e4};
    Table<S, kTablePoints> table{};
    static constexpr auto fields() {
      return std::array{Field<Params>{"low_stiffness", "N/m", 1e5, 1e12, 4e7,
                                      "tangent stiffness of the actuator at zero load", &Params::low_stiffness, kSmooth},
                        Field<Params>{"load_scale", "N", 10.0, 1e6, 8e3, "load over which the stiffness rises",
                                      &Params::load_scale, kSmooth}};
    }
    static constexpr auto tables() {
      return std::array{TableField<Params, Table<S, kTablePoints>>{"load", "N", "table_stiffness", "N/m", 1e5, 1e12,
                                                                   "tangent stiffness of the actuator at a load",
                                                                   &Params::table, only(Law::table)}};
    }
  };

  template <class S>
  struct State {
    double magnitude = 0.0;  ///< last force, where the next search starts [N]
  };

  template <class S>
  static std::string_view broken_relation(const Params<S>& params) noexcept {
    if (law_of<SoftStiffness>(params) == Law::table && params.table.points < 2) {
      return "law \"table\" needs at least two points in load and table_stiffness";
    }
    if (law_of<SoftStiffness>(params) == Law::table && !(value_of(params.table.x[0]) >= 0.0)) {
      return "load must not be negative: the curve is odd";
    }
    return {};
  }

  template <class S>
  static Spring<S> step(const Params<S>& params, State<S>& state, const Spring<S>& input) noexcept {
    const double direction = sign_of(input.deflection);
    const S deflection = input.deflection * direction;
    Spring<S> output = input;
    if (law_of<SoftStiffness>(params) == Law::table) {
      output.deflection = table_force(params, input, deflection) * direction / input.stiffness;
      return output;
    }
    const S low = params.low_stiffness < input.actuator_stiffness ? params.low_stiffness : input.actuator_stiffness;
    const Curve<double> plain{value_of(low), value_of(params.load_scale), value_of(input.actuator_stiffness),
                              value_of(input.load_stiffness), law_of<SoftStiffness>(params)};
    double force = state.magnitude;
    for (int i = 0; i < 3; ++i) {
      force = plain.newton(force, value_of(deflection));
    }
    const Curve<S> curve{low, params.load_scale, input.actuator_stiffness, input.load_stiffness,
                         law_of<SoftStiffness>(params)};
    const S solved = curve.newton(S(force), deflection);
    state.magnitude = value_of(solved);
    output.deflection = solved * direction / input.stiffness;
    return output;
  }

 private:
  /// Deflection of actuator and load in series under a force, for the smooth laws.
  template <class T>
  struct Curve {
    T low;
    T scale;
    T actuator;
    T load;
    Law law;

    T newton(const T& force, const T& deflection) const noexcept {
      using std::log;
      const T fading = fading_exponential<T>(force / scale);
      T own{0.0};
      T compliance{0.0};
      const T further = 1.0 / low - 1.0 / actuator;
      if (law == Law::compliance) {
        own = force / actuator + further * scale * (1.0 - fading);
        compliance = 1.0 / actuator + further * fading;
      } else if (law == Law::saturation) {
        const T saturated = (1.0 - fading * fading) / (1.0 + fading * fading);
        own = force / actuator + further * scale * saturated;
        compliance = 1.0 / actuator + further * (1.0 - saturated * saturated);
      } else {
        const T stiffness = actuator - (actuator - low) * fading;
        own = force / actuator + scale / actuator * log(stiffness / low);
        compliance = 1.0 / stiffness;
      }
      const T next = force - (own + force / load - deflection) / (compliance + 1.0 / load);
      return value_of(next) > 0.0 ? next : T{0.0};
    }
  };

  template <class S>
  static S table_force(const Params<S>& params, const Spring<S>& input, const S& deflection) noexcept {
    const auto& table = params.table;
    const S load_compliance = 1.0 / input.load_stiffness;
    S force_below{0.0};
    S deflection_below{0.0};
    S compliance = 1.0 / table.y[0] + load_compliance;
    for (int i = 0; i < table.points; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const S own = i == 0 ? 1.0 / table.y[0] : 0.5 * (1.0 / table.y[k] + 1.0 / table.y[k - 1]);
      const S through = own + load_compliance;
      const S deflection_here = deflection_below + (table.x[k] - force_below) * through;
      if (deflection < deflection_here) {
        compliance = through;
        return force_below + (deflection - deflection_below) / compliance;
      }
      force_below = table.x[k];
      deflection_below = deflection_here;
      compliance = 1.0 / table.y[k] + load_compliance;
    }
    return force_below + (deflection - deflection_below) / compliance;
  }
};

}  // namespace hotfire::model
