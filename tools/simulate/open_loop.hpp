// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "tools/files/record/record.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/run.hpp"

namespace hotfire {

/// The values of a channel of a record; empty if it has no such channel.
inline std::span<const double> values_of(const Record& inputs, std::string_view name) {
  const Channel* channel = inputs.find(std::string(name));
  return channel != nullptr ? std::span<const double>(channel->values) : std::span<const double>();
}

/// An output record with the rows of `inputs`. It holds the input channel only.
inline Record beside(const Record& inputs, const Channel& input) {
  Record outputs;
  outputs.start = inputs.start;
  outputs.period = inputs.period;
  outputs.rows = inputs.rows;
  outputs.channels.push_back(input);
  return outputs;
}

/// The error for a model that runs away at a row.
inline FileError runaway_error(const Record& inputs, std::size_t row, std::string_view input_channel) {
  return FileError(fmt::format("{}: the model runs away at {:.6g} s: its parameters make it unstable for this {}",
                               inputs.path.string(), inputs.start + static_cast<double>(row) * inputs.period,
                               input_channel));
}

/// Where a plant of one axis starts under a record: a hydraulic axis in the steady state under the first command
/// (`first_piston` says where, without position feedback and in a play of the valve), a driven mass at the first row of its
/// position and velocity, each zero where the record does not have it, a moved body on its path, a structure in modal
/// coordinates at rest, an electromechanical actuator at rest where its first row is (`at_first_row`).
template <class Plant>
typename Plant::State start_of(const Plant& plant, const Record& inputs) {
  using S = typename Plant::Scalar;
  if constexpr (Plant::topology == "imposed_motion") {
    return enter_path(plant, inputs.find(std::string(Plant::input_channel))->values, inputs.period, inputs.start);
  } else {
    typename Plant::State state = [&] {
      if constexpr (Plant::topology == "direct") {
        const auto first = [&](std::string_view name) {
          const Channel* channel = inputs.find(std::string(name));
          return S(channel != nullptr ? channel->values.front() : 0.0);
        };
        return plant.moving(first(Plant::channels[Plant::kPosition]), first(Plant::channels[Plant::kVelocity]),
                            first(Plant::input_channel));
      } else if constexpr (Plant::topology == "modal") {
        return plant.at_rest(S(0.0));
      } else if constexpr (Plant::topology == "electromechanical") {
        return at_first_row(plant, inputs.find(std::string(Plant::input_channel))->values.front(),
                            values_of(inputs, Plant::channels[Plant::kPosition]),
                            values_of(inputs, Plant::channels[Plant::kMotorPosition]));
      } else {
        const std::span<const double> command = inputs.find(std::string(Plant::input_channel))->values;
        return plant.resting(S(command.front()),
                             first_piston(plant, command, values_of(inputs, "piston"), values_of(inputs, "engine")));
      }
    }();
    state.clock.start = S(inputs.start);
    return state;
  }
}

/// Steps a plant of one axis through a record, `steps` plant steps a row, and hands every row's readings to
/// `sink(row, readings)`; a hydraulic axis also under the record's `torque`, if it has one. Returns false at the first
/// reading that is not finite or ran away.
template <class Plant, class Sink>
bool run_record(const Plant& plant, const Record& inputs, typename Plant::State& state, int steps, Sink&& sink) {
  const Channel& input = *inputs.find(std::string(Plant::input_channel));
  if constexpr (Plant::topology == "simplex") {
    if (const Channel* torque = inputs.find("torque")) {
      return run_under_torque(plant, input.values, torque->values, state, steps, std::forward<Sink>(sink));
    }
  }
  return run(plant, input.values, state, steps, std::forward<Sink>(sink));
}

}  // namespace hotfire
