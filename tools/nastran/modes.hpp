// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace hotfire::nastran {

/// Motion of a grid point in a mode: three translations, then three rotations, in the grid's own axes.
using GridMotion = Eigen::Matrix<double, 6, 1>;

/// A mode as Nastran prints it.
struct NastranMode {
  int number = 0;
  double eigenvalue = 0.0;                 ///< w^2 [rad^2/s^2]
  std::optional<double> generalised_mass;  ///< in the mass unit of the model; unknown in a punch file
  bool in_basic_system = false;            ///< motion is in the basic system, whatever axes a grid point has
  std::map<int, GridMotion> motion;        ///< of the wanted grid points
  std::string place;                       ///< "modes.f06:312", where its eigenvector begins

  double frequency() const;  ///< [Hz]; 0 for an eigenvalue that is not above 0
};

/// Reads the eigenvalues and eigenvectors of the wanted grid points from Nastran's printed output (.f06): the last table
/// REAL EIGENVALUES, and every REAL EIGENVECTOR, also where they run over several pages. Throws FileError with file and
/// line: a fatal message, a row that is cut or has a value that is not a number, an eigenvector without its eigenvalue or
/// the other way round, a grid point that is given twice.
std::vector<NastranMode> load_f06(const std::filesystem::path& path, const std::set<int>& grids);

/// The same of the punch file (.pch) of DISPLACEMENT(PUNCH): `$EIGENVECTOR` with `$EIGENVALUE = ... MODE = n`, two lines a
/// grid point. It has no generalised masses.
std::vector<NastranMode> load_punch(const std::filesystem::path& path, const std::set<int>& grids);

/// The same of the binary output (.op2) of PARAM,POST,-1, in single or double words and either byte order: the tables LAMA
/// and OUG (or BOUG, whose motion is in the basic system already). Messages name the byte.
std::vector<NastranMode> load_op2(const std::filesystem::path& path, const std::set<int>& grids);

/// One of these by the ending of the file. Refuses another ending, a file without modes, and a mode without one of the
/// grids.
std::vector<NastranMode> load_modes_of(const std::filesystem::path& path, const std::set<int>& grids);

}  // namespace hotfire::nastran
