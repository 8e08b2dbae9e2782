// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "firmware/lab/lab.hpp"
#include "firmware/lab/lab_lines.hpp"

namespace hotfire::firmware {

inline constexpr std::string_view kLabTopology = "lab";

/// A lab, or why there is none: file, line, key, value and what is allowed.
struct LabImage {
  std::optional<LabSettings> settings;
  LabLines lines{};
  std::string error{};
  std::string text{};  ///< the image itself
};

/// Reads what `hotfire lab` makes of a profile file, lines `key value` in SI as those of a plant image:
///
///     schema 1
///     topology lab
///     actuators 1
///     piston_per_command 0x1.3p-2
///     limits.reading_age 0x1.4p-7
///     line.arm arm
///     segment.0.duration 0x1p+2
///     segment.0.from 0x0p+0
///
/// Every key is there but for lines that are not wired, limits.load_pressure [Pa], without which load pressures are not
/// measured, and limits.reading_period [s], or `sync`, without which a node sends each message once in a period; segments
/// count from 0. What a segment asks for, and a limit of an actuator, is a list with a number for each actuator, commas
/// between them. As strict as a plant image. `period` in s.
LabImage parse_lab_image(const std::string& text, const std::string& name, double period);

}  // namespace hotfire::firmware
