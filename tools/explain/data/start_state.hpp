// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "tools/files/model/model_file.hpp"

namespace hotfire::explain {

/// Where a force-driven mass is at the first row of a record, estimated from its first rows, with standard errors.
struct StartState {
  double position = 0.0;
  double velocity = 0.0;
  double position_error = 0.0;
  double velocity_error = 0.0;

  /// True if the velocity is beyond what chance gives a mass at rest: four standard errors, a chance of 1 in 16,000.
  bool moves() const;
};

/// Least squares of the first twenty rows on the declared mass: initial position, initial velocity and a constant force that
/// represents what is missing in the declared model over so short a time (friction, an offset). The declared mass without
/// effects is linear, so its response to each is exact. `measured` and `noise` [rms] are in the order of the plant's
/// channels: the position is fitted where it is measured, else the velocity. Where the fit is worse than the noise, the
/// standard errors grow with it. Zeros without error where a mass is known by its acceleration alone, or by less than four
/// rows.
StartState start_state(const DirectParameters& parameters, std::span<const double> force,
                       std::span<const std::vector<double>> measured, double period, std::span<const double> noise);

/// How many rows pass until a hydraulic axis has forgotten where it started, to a ten-thousandth: at most a quarter of them.
/// What is forgotten: the servo's position error and the pressure washout; without position feedback the spool and the
/// washout.
std::size_t rows_of_memory(const SimplexParameters& parameters, std::size_t rows, double period);

/// True if the residual `left` of a model decays at its start, as the error of an unknown start does. Its rms over the first
/// seventh and the first half of a time constant is twice that of all rows beyond the memory, and twice the noise; most of
/// it is gone in the second quarter of the memory. It separates a start in motion from a steady one only beside a calibrated
/// model.
bool dies_out_at_start(std::span<const double> left, std::size_t memory, double noise);

/// How many rows pass until a hydraulic axis has forgotten where it started (`rows_of_memory`); 0 if it starts in the steady
/// state under its first command. It does not where measured minus simulated piston or engine motion has a slope over the
/// first twenty rows that is beyond six standard errors.
std::size_t rows_to_forget_start(const SimplexParameters& parameters, std::span<const double> command,
                                 std::span<const std::vector<double>> measured, double period,
                                 std::span<const double> noise);

/// The same of an electromechanical actuator: until all of its linear part that decays has done so, to a ten-thousandth.
std::size_t rows_to_forget_start(const ElectromechanicalParameters& parameters, std::span<const double> setpoint,
                                 std::span<const std::vector<double>> measured, double period,
                                 std::span<const double> noise);

/// The same of a structure in modal coordinates, whose start is not known: until each mode has decayed to a ten-thousandth,
/// but at most a quarter of the rows.
std::size_t rows_to_forget_start(const ModalParameters& parameters, std::size_t rows, double period);

}  // namespace hotfire::explain
