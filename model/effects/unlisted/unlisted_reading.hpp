// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/effects/unlisted/unlisted.hpp"

namespace hotfire::model {

/// Error of a sensor as a table over the measured quantity: a worn track, a local bump.
struct UnlistedReading {
  static constexpr std::string_view name = "unlisted_reading";
  static constexpr Site site = Site::sensor;
  static constexpr bool is_unlisted = true;
  enum class Law { piston, engine };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 2> options{"piston", "engine"};
  static constexpr std::string_view option_key = "channel";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    UnlistedTable<S> table{};
    static constexpr auto fields() { return std::array<Field<Params>, 0>{}; }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      return std::array{T{"position", "m", "error_at_position", "m", -1.0, 1.0, "what the sensor adds at a piston position",
                          &Params::table, only(Law::piston), 1e-4},
                        T{"angle", "rad", "error_at_angle", "rad", -1.0, 1.0, "what the sensor adds at an engine angle",
                          &Params::table, only(Law::engine), 1e-4}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Signal<S>& input) noexcept {
    return input.value + unlisted::value_at<S>(params.table, input.value);
  }
};

/// Error of a sensor as a table over the time of the record: a zero that drifts.
struct UnlistedDrift {
  static constexpr std::string_view name = "unlisted_drift";
  static constexpr Site site = Site::sensor;
  static constexpr bool is_unlisted = true;
  enum class Law { piston, engine };  ///< in the order of `options`
  static constexpr std::array<std::string_view, 2> options{"piston", "engine"};
  static constexpr std::string_view option_key = "channel";

  template <class S>
  struct Params {
    using Scalar = S;
    int option = 0;
    UnlistedTable<S> table{};
    static constexpr auto fields() { return std::array<Field<Params>, 0>{}; }
    static constexpr auto tables() {
      using T = TableField<Params, UnlistedTable<S>>;
      return std::array{T{"time_of_piston", "s", "piston_error_at_time", "m", -1.0, 1.0,
                          "what the piston's sensor adds at a time of the record", &Params::table, only(Law::piston), 1e-4},
                        T{"time_of_engine", "s", "engine_error_at_time", "rad", -1.0, 1.0,
                          "what the engine's sensor adds at a time of the record", &Params::table, only(Law::engine), 1e-4}};
    }
  };

  template <class S>
  struct State {};

  template <class S>
  static S step(const Params<S>& params, State<S>&, const Signal<S>& input) noexcept {
    return input.value + unlisted::value_at<S>(params.table, input.time);
  }
};

}  // namespace hotfire::model
