// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/disperse/declared_model.hpp"

namespace hotfire::disperse {

/// How a tolerance moves the numbers that its key names.
enum class Spread {
  relative,  ///< times 1 + size x, x standard normal
  absolute,  ///< plus size x, x standard normal
  between    ///< replaced by a value that is uniform from low to high
};

/// One random variable.
struct Tolerance {
  std::string key = {};
  Spread spread = Spread::relative;
  double size = 0.0;      ///< one-sigma, relative or in the unit of the key
  double low = 0.0;       ///< in the unit of the key
  double high = 0.0;      ///< in the unit of the key
  double within = 0.0;    ///< the normal variable is cut off at this many sigmas; 0: nowhere
  std::string unit = {};  ///< of the key, SI

  /// The value of the variable with `probability` below it: x for a normal one, what replaces the number for `between`.
  double at(double probability) const;
  /// What this tolerance alone makes of a declared number, with its variable at `x`.
  double applied(double declared, double x) const;
};

/// The random variables of a model, and how they are correlated.
struct Tolerances {
  std::vector<Tolerance> variables;
  Eigen::MatrixXd correlation;  ///< symmetric and positive definite, with ones on its diagonal
};

/// Reads a file of tolerances:
///   schema = 1
///   [tolerance]
///   engine.inertia = 0.02                                       # relative one-sigma, normal
///   servovalve.position_gain = {sigma = 0.03, within = 3}       # cut off at 3 sigma
///   gimbal.pitch_misalignment = {deviation = "1 mm"}          # one-sigma in the unit of the key
///   gimbal.friction.coulomb_torque = {low = "1e4 N.m", high = "3e4 N.m"}   # uniform
///   [locations.load_stiffness]                                  # a factor for each key, correlated
///   keys = ["structure.pitch.stiffness", "structure.yaw.stiffness"]
///   sigma = 0.1
///   correlation = 0.6                                           # of every two, or a matrix
///
/// A key of several axes moves the numbers of all of them by one variable; `engine.pitch.inertia` is that of one. Throws
/// FileError naming file, line, key, value and what is allowed: a key that the model does not have or that is given twice, a
/// size that is not above 0, a unit of another dimension, a correlation that is none.
Tolerances load_tolerances(const std::filesystem::path& path, DeclaredModel& model);

/// The relative tolerances of the model file itself. Throws FileError if it has none.
Tolerances tolerances_of(const std::filesystem::path& path, DeclaredModel& model);

/// The model with its variables at `x`: what replaces a number first, then factors, then offsets.
DeclaredModel with_variables(const DeclaredModel& model, const std::vector<Tolerance>& variables, const Eigen::VectorXd& x);

/// What each tolerance alone makes of the first number that its key names.
std::vector<double> drawn_values(DeclaredModel& model, const std::vector<Tolerance>& variables, const Eigen::VectorXd& x);

}  // namespace hotfire::disperse
