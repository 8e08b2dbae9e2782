// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/analysis/resonance.hpp"
#include "tools/analysis/sines.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire::trials {

/// What a frequency response is taken from.
struct SweepGoal {
  std::string axis = {};    ///< "pitch" for the channels command.pitch ...; empty for a record of one axis
  double moment_arm = 1.0;  ///< R [m]: the piston's gain is that of x_a / (R beta_c)
  double lowest = 3.0;      ///< where notch and resonance are searched for [Hz]
  double highest = 20.0;    ///< [Hz]
  double segment = 8.0;     ///< of Welch's method [s]
};

/// One channel's response to one amplitude.
struct ChannelSweep {
  std::string channel;     ///< "piston", "engine"
  double amplitude = 0.0;  ///< of the sines [rad]; 0 for a broadband command
  analysis::FrequencyResponse response;
  std::optional<analysis::Notch> notch;
  std::optional<analysis::Peak> peak;
};

/// The name of a channel of an axis: "piston", "piston.pitch".
std::string channel_of(const std::string& name, const std::string& axis);

/// The channel of an axis. Throws FileError if the record has none.
const Channel& required_channel(const Record& record, const std::string& name, const std::string& axis);

/// Frequency responses of piston and engine, as far as the record has them, to its command: sine by sine where the command
/// is a stepped sine for most of its length, by Welch's method otherwise. Simulated and recorded data go the same way.
/// Throws FileError for a record without command or without any output, or too short for a segment.
std::vector<ChannelSweep> analyse_sweep(const Record& record, const SweepGoal& goal);

/// The one of a channel and amplitude [rad], within 2 %; null if there is none.
const ChannelSweep* find_sweep(const std::vector<ChannelSweep>& sweeps, const std::string& channel, double amplitude);

/// A channel's response to all amplitudes as one, in order of frequency: what the Green Run profile gives.
ChannelSweep joined_sweep(const std::vector<ChannelSweep>& sweeps, const std::string& channel, const SweepGoal& goal);

}  // namespace hotfire::trials
