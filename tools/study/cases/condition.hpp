// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/study/cases/profiles.hpp"

namespace hotfire::study {

/// Under what circumstances the given records of a case are made. What is not said is as in the other studies.
struct Condition {
  enum class Records { three, one, ten };

  std::string_view name;
  Records records = Records::three;
  double period = kSample;     ///< of the rows [s]; a command is held as long, or for `kSample` if that is longer
  double command_size = 1.0;   ///< times the usual
  double cut = 0.0;            ///< of each record's start that is not given [s]: what is left starts in motion
  double loop_gain = 0.0;      ///< command = asked + loop_gain (asked - reading of the engine)
  double noise_corner = 0.0;   ///< of noise that went through a first-order lag [Hz], as large as the usual; 0: white
  int engine_late = 0;         ///< rows by which the clock of the engine's channel is late
  double engine_error = 0.0;   ///< relative error of that channel's scale
  double command_error = 0.0;  ///< ... and of the command's
  int drop_outs = 0;           ///< in each record, declared by the user
  double zeros = 0.0;          ///< rms of a zero of each channel of each record, in the channel's noise
  double null_bias = 0.0;      ///< of the valve, as a share of its full command
  double noise_ratio = 1.0;    ///< noise of the first record over that of the others, of which nothing is declared

  /// The effect that a fault of a channel is to be named as; empty if it has none.
  std::string_view fault() const;
};

/// What makes data hard: rows from 50 Hz to 5 kHz, one record or ten, small commands, and so on.
std::span<const Condition> hard_conditions();

/// The condition of that name, "" for that of the other studies. Throws UsageError that lists the names if there is none.
const Condition& condition_of(std::string_view name);

/// The commands of the records that a case under this condition gives, of the random streams of its name and seed.
std::vector<Profile> conditioned_profiles(const Condition& condition, const std::string& name, std::uint64_t seed);

}  // namespace hotfire::study
