// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/explain/data/dataset.hpp"

namespace hotfire::explain {

// Every record and channel of a hydraulic axis has a zero of its own: an amplifier that drifted between two runs, a
// potentiometer that was mounted again. It is a nuisance of the record, no part of the plant: o ~ N(0, S^2), S a share of
// the channel's travel, integrated out of whatever compares a model with records. A constant of the plant, such as a torque
// or the null bias of a valve, is identified by its effect on the motion, not by where a sensor reads zero. A zero of the
// command is one of the piston, since a servo takes both up alike: it is reported as the channels' zeros.
//
// A force-driven mass has none. The zero of its position is a constant force over its stiffness, or where it starts.

/// Deviation of a zero, as a share of the half travel of the channel: ten times the zero error of a calibrated sensor
/// (0.5 % of its range), whatever part of that range the records use.
inline constexpr double kZeroShare = 0.05;

/// By experiment, by channel [unit of the channel]: measured minus modelled.
using Zeros = std::vector<std::vector<double>>;

/// The most likely zero of a channel of a record under a prediction without one, from the rows that a fit sees: with n rows
/// of noise v^2, o = S^2 sum(measured - predicted) / (v^2 + n S^2).
double zero_of(const Experiment& experiment, std::size_t channel, const std::vector<double>& predicted);

/// Rows n of the experiment that a fit sees, times (S / v)^2: the precision that they add to the prior's 1.
double zero_precision(const Experiment& experiment, std::size_t channel);

/// Adds to each channel of a prediction the zero that it has, and returns the zeros.
Zeros add_zeros(const Dataset& data, std::vector<std::vector<std::vector<double>>>& prediction);

/// The records with each channel's zero taken off.
Dataset without_zeros(Dataset data, const Zeros& zeros);

}  // namespace hotfire::explain
