// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "hal/plant_bus.hpp"
#include "hal/recording/fnv1a.hpp"
#include "hal/sim/command_source.hpp"

namespace hotfire::firmware {

/// A controller to test a plant without any other: it commands every actuator by one source, one command a period of its own
/// count. For the loop it is a plant. Its input is the position of the pistons, and its reading is the command [rad].
class ReferenceController {
 public:
  static constexpr std::string_view topology = "reference controller";
  static constexpr std::array<std::string_view, 1> channels{"command"};
  static constexpr std::array<std::string_view, 1> channel_units{"rad"};

  /// `period` in s.
  ReferenceController(const hal::sim::CommandSource& source, double period, std::size_t actuators) noexcept
      : source_(source), period_(period), actuators_(actuators) {}

  void step(const hal::Command&) noexcept { commands_.fill(source_.at(static_cast<double>(cycle_++) * period_)); }

  std::size_t actuators() const noexcept { return actuators_; }
  std::span<const double> measured() const noexcept { return std::span(commands_).first(actuators_); }
  static constexpr std::uint32_t missing() noexcept { return 0; }
  void add_to(hal::Fnv1a& hash) const noexcept { hash.add(measured()); }

 private:
  hal::sim::CommandSource source_;
  double period_;
  std::size_t actuators_;
  std::uint64_t cycle_ = 0;
  std::array<double, hal::kMaxActuators> commands_{};
};

}  // namespace hotfire::firmware
