// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>

namespace hotfire::nastran {

/// A grid point: where it is in the basic system, and the axes in which Nastran prints its motion.
struct Grid {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();     ///< in the length unit of the model
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns are the grid's own axes in the basic system
};

/// Reads GRID and CORD2R entries: from a bulk data file (.bdf, .dat, .nas), the echo of it in the printed output (.f06) or
/// in the punch file (.pch). Entries have small, large or free fields. Coordinate systems are rectangular (CORD2R, also one
/// upon another). Throws FileError with file and line: an entry that is cut or has a value that is not a number, a
/// coordinate system that is missing, defined through itself, or of another kind, a grid point that is given twice, a file
/// without any.
std::map<int, Grid> load_geometry(const std::filesystem::path& path);

}  // namespace hotfire::nastran
