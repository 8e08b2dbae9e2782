// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "firmware/loop/cycle_account.hpp"
#include "firmware/loop/pace.hpp"
#include "hal/clock.hpp"
#include "hal/plant_bus.hpp"
#include "hal/recording/format.hpp"

namespace hotfire::firmware {

/// Reaction to an overrun. The schedule keeps its phase in every case.
/// - `catch_up`: every cycle runs; late ones follow without sleep until the schedule is reached again. The plant's time
///   stays equal to the clock.
/// - `skip`: the cycles that are already due are left out and counted. The plant's time falls behind by as many periods.
/// - `stop`: the loop ends.
enum class OverrunPolicy : std::uint8_t { catch_up, skip, stop };
inline constexpr std::array<std::string_view, 3> kOverrunPolicies{"catch-up", "skip", "stop"};

/// Cause of the end of a loop. `not_finite`: a sensor's value was NaN or infinite; that reading is not sent. `sync_lost`:
/// the syncs of its cycles have stopped.
enum class Ending : std::uint8_t { completed, asked, overrun, not_finite, sync_lost };
inline constexpr std::array<std::string_view, 5> kEndings{"completed", "asked to stop", "stopped by an overrun",
                                                          "stopped by a value that is not finite",
                                                          "stopped because the sync was lost"};

/// 20 kHz: the overhead of a cycle beside the model, some microseconds, is then a tenth of it.
inline constexpr std::int64_t kShortestPeriodNs = 50'000;
inline constexpr std::int64_t kLongestPeriodNs = 10'000'000;

struct LoopSettings {
  std::int64_t period_ns = 1'000'000;  ///< from kShortestPeriodNs to kLongestPeriodNs
  std::uint64_t cycles = 0;            ///< after warm-up; 0: until asked to stop
  std::uint64_t warm_up_cycles = 100;  ///< run like the others but counted apart, always with the policy `skip`
  OverrunPolicy policy = OverrunPolicy::catch_up;
  /// True: the number of a cycle counts the skipped cycles before it, because the driven rig continues without them. False:
  /// it counts the cycles that ran, like the time of a plant that only a cycle advances.
  bool number_skipped = false;
};

/// The result of a loop.
struct LoopResult {
  explicit LoopResult(std::int64_t period_ns) noexcept : account(period_ns) {}

  Ending ending = Ending::completed;
  CycleAccount account;  ///< without warm-up
  std::uint64_t warm_up_cycles = 0;
  std::uint64_t warm_up_overruns = 0;
  std::uint64_t skipped = 0;        ///< cycles left out after warm-up
  std::uint64_t held_commands = 0;  ///< cycles, warm-up too, that had no new command and kept the last
  std::uint64_t lost_readings = 0;  ///< readings, warm-up too, that the bus did not take
  std::uint64_t missed_syncs = 0;   ///< cycles, warm-up too, run without the sync they are locked to
  hal::Fnv1a hash;                  ///< over the state and the readings of every cycle, warm-up too
  hal::Reading last_reading;
};

/// The outputs of a loop's cycles: called once a cycle, after its reading is sent. Real-time.
template <class R>
concept CycleRecorder = requires(R& recorder, const hal::CycleHead& head, std::span<const double> values) {
  { recorder.record(head, values, values) }
  noexcept;
};

/// Keeps nothing.
struct NoRecorder {
  void record(const hal::CycleHead&, std::span<const double>, std::span<const double>) noexcept {}
};

/// The real-time loop of a plant. In every cycle of its pace it reads the newest command, steps the plant, writes its
/// reading and accounts for the cycle. It does not allocate, lock, throw or log. Its only system calls are those of the pace
/// and the bus. `Plant` has `step(command)`, `measured()`, `missing()`, `add_to(hash)` and `actuators()`. If a bus has
/// `note_overrun()`, it is called after every cycle that overran.
///
/// The loop increments a heartbeat in every turn, also while it waits for a first cycle. A monitor in another thread may
/// read it.
///
/// Its size is about 200 kB: make it on the heap, before memory is locked.
template <class Plant, hal::PlantBus Bus, hal::Clock Clock, class Pace = OwnPace<Clock>, CycleRecorder Recorder = NoRecorder>
class Loop {
 public:
  /// `recorder` null: nothing is recorded.
  Loop(Plant& plant, Bus& bus, Clock& clock, const LoopSettings& settings, Pace pace, Recorder* recorder) noexcept
      : plant_(plant),
        bus_(bus),
        clock_(clock),
        settings_(settings),
        pace_(pace),
        recorder_(recorder),
        result_(settings.period_ns) {}

  /// The cycles of the loop's own clock, not recorded.
  Loop(Plant& plant, Bus& bus, Clock& clock, const LoopSettings& settings) noexcept
      : Loop(plant, bus, clock, settings, Pace(clock, settings.period_ns), nullptr) {}

  /// Runs to its end. `on_warm()` is called once, when the warm-up is over. To be called once.
  template <class OnWarm>
  void run(const std::atomic<bool>& stop, OnWarm&& on_warm) noexcept {
    static_assert(noexcept(on_warm()));
    const std::uint64_t end =
        settings_.cycles == 0 ? std::numeric_limits<std::uint64_t>::max() : settings_.warm_up_cycles + settings_.cycles;
    for (std::uint64_t cycle = 0; cycle < end;) {
      if (stop.load(std::memory_order_relaxed)) {
        result_.ending = Ending::asked;
        return;
      }
      if (cycle >= settings_.warm_up_cycles && !warm_) {
        warm_ = true;
        on_warm();
      }
      Wake wake;
      heartbeat_.store(heartbeat_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      if (!pace_.wait(wake)) {
        continue;
      }
      const CycleTimes times = run_cycle(cycle, wake);
      ++cycle;
      if (ended(times)) {
        return;
      }
      skipped_ = 0;
      if (!warm_ || settings_.policy == OverrunPolicy::skip) {
        const std::uint64_t dropped = result_.account.overran(times) ? pace_.drop_overdue(times.written) : 0;
        result_.skipped += warm_ ? dropped : 0;
        skipped_ = settings_.number_skipped ? dropped : 0;
        cycle += skipped_;
      }
    }
  }

  const LoopResult& result() const noexcept { return result_; }

  /// Turns so far. From any thread.
  const std::atomic<std::uint64_t>& heartbeat() const noexcept { return heartbeat_; }

 private:
  CycleTimes run_cycle(std::uint64_t cycle, const Wake& wake) noexcept {
    CycleTimes times{wake.release_ns, wake.woken_ns, 0, 0, 0, 0, wake.slept};
    const bool held = !bus_.try_receive_command(command_);
    times.read = clock_.now_ns();
    plant_.step(command_);
    take_reading(cycle);
    times.stepped = clock_.now_ns();
    const bool lost = finite_ && !bus_.try_send_reading(result_.last_reading);
    times.written = clock_.now_ns();
    result_.held_commands += held ? 1 : 0;
    result_.lost_readings += lost ? 1 : 0;
    result_.missed_syncs = pace_.missed_syncs();
    plant_.add_to(result_.hash);
    record(cycle, times, held, lost);
    times.accounted = clock_.now_ns();
    const bool overran = result_.account.overran(times);
    if constexpr (requires { bus_.note_overrun(); }) {
      if (overran) {
        bus_.note_overrun();
      }
    }
    if (warm_) {
      result_.account.add(cycle, times);
    } else {
      ++result_.warm_up_cycles;
      result_.warm_up_overruns += overran ? 1 : 0;
    }
    return times;
  }

  void take_reading(std::uint64_t cycle) noexcept {
    const std::span<const double> measured = plant_.measured();
    hal::Reading& reading = result_.last_reading;
    std::copy(measured.begin(), measured.end(), reading.values.begin());
    reading.count = measured.size();
    reading.missing = plant_.missing();
    if constexpr (requires { plant_.strings(); }) {
      std::copy(plant_.strings().begin(), plant_.strings().end(), reading.strings.begin());
      reading.string_count = plant_.strings().size();
    }
    reading.sequence = cycle;
    reading.command_sequence = command_.sequence;
    finite_ = std::all_of(measured.begin(), measured.end(), [](double value) { return std::isfinite(value); });
  }

  void record(std::uint64_t cycle, const CycleTimes& times, bool held, bool lost) noexcept {
    if (recorder_ == nullptr) {
      return;
    }
    using Head = hal::CycleHead;
    Head head{cycle,         times.release, times.woken,       times.read,
              times.stepped, times.written, command_.sequence, result_.hash.value()};
    head.flags =
        (held ? Head::kHeld : 0) | (times.slept ? Head::kSlept : 0) | (lost ? Head::kLost : 0) | (warm_ ? 0 : Head::kWarmUp);
    head.flags |= std::min(skipped_, Head::kMostSkipped) << Head::kSkippedShift;
    recorder_->record(head, std::span(command_.values).first(plant_.actuators()),
                      std::span(result_.last_reading.values).first(result_.last_reading.count));
  }

  /// Whether this cycle was the last one for another reason than the number of cycles.
  bool ended(const CycleTimes& times) noexcept {
    if (!finite_) {
      result_.ending = Ending::not_finite;
    } else if (pace_.lost()) {
      result_.ending = Ending::sync_lost;
    } else if (warm_ && settings_.policy == OverrunPolicy::stop && result_.account.overran(times)) {
      result_.ending = Ending::overrun;
    }
    return result_.ending != Ending::completed;
  }

  Plant& plant_;
  Bus& bus_;
  Clock& clock_;
  LoopSettings settings_;
  Pace pace_;
  Recorder* recorder_;
  hal::Command command_;
  bool finite_ = true;
  bool warm_ = false;
  std::uint64_t skipped_ = 0;  ///< cycles that the number of the next one counts and that were not run
  std::atomic<std::uint64_t> heartbeat_{0};
  LoopResult result_;
};

}  // namespace hotfire::firmware
