#pragma once

#include "model/effects/unlisted.hpp"
#include "model/scalar.hpp"

namespace hotfire::model {

/// Deflection added to the load spring's, as a table over its own deflection or the engine angle; a spring that creeps: a
/// share of the deflection relaxes with a time constant (a standard linear solid); or one whose stiffness drifts, K_T
/// (1 + stiffness(t)).
struct UnlistedDeflection {
  static constexpr std::string_view name = "unlisted_deflection";
  static constexpr Site site = Site::load_spring;
  static constexpr bool is_unlisted = true;
  static constexpr std::array<std::string_view, 4> options{"deflection", "angle", "creep", "stiffness_along_time"};
  static constexpr std::string_view option_key = "depends_on";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S creep_share{0.0};
    S creep_time{1.0};
    UnlistedTable<S> table{};
    static constexpr auto fields() {
      return std::array{
          Field<Params>{"creep_share", "1", 0.0, 0.95, 0.1, "share of the deflection that relaxes", &Params::creep_share,
                        0b100},
          Field<Params>{"creep_time", "s", 1e-3, 1e3, 0.5, "time constant of the relaxation", &Params::creep_time, 0b100}};
    }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      return std::array{T{"deflection", "m", "added_at_deflection", "m", -1.0, 1.0, "what is added at a deflection",
                          &Params::table, 0b01, 5e-5},
                        T{"angle", "rad", "added_at_angle", "m", -1.0, 1.0, "what is added at an engine angle",
                          &Params::table, 0b10, 5e-5},
                        T{"time", "s", "stiffness_at_time", "1", -0.95, 10.0,
                          "share by which the spring is stiffer at a time of the record", &Params::table, 0b1000, 0.1}};
    }
  };

  template <class S>
  struct State {
    S relaxed{0.0};  ///< deflection that the creeping part follows [m]
  };

  template <class S>
  static void settle(const Params<S>&, State<S>& state, const Spring<S>& input) noexcept {
    state.relaxed = input.deflection;
  }

  template <class S>
  static Spring<S> step(const Params<S>& params, State<S>& state, const Spring<S>& input) noexcept {
    Spring<S> output = input;
    if (params.option == 2) {
      const S start = state.relaxed;
      const S decay = fading_exponential<S>(input.h / params.creep_time);
      state.relaxed = input.deflection + (start - input.deflection) * decay;
      output.deflection = input.deflection - params.creep_share * 0.5 * (start + state.relaxed);
    } else if (params.option == 3) {
      output.deflection = input.deflection * (1.0 + unlisted::value_at<S>(params.table, input.time));
    } else {
      output.deflection += unlisted::value_at<S>(params.table, params.option == 0 ? input.deflection : input.angle);
    }
    return output;
  }
};

}  // namespace hotfire::model
