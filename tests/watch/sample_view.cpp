// SPDX-License-Identifier: Apache-2.0
// Shows five actuators with ten values each, as a lab at 1 kHz shows them: sample_view FILE SECONDS [FAULT]
// With a fault, the interlock runs for a second and then is faulted by it.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "firmware/interlock/interlock.hpp"
#include "firmware/lab/lab_image.hpp"
#include "firmware/lab/lab_recorder.hpp"
#include "firmware/session/live_session.hpp"
#include "hal/linux/posix_clock.hpp"

namespace hotfire::firmware {
namespace {

constexpr std::size_t kActuators = 5;

std::uint64_t flags_of(std::int64_t time_ns, int fault) {
  const bool is_faulted = fault != 0 && time_ns > 1'000'000'000;
  const RigState state = is_faulted ? RigState::faulted : RigState::running;
  return hal::CycleHead::lab_flags(static_cast<std::uint64_t>(state), is_faulted ? static_cast<std::uint64_t>(fault) : 0) |
         hal::CycleHead::kSlept;
}

int show(const char* path, double seconds, int fault) {
  RunOptions options;
  options.live_view = path;
  options.actuators = kActuators;
  RecordedPlant plant;
  plant.topology = kLabTopology;
  plant.input = {"command", "rad"};
  plant.channels = lab_channels(true);
  plant.start.assign(kActuators * plant.channels.size(), 0.0);
  const auto result = std::make_unique<LoopResult>(options.loop.period_ns);
  std::uint64_t faulted = 0;
  LiveCounters counters;
  counters.faults([&](Fault each) { return static_cast<int>(each) == fault ? faulted : 0; });
  CycleOutputs outputs;
  LiveSession live(options);
  if (const auto refused = live.start(plant, counters, *result, outputs)) {
    std::fprintf(stderr, "sample_view: %s\n", refused->what.c_str());
    return 2;
  }
  const hal::PosixClock clock;
  const std::int64_t start = clock.now_ns();
  std::vector<double> commands(kActuators);
  std::vector<double> readings(plant.start.size());
  for (std::uint64_t cycle = 0;; ++cycle) {
    const std::int64_t time = static_cast<std::int64_t>(cycle) * options.loop.period_ns;
    if (static_cast<double>(time) > seconds * 1e9) {
      break;
    }
    clock.sleep_until_ns(start + time);
    const std::int64_t now = clock.now_ns();
    for (std::size_t i = 0; i < readings.size(); ++i) {
      readings[i] = std::sin(static_cast<double>(time) * 1e-9 * (1.0 + static_cast<double>(i)));
    }
    faulted = fault != 0 && time > 1'000'000'000 ? 1 : 0;
    outputs.record({cycle, start + time, now, now, now + 2000, now + 3000, 0, 0, flags_of(time, fault)}, commands, readings);
  }
  live.close(Ending::completed);
  return 0;
}

}  // namespace
}  // namespace hotfire::firmware

int main(int count, char** values) {
  if (count < 3) {
    std::fputs("usage: sample_view FILE SECONDS [FAULT]\n", stderr);
    return 2;
  }
  return hotfire::firmware::show(values[1], std::strtod(values[2], nullptr),
                                 count > 3 ? static_cast<int>(std::strtol(values[3], nullptr, 10)) : 0);
}
