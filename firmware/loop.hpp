#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "firmware/cycle_account.hpp"
#include "firmware/state_hash.hpp"
#include "hal/clock.hpp"
#include "hal/plant_bus.hpp"

namespace hotfire::firmware {

/// What follows when a cycle overruns. The schedule keeps its phase in all of them.
/// - `catch_up`: every cycle is run; late ones follow without sleep until the schedule is reached again. The plant's time
///   stays that of the clock.
/// - `skip`: the cycles that are already due are left out and counted. The plant's time falls behind by as many periods.
/// - `stop`: the loop ends.
enum class OverrunPolicy : std::uint8_t { catch_up, skip, stop };
inline constexpr std::array<std::string_view, 3> kOverrunPolicies{"catch-up", "skip", "stop"};

/// Why a loop ended. `not_finite`: a sensor's value was NaN or infinite; that reading is not sent.
enum class Ending : std::uint8_t { completed, asked, overrun, not_finite };
inline constexpr std::array<std::string_view, 4> kEndings{"completed", "asked to stop", "stopped by an overrun",
                                                          "stopped by a value that is not finite"};

inline constexpr std::int64_t kShortestPeriodNs = 250'000;
inline constexpr std::int64_t kLongestPeriodNs = 10'000'000;

struct LoopSettings {
  std::int64_t period_ns = 1'000'000;  ///< from kShortestPeriodNs to kLongestPeriodNs
  std::uint64_t cycles = 0;            ///< after warm-up; 0: until asked to stop
  std::uint64_t warm_up_cycles = 100;  ///< run like the others but counted apart, always with the policy `skip`
  OverrunPolicy policy = OverrunPolicy::catch_up;
};

/// What a loop leaves behind.
struct LoopResult {
  explicit LoopResult(std::int64_t period_ns) noexcept : account(period_ns) {}

  Ending ending = Ending::completed;
  CycleAccount account;  ///< without warm-up
  std::uint64_t warm_up_cycles = 0;
  std::uint64_t warm_up_overruns = 0;
  std::uint64_t skipped = 0;        ///< cycles left out after warm-up
  std::uint64_t held_commands = 0;  ///< cycles, warm-up too, that had no new command and kept the last
  std::uint64_t lost_readings = 0;  ///< readings, warm-up too, that the bus did not take
  StateHash hash;                   ///< over every reading, warm-up too
  hal::Reading last_reading;
};

/// The real-time loop of a plant: at every release of an absolute schedule read the newest command, step the plant, write
/// its reading, account for it. Nothing in it allocates, locks, throws or logs, and its only system calls are those of the
/// clock and the bus. `Plant` has `step(command)` and `measured()`.
///
/// About 200 kB: make it on the heap, before memory is locked.
template <class Plant, hal::PlantBus Bus, hal::Clock Clock>
class Loop {
 public:
  Loop(Plant& plant, Bus& bus, Clock& clock, const LoopSettings& settings) noexcept
      : plant_(plant), bus_(bus), clock_(clock), settings_(settings), result_(settings.period_ns) {}

  /// Runs to its end. `on_warm()` is called once, when the warm-up is over. To be called once.
  template <class OnWarm>
  void run(const std::atomic<bool>& stop, OnWarm&& on_warm) noexcept {
    static_assert(noexcept(on_warm()));
    const std::uint64_t end =
        settings_.cycles == 0 ? std::numeric_limits<std::uint64_t>::max() : settings_.warm_up_cycles + settings_.cycles;
    std::int64_t release = clock_.now_ns() + settings_.period_ns;
    for (std::uint64_t cycle = 0; cycle < end; ++cycle) {
      if (cycle == settings_.warm_up_cycles) {
        on_warm();
      }
      if (stop.load(std::memory_order_relaxed)) {
        result_.ending = Ending::asked;
        return;
      }
      const CycleTimes times = run_cycle(cycle, release);
      const bool warm = cycle >= settings_.warm_up_cycles;
      account(cycle, times, warm);
      if (!finite_) {
        result_.ending = Ending::not_finite;
        return;
      }
      if (warm && settings_.policy == OverrunPolicy::stop && result_.account.overran(times)) {
        result_.ending = Ending::overrun;
        return;
      }
      release = next_release(times, warm);
    }
  }

  const LoopResult& result() const noexcept { return result_; }

 private:
  CycleTimes run_cycle(std::uint64_t cycle, std::int64_t release) noexcept {
    CycleTimes times{};
    times.release = release;
    times.woken = clock_.now_ns();
    times.slept = times.woken < release;
    if (times.slept) {
      clock_.sleep_until_ns(release);
      times.woken = clock_.now_ns();
    }
    result_.held_commands += bus_.try_receive_command(command_) ? 0 : 1;
    times.read = clock_.now_ns();
    plant_.step(command_);
    take_reading(cycle);
    times.stepped = clock_.now_ns();
    if (finite_) {
      result_.lost_readings += bus_.try_send_reading(result_.last_reading) ? 0 : 1;
    }
    times.written = clock_.now_ns();
    return times;
  }

  void take_reading(std::uint64_t cycle) noexcept {
    const std::span<const double> measured = plant_.measured();
    hal::Reading& reading = result_.last_reading;
    std::copy(measured.begin(), measured.end(), reading.values.begin());
    reading.count = measured.size();
    reading.sequence = cycle;
    reading.command_sequence = command_.sequence;
    finite_ = std::all_of(measured.begin(), measured.end(), [](double value) { return std::isfinite(value); });
  }

  void account(std::uint64_t cycle, const CycleTimes& times, bool warm) noexcept {
    result_.hash.add(std::span(result_.last_reading.values).first(result_.last_reading.count));
    if (warm) {
      result_.account.add(cycle, times);
    } else {
      ++result_.warm_up_cycles;
      result_.warm_up_overruns += result_.account.overran(times) ? 1 : 0;
    }
  }

  std::int64_t next_release(const CycleTimes& times, bool warm) noexcept {
    const std::int64_t next = times.release + settings_.period_ns;
    if (times.written <= next || (warm && settings_.policy != OverrunPolicy::skip)) {
      return next;
    }
    const std::int64_t missed = (times.written - next + settings_.period_ns - 1) / settings_.period_ns;
    result_.skipped += warm ? static_cast<std::uint64_t>(missed) : 0;
    return next + missed * settings_.period_ns;
  }

  Plant& plant_;
  Bus& bus_;
  Clock& clock_;
  LoopSettings settings_;
  hal::Command command_;
  bool finite_ = true;
  LoopResult result_;
};

}  // namespace hotfire::firmware
