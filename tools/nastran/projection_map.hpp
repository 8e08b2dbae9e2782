// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/files/text/toml_source.hpp"

namespace hotfire::nastran {

/// A point of a map: a grid point, a place, or a place that moves rigidly with a grid point.
struct MapPoint {
  std::optional<int> grid;
  std::optional<Eigen::Vector3d> place;  ///< in the length unit of the model, basic system
  const toml::node* node = nullptr;      ///< for messages
  std::string key;
};

/// Two points whose approach is wanted: attach points of an actuator, ends of a string.
struct MapLine {
  std::string name;  ///< of the column: attach.pitch1
  MapPoint engine;
  MapPoint vehicle;
};

/// A gimbal and its two axes.
struct MapGimbal {
  int engine_number = 1;
  MapPoint engine;
  MapPoint vehicle;
  Eigen::Vector3d pitch_axis = Eigen::Vector3d::UnitY();
  Eigen::Vector3d yaw_axis = Eigen::Vector3d::UnitZ();
};

/// A map as its file gives it; projection.hpp describes the keys.
struct ProjectionMap {
  std::filesystem::path modes;
  std::filesystem::path geometry;
  double length = 1.0;           ///< length unit of the model [m]
  double mass = 1.0;             ///< mass unit of the model [kg]
  double least_frequency = 0.0;  ///< [Hz]
  std::vector<double> damping;   ///< one for all, or one a mode
  std::optional<double> generalised_mass;
  int engines = 0;
  std::vector<MapLine> lines;  ///< in the order of port_names
  std::vector<MapGimbal> gimbals;
  std::vector<MapLine> strings;  ///< in the order of string_names; empty: none
};

/// Throws FileError naming file, line, key, value and what is allowed.
ProjectionMap read_projection_map(const TomlSource& source, const std::filesystem::path& folder);

}  // namespace hotfire::nastran
