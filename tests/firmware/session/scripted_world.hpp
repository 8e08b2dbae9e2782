// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>

#include "firmware/loop/loop.hpp"
#include "hal/sim/manual_clock.hpp"

namespace hotfire::test {

/// A plant and a bus on one manual clock, whose phases take as long as a test says: 10 us each, or what is injected for a
/// cycle.
class ScriptedWorld {
 public:
  static constexpr std::int64_t kPeriodNs = 1'000'000;
  static constexpr std::int64_t kPhaseNs = 10'000;

  struct Delays {
    std::int64_t wake_up_ns = 0;
    std::int64_t read_ns = kPhaseNs;
    std::int64_t step_ns = kPhaseNs;
    std::int64_t write_ns = kPhaseNs;
  };

  hal::sim::ManualClock clock;
  std::map<std::uint64_t, Delays> delays;  ///< by cycle
  std::uint64_t cycle = 0;
  std::uint64_t sent = 0;
  double measured = 0.0;

  Delays now() const {
    const auto found = delays.find(cycle);
    return found == delays.end() ? Delays{} : found->second;
  }

  /// Makes the next sleep late if the next cycle's script says so.
  void prepare_wake_up() { clock.delay_next_wake_up_ns(now().wake_up_ns); }
};

class ScriptedBus {
 public:
  explicit ScriptedBus(ScriptedWorld& world) : world_(world) { world_.prepare_wake_up(); }

  bool try_receive_command(hal::Command&) noexcept {
    world_.clock.advance_ns(world_.now().read_ns);
    return world_.cycle % 2 == 0;
  }

  bool try_send_reading(const hal::Reading&) noexcept {
    world_.clock.advance_ns(world_.now().write_ns);
    ++world_.cycle;
    ++world_.sent;
    world_.prepare_wake_up();
    return world_.sent % 5 != 0;
  }

 private:
  ScriptedWorld& world_;
};

class ScriptedPlant {
 public:
  explicit ScriptedPlant(ScriptedWorld& world) : world_(world) {}

  void step(const hal::Command&) noexcept { world_.clock.advance_ns(world_.now().step_ns); }
  std::span<const double> measured() const noexcept { return {&world_.measured, 1}; }
  void add_to(hal::Fnv1a& hash) const noexcept { hash.add(measured()); }
  static constexpr std::uint32_t missing() noexcept { return 0; }
  static constexpr std::size_t actuators() noexcept { return 1; }

 private:
  ScriptedWorld& world_;
};

/// Runs a loop in the scripted world and returns what it left behind.
inline firmware::LoopResult run_scripted(ScriptedWorld& world, const firmware::LoopSettings& settings,
                                         const std::atomic<bool>& stop = false) {
  ScriptedPlant plant(world);
  ScriptedBus bus(world);
  firmware::Loop loop(plant, bus, world.clock, settings);
  loop.run(stop, []() noexcept {});
  return loop.result();
}

}  // namespace hotfire::test
