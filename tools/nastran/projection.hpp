// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/structure/mode_table.hpp"

namespace hotfire::nastran {

/// What a projection did beside the table.
struct Projection {
  ModeSet modes;
  int left_out = 0;                ///< modes at or below the least frequency: rigid bodies, and engines on their gimbals
  std::vector<std::string> lines;  ///< for a reader: each line and axis, with grid points and length
};

/// Reads a map (TOML) and what it names, and projects Nastran's eigenvectors onto the lines of the actuators and the axes of
/// the gimbals:
///   schema = 1
///   modes = "modes.f06"                 # or .pch, .op2, beside this file
///   geometry = "vehicle.bdf"            # or a file with its echo; left out: the file of the modes
///   length = "in"                       # units of the model; left out: m, kg
///   mass = "lbf.s^2/in"
///   least_frequency = "0.1 Hz"          # modes at or below it are left out
///   damping = 0.01                      # of every mode, or a list in their order
///   generalised_mass = 1.0              # for a file that has none
///   [attach.pitch1]                     # pitch, yaw of engines 1, 2 ...
///   engine = 2001                       # grid point, or {grid = 2001, at = [x, y, z]}, rigid from there to the point
///   vehicle = {at = [x, y, z]}          # or the grid point nearest to a place
///   [gimbal.engine1]
///   engine = 3001
///   vehicle = 3002
///   pitch_axis = [0, 1, 0]              # in the basic system; left out: y, z
///   yaw_axis = [0, 0, 1]
///   [strings.string1.engine1]           # of all engines, or none
///   engine = 4001
///   vehicle = 4002
///
/// The shape of an attach point is n (u_vehicle - u_engine), n the direction from vehicle to engine: how far the mode pulls
/// the two points towards each other. That of a gimbal is a (r_vehicle - r_engine), a its axis. u and r are Nastran's
/// translations and rotations, turned into the basic system, over the root of the generalised mass, in SI.
///
/// Throws FileError naming file, line, key, value and what is allowed: what the readers of the files refuse, a key that is
/// missing or unknown, engines that are not counted from 1, a grid point that is not there, points of a line that coincide,
/// a unit of another dimension, no mode above the least frequency.
Projection project(const std::filesystem::path& map);

}  // namespace hotfire::nastran
