// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace hotfire {

/// The most engines whose modes this build reads: what the plant of model/ has room for.
inline constexpr int kMostEngines = 4;

/// The most rows a table may have.
inline constexpr std::size_t kMostModes = 10'000;

/// What the attitude of a stage in flight needs of its modes: every mode of the table, those of it as a rigid body
/// (frequency 0) among them. Empty for a table without the columns of `flight_names`.
struct FlightModes {
  Eigen::VectorXd frequency;      ///< [Hz], one a mode
  Eigen::VectorXd damping_ratio;  ///< one a mode
  /// How far a mode moves a gimbal along the side force that a positive angle of its axis makes [kg^-0.5]: two rows an
  /// engine, a column a mode.
  Eigen::MatrixXd side;
  Eigen::MatrixXd sensor;  ///< how far a mode turns the attitude sensor about pitch and yaw [rad/(m kg^0.5)]: two rows
  Eigen::MatrixXd shape;   ///< of ports and strings, a column a mode
};

/// A set of vehicle modes that bend it, mass-normalised, and the flexibility that no mode of it has. The ports are those of
/// model::ModeTable: two attach points an engine, then two rotations of its gimbal.
struct ModeSet {
  int engines = 0;
  Eigen::VectorXd frequency;      ///< [Hz], one a mode
  Eigen::VectorXd damping_ratio;  ///< one a mode
  Eigen::MatrixXd shape;          ///< a row a port, a column a mode [kg^-0.5], rotations [rad/(m kg^0.5)]
  Eigen::MatrixXd residual;       ///< a row and a column a port [m/N], [rad/N], [rad/(N m)]
  /// How far a mode pulls the two ends of a string potentiometer towards each other along its line [kg^-0.5]: four rows an
  /// engine, a column a mode; and what no mode has of it, a column a port. Both are empty for a table without strings.
  Eigen::MatrixXd string_shape;
  Eigen::MatrixXd string_residual;
  FlightModes flight{};

  int ports() const { return 4 * engines; }
  int modes() const { return static_cast<int>(frequency.size()); }
};

/// Names of the ports of `engines` engines in order: attach.pitch1, attach.yaw1, attach.pitch2 ..., gimbal.pitch1 ...
std::vector<std::string> port_names(int engines);

/// Names of the strings: string1.engine1, string2.engine1 ..., string1.engine2 ...
std::vector<std::string> string_names(int engines);

/// Names of what a table of a stage in flight has besides: side.pitch1, side.yaw1 ..., sensor.pitch, sensor.yaw.
std::vector<std::string> flight_names(int engines);

/// Reads and checks a mode table. CSV; lines that begin with # are comments. The first other line names the columns:
///   mode,frequency[Hz],damping[1],attach.pitch1,attach.yaw1,...,gimbal.pitch1,gimbal.yaw1,...
/// in any order, with all four shapes of every engine from 1 up, for all engines or none string1.engine1, ..., and all of
/// `flight_names` or none. A row is a mode, numbered, or `residual.PORT`: what a unit of force on that port moves beyond the
/// modes, its frequency and damping and what it has of `flight_names` left empty. Without such rows the residual is zero. A
/// mode of frequency 0 is one of the stage as a rigid body: it needs `flight_names`, and moves the attitude alone.
///
/// Throws FileError naming file, line, value and what is allowed: a missing or unknown column, a missing shape, a frequency
/// below 0, a damping ratio outside [0, 1), a mode given twice, a number that is not finite, a residual that is
/// not complete, symmetric and positive semidefinite, more engines than `kMostEngines`.
ModeSet load_modes(const std::filesystem::path& path);

/// The text that `load_modes` reads back bit for bit, after `comment` lines.
std::string mode_table_text(const ModeSet& modes, const std::vector<std::string>& comments);

}  // namespace hotfire
