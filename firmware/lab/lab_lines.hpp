// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "hal/gpio.hpp"

namespace hotfire::firmware {

/// Names of the GPIO lines of a lab. An empty one is not wired.
struct LabLines {
  std::string emergency_stop;    ///< input: on while it is released, so that a broken wire is a stop
  std::string hydraulic_enable;  ///< input: on while the hydraulic supply may be used
  std::string arm;               ///< input: a person's button
  std::string start;             ///< input: another one; without it the arm button is held to start
  std::string supply_read_back;  ///< input: on while the supply is on
  std::string fault_read_back;   ///< input: on while the fault line is on
  std::string supply;            ///< output: on while anything is driven
  std::string heartbeat;         ///< output: changes every cycle
  std::string fault;             ///< output: on while faulted
};

enum LabInput : std::uint8_t {
  kEmergencyStopReleased,
  kHydraulicEnabled,
  kArm,
  kStart,
  kSupplyReadBack,
  kFaultReadBack,
  kLabInputs
};
enum LabOutput : std::uint8_t { kSupply, kHeartbeat, kFault };

/// The lines as requested from a chip, and the place of each input of the lab among them.
struct LabGpio {
  static constexpr std::uint8_t kNotWired = hal::kMaxGpioLines;

  hal::GpioSettings settings;
  std::array<std::uint8_t, kLabInputs> places{};

  bool is_wired(LabInput input) const noexcept { return places[input] != kNotWired; }
};

/// A broken wire of an input reads off: a stop, no enable, a button that is not pressed. Stop, enable and the buttons report
/// their edges, so that a change between two cycles is detected.
inline LabGpio lab_gpio(const LabLines& lines, const std::string& chip) {
  LabGpio gpio;
  gpio.settings.chip = chip;
  gpio.settings.bias = hal::GpioBias::pull_down;
  gpio.settings.outputs = {{lines.supply}, {lines.heartbeat}, {lines.fault}};
  const std::array<const std::string*, kLabInputs> names{
      &lines.emergency_stop, &lines.hydraulic_enable, &lines.arm,
      &lines.start,          &lines.supply_read_back, &lines.fault_read_back};
  for (std::size_t i = 0; i < names.size(); ++i) {
    gpio.places[i] = LabGpio::kNotWired;
    if (!names[i]->empty()) {
      gpio.places[i] = static_cast<std::uint8_t>(gpio.settings.inputs.size());
      gpio.settings.inputs.push_back({*names[i], false, i <= kStart});
    }
  }
  return gpio;
}

}  // namespace hotfire::firmware
