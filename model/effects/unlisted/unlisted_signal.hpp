// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "model/effects/command/rate_limit.hpp"
#include "model/effects/unlisted/unlisted.hpp"
#include "model/numerics/delay_line.hpp"
#include "model/numerics/operators.hpp"

namespace hotfire::model {

/// Command or valve command with an added term: a table over the signal's own value or over time, or a sinusoid of time. Or
/// a command with a delay that is a table over its distance from zero, or with a first-order lag.
template <Site at>
struct UnlistedSignal {
  using Names = UnlistedNames<at>;
  static constexpr std::string_view name = Names::name;
  static constexpr Site site = at;
  static constexpr bool is_unlisted = true;
  static constexpr bool can_be_late = at == Site::command;
  enum class Law { value, time, periodic, delay_along_distance, lag };  ///< in the order of `options`
  static constexpr auto options = [] {
    if constexpr (can_be_late) {
      return std::array<std::string_view, 5>{"value", "time", "periodic", "delay_along_distance", "lag"};
    } else {
      return std::array<std::string_view, 3>{"value", "time", "periodic"};
    }
  }();
  static constexpr std::string_view option_key = "depends_on";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S frequency{1.0};
    S amplitude{0.0};
    S phase{0.0};
    S lag_time{0.0};
    UnlistedTable<S> table{};
    static constexpr auto fields() {
      constexpr std::array kAll{Field<Params>{"frequency", "Hz", 1e-3, 1e3, 0.5, "frequency of the sinusoid",
                                              &Params::frequency, only(Law::periodic)},
                                Field<Params>{"amplitude", Names::unit, 0.0, Names::largest, Names::typical,
                                              "amplitude of the sinusoid", &Params::amplitude, only(Law::periodic)},
                                unlisted::phase_field<Params>(only(Law::periodic)),
                                Field<Params>{"lag_time", "s", 0.0, 10.0, 5e-3, "time constant of the command's lag",
                                              &Params::lag_time, only(Law::lag)}};
      std::array<Field<Params>, can_be_late ? kAll.size() : kAll.size() - 1> own{};
      std::copy_n(kAll.begin(), own.size(), own.begin());
      return own;
    }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      constexpr T kValue{"value",
                         Names::unit,
                         "added_at_value",
                         Names::unit,
                         -Names::largest,
                         Names::largest,
                         "what is added at a value of the signal",
                         &Params::table,
                         only(Law::value),
                         Names::typical};
      constexpr T kTime{"time",
                        "s",
                        "added_at_time",
                        Names::unit,
                        -Names::largest,
                        Names::largest,
                        "what is added at a time of the record",
                        &Params::table,
                        only(Law::time),
                        Names::typical};
      if constexpr (can_be_late) {
        return std::array{
            kValue, kTime,
            T{"distance_of_delay", Names::unit, "delay_at_distance", "s", 0.0, kLongestCommandDelay,
              "delay of the signal at a distance from zero", &Params::table, only(Law::delay_along_distance), 5e-3}};
      } else {
        return std::array{kValue, kTime};
      }
    }
  };

  template <class S>
  struct NoMemory {};

  template <class S>
  struct State {
    [[no_unique_address]] std::conditional_t<can_be_late, DelayLine<S, kCommandMemory>, NoMemory<S>> earlier{};
    S lagged{0.0};
  };

  template <class S>
  static void settle(const Params<S>&, State<S>& state, const Signal<S>& input) noexcept {
    if constexpr (can_be_late) {
      state.earlier.fill(input.value);
    }
    state.lagged = input.value;
  }

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Signal<S>& input) noexcept {
    const Law law = law_of<UnlistedSignal>(params);
    if constexpr (can_be_late) {
      if (law == Law::delay_along_distance) {
        const S distance = input.value * sign_of(input.value);
        const S delay = unlisted::value_at<S>(params.table, distance);
        return state.earlier.pass(input.value, value_of(delay) < 0.0 ? S{0.0} : delay, input.h);
      }
      if (law == Law::lag) {
        return lag_of_held(state.lagged, input.value, params.lag_time, input.h);
      }
    }
    switch (law) {
      case Law::value:
        return input.value + unlisted::value_at<S>(params.table, input.value);
      case Law::time:
        return input.value + unlisted::value_at<S>(params.table, input.time);
      default:
        return input.value + unlisted::periodic(params, params.amplitude, input.time);
    }
  }
};

/// The opening of the spool, by one of three laws: a table over the spool position that is added to it, a gain that drifts,
/// 1 + gain(t), or a limited speed of the spool (the law of `rate_limit`). A term over time belongs to the valve command,
/// because the spool follows it too fast for the records to show.
struct UnlistedOpening {
  static constexpr std::string_view name = "unlisted_valve";
  static constexpr Site site = Site::valve;
  static constexpr bool is_unlisted = true;
  enum class Law { value, gain_along_time, slew };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 3> options{"value", "gain_along_time", "slew"};
  static constexpr std::string_view option_key = "depends_on";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    S slew_rate{RateLimit::kNoLimit};
    UnlistedTable<S> table{};
    static constexpr auto fields() {
      return std::array{Field<Params>{"slew_rate", "1/s", 1e-3, RateLimit::kNoLimit, 10.0, "largest rate of the spool",
                                      &Params::slew_rate, only(Law::slew)}};
    }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      return std::array{
          T{"value", "1", "added_at_value", "1", -10.0, 10.0, "what is added at a spool position", &Params::table,
            only(Law::value), 0.02},
          T{"time", "s", "gain_at_time", "1", -1.0, 10.0, "share by which the opening grows at a time of the record",
            &Params::table, only(Law::gain_along_time), 0.05}};
    }
  };

  template <class S>
  struct State {
    RateLimit::State<S> slewed{};
  };

  template <class S>
  static void settle(const Params<S>& params, State<S>& state, const Signal<S>& input) noexcept {
    RateLimit::settle<S>({0, params.slew_rate}, state.slewed, input);
  }

  template <class S>
  static S step(const Params<S>& params, State<S>& state, const Signal<S>& input) noexcept {
    const Law law = law_of<UnlistedOpening>(params);
    if (law == Law::slew) {
      return RateLimit::step<S>({0, params.slew_rate}, state.slewed, input);
    }
    return law == Law::value ? S(input.value + unlisted::value_at<S>(params.table, input.value))
                             : S(input.value * (1.0 + unlisted::value_at<S>(params.table, input.time)));
  }
};

}  // namespace hotfire::model
