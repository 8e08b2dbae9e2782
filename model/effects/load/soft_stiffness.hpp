// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <type_traits>

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
/// The smooth laws are solved from the force of the last evaluation: one iteration of Halley's method (third order; Traub
/// 1964, Iterative Methods for the Solution of Equations, ch. 5), then one of Newton's in the model's scalar, which carries
/// the exact gradient. A change of a tenth of F_0 between two evaluations leaves 1e-9 of F_0, less than rounding after the
/// second of a step. x_act is concave in F: Newton's iterates lie below the root and rise to it, whatever the change.
struct SoftStiffness {
  static constexpr std::string_view name = "soft_stiffness";
  static constexpr Site site = Site::load_spring;
  enum class Law { compliance, stiffness, table, saturation };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 4> options{"compliance", "stiffness", "table", "saturation"};
  static constexpr std::string_view option_key = "law";
  static constexpr bool remembers_a_guess = true;
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
    Plain<S> magnitude{0.0};  ///< force of the last evaluation, where the next one begins [N]
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

  /// Puts the guess at the force of a deflection, however far away it is.
  template <class S>
  static void settle(const Params<S>& params, State<S>& state, const Spring<S>& input) noexcept {
    if (law_of<SoftStiffness>(params) == Law::table) {
      return;
    }
    constexpr int kMostIterations = 60;
    const Curve<double> curve = curve_of<double>(params, input);
    const double deflection = std::abs(value_of(input.deflection));
    for (int i = 0; i < kMostIterations; ++i) {
      const double next = curve.newton(state.magnitude, deflection);
      const bool is_there = std::abs(next - state.magnitude) <= 1e-15 * next;
      state.magnitude = next;
      if (is_there) {
        break;
      }
    }
  }

  template <class S>
  static Spring<S> step(const Params<S>& params, State<S>& state, const Spring<S>& input) noexcept {
    const auto direction = sign_of(input.deflection);
    const S deflection = input.deflection * direction;
    Spring<S> output = input;
    if (law_of<SoftStiffness>(params) == Law::table) {
      output.deflection = table_force(params, input, deflection) * direction / input.stiffness;
      return output;
    }
    const Plain<S> near = curve_of<Plain<S>>(params, input).halley(state.magnitude, value_of(deflection));
    const S solved = curve_of<S>(params, input).newton(S(near), deflection);
    state.magnitude = value_of(solved);
    output.deflection = solved * direction / input.stiffness;
    return output;
  }

 private:
  /// Deflection of actuator and load in series under a force, for the smooth laws.
  template <class T>
  struct Curve {
    T scale;
    T actuator;  ///< compliance of the loaded actuator [m/N]
    T load;      ///< compliance of the load [m/N]
    T further;   ///< compliance that the actuator has beyond it at no load [m/N]; law `stiffness`: stiffness below it [N/m]
    Law law;

    /// Deflection, its derivative and its second derivative by the force.
    struct Point {
      T deflection;
      T compliance;
      T bend;
    };

    Point at(const T& force) const noexcept {
      using std::log;
      const T one{1.0};
      const T fading = fading_exponential<T>(force / scale);
      const T linear = force * (actuator + load);
      if (law == Law::compliance) {
        return {linear + further * scale * (one - fading), actuator + load + further * fading, -further / scale * fading};
      }
      if (law == Law::saturation) {
        const T saturated = (one - fading * fading) / (one + fading * fading);
        const T slope = further * (one - saturated * saturated);
        return {linear + further * scale * saturated, actuator + load + slope, -(slope + slope) / scale * saturated};
      }
      const T stiffness = one / actuator - further * fading;
      const T compliance = one / stiffness;
      return {linear + scale * actuator * log(stiffness / (one / actuator - further)), compliance + load,
              -further / scale * fading * compliance * compliance};
    }

    T newton(const T& force, const T& deflection) const noexcept {
      const Point here = at(force);
      const T next = force - (here.deflection - deflection) / here.compliance;
      return select(value_of(next) > 0.0, next, T{0.0});
    }

    T halley(const T& force, const T& deflection) const noexcept {
      const Point here = at(force);
      const T off = here.deflection - deflection;
      // Far below the root the bend would make the step endless: twice Newton's at most.
      const T half{0.5};
      const T curved = here.compliance - half * off * here.bend / here.compliance;
      const T least = half * here.compliance;
      const T next = force - off / select(curved > least, curved, least);
      return select(value_of(next) > 0.0, next, T{0.0});
    }
  };

  template <class T, class S>
  static Curve<T> curve_of(const Params<S>& params, const Spring<S>& input) noexcept {
    const auto plain = [](const S& x) -> T {
      if constexpr (std::is_same_v<T, S>) {
        return x;
      } else {
        return value_of(x);
      }
    };
    const T actuator = plain(input.actuator_stiffness);
    const T given = plain(params.low_stiffness);
    const T low = select(given < actuator, given, actuator);
    const Law law = law_of<SoftStiffness>(params);
    return {plain(params.load_scale), T(1.0 / actuator), T(1.0 / plain(input.load_stiffness)),
            law == Law::stiffness ? T(actuator - low) : T(1.0 / low - 1.0 / actuator), law};
  }

  template <class S>
  static S table_force(const Params<S>& params, const Spring<S>& input, const S& deflection) noexcept {
    const auto& table = params.table;
    const S load_compliance = 1.0 / input.load_stiffness;
    // Of the point below the deflection: its force, its deflection, and the compliance from there on. Every point is looked
    // at, so that the time depends on their number alone.
    S force_below{0.0};
    S deflection_below{0.0};
    S compliance = 1.0 / table.y[0] + load_compliance;
    S force_before{0.0};
    S deflection_here{0.0};
    S through = compliance;
    for (int i = 0; i < table.points; ++i) {
      const auto k = static_cast<std::size_t>(i);
      deflection_here = deflection_here + (table.x[k] - force_before) * through;
      force_before = table.x[k];
      const S own = i + 1 == table.points ? 1.0 / table.y[k] : 0.5 * (1.0 / table.y[k + 1] + 1.0 / table.y[k]);
      through = own + load_compliance;
      const auto is_short = deflection < deflection_here;
      force_below = select(is_short, force_below, force_before);
      deflection_below = select(is_short, deflection_below, deflection_here);
      compliance = select(is_short, compliance, through);
    }
    return force_below + (deflection - deflection_below) / compliance;
  }
};

}  // namespace hotfire::model
