// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/files/scratch.hpp"

namespace hotfire::test {

/// The hand-made case of tests/nastran/data: one engine, in inches and lbf.s^2/in. The attach points of pitch are 50 in
/// apart along (-0.8, 0, 0.6), those of yaw along (-0.8, -0.6, 0); grid 302 has axes of its own, and the vehicle's attach
/// point of yaw is 2 in beside grid 303. Mode 1 is a rigid body; modes 2 to 5 have 2, 4, 8 and 16 Hz, and mode 3 a
/// generalised mass of 4 in the printed output.
inline constexpr const char* kFourModesMap =
    "schema = 1\nmodes = \"MODES\"\ngeometry = \"GEOMETRY\"\nlength = \"in\"\nmass = \"lbf.s^2/in\"\ndamping = 0.01\n"
    "[attach.pitch1]\nengine = 202\nvehicle = 201\n[attach.yaw1]\nengine = 302\nvehicle = {grid = 303, at = [30, 40, 0]}\n"
    "[gimbal.engine1]\nengine = 102\nvehicle = 101\n";

inline std::filesystem::path four_modes(const std::string& ending) {
  return std::filesystem::path(HOTFIRE_SOURCE_DIR) / "tests/nastran/data" / ("four_modes." + ending);
}

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// Writes the map for files of these names, all beside each other.
inline std::filesystem::path write_map(const Scratch& scratch, const std::string& modes, const std::string& geometry,
                                       const std::string& further = "") {
  return scratch.write("map.toml", replaced(replaced(replaced(kFourModesMap, "MODES", modes), "GEOMETRY", geometry),
                                            "[attach.pitch1]", further + "[attach.pitch1]"));
}

/// The table by hand, in the model's units and normalised to mass: rows attach.pitch1, attach.yaw1, gimbal.pitch1,
/// gimbal.yaw1; columns modes 2 to 5. As an example attach.pitch1 of mode 2: grid 201 moves by (0.5, 0, 0), grid 202 by
/// (0, 0, 0.5), and (-0.8, 0, 0.6) . (0.5, 0, -0.5) = -0.7.
inline Eigen::Matrix4d four_modes_by_hand() {
  Eigen::Matrix4d shape;
  shape << -0.7, 0.6, 0.8, 0.0,  //
      -0.16, -0.8, -0.6, 1.6,    //
      -0.02, 0.04, 0.0, -0.2,    //
      0.03, 0.0, -0.5, 0.0;
  return shape;
}

}  // namespace hotfire::test
