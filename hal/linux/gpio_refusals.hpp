// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "hal/failure.hpp"
#include "hal/gpio.hpp"

namespace hotfire::hal {

/// Possible places of a chip with this path, name or label: the path itself, or every chip of the machine.
inline std::vector<std::string> places_of_chip(const std::string& chip) {
  if (chip.starts_with('/')) {
    return {chip};
  }
  std::vector<std::string> places;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored)) {
    if (entry.path().filename().string().starts_with("gpiochip")) {
      places.push_back(entry.path().string());
    }
  }
  return places;
}

/// Too many lines, or none.
inline std::optional<Failure> refuse_line_count(const GpioSettings& settings) {
  const std::size_t inputs = settings.inputs.size();
  const std::size_t outputs = settings.outputs.size();
  if (inputs > kMaxGpioLines || outputs > kMaxGpioLines || inputs + outputs == 0) {
    return Failure{std::to_string(inputs) + " inputs and " + std::to_string(outputs) + " outputs",
                   "allowed: up to " + std::to_string(kMaxGpioLines) + " of each, and at least one line"};
  }
  return std::nullopt;
}

inline Failure no_chip(const std::string& chip, int error) {
  return {"no GPIO chip " + chip + " that can be opened: " + std::strerror(error),
          "see 'gpiodetect' for path, name and label; who may use it: 'ls -l /dev/gpiochip*'"};
}

inline Failure no_line(const std::string& chip, const std::string& line) {
  return {"GPIO chip " + chip + " has no line " + line, "see 'gpioinfo " + chip + "' for the names of its lines"};
}

inline Failure not_requested(const std::string& chip, const char* which, int error) {
  return {std::string("the ") + which + " of GPIO chip " + chip + " are refused: " + std::strerror(error),
          "see 'gpioinfo " + chip + "' for who holds them, and end that program"};
}

}  // namespace hotfire::hal
