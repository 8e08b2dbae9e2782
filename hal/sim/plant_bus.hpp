// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/plant_bus.hpp"
#include "hal/sim/command_source.hpp"

namespace hotfire::hal::sim {

/// The bus without a wire (`hal::PlantBus`). A reference source commands every actuator in the same way, one command a
/// period of its own count. The commands of the plant therefore do not depend on the machine's timing. Keeps the newest
/// reading.
class SimulatedPlantBus {
 public:
  SimulatedPlantBus(const CommandSource& source, double period) noexcept : source_(source), period_(period) {}

  bool try_receive_command(Command& command) noexcept {
    command.values.fill(source_.at(static_cast<double>(sequence_) * period_));
    command.sequence = sequence_++;
    return true;
  }

  bool try_send_reading(const Reading& reading) noexcept {
    newest_ = reading;
    return true;
  }

  const Reading& newest_reading() const noexcept { return newest_; }

 private:
  CommandSource source_;
  double period_;
  std::uint64_t sequence_ = 0;
  Reading newest_;
};

static_assert(PlantBus<SimulatedPlantBus>);

}  // namespace hotfire::hal::sim
