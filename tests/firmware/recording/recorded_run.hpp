// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdio>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "firmware/loop/loop.hpp"
#include "firmware/plant/plant.hpp"
#include "firmware/recording/recorder.hpp"
#include "firmware/session/options.hpp"
#include "firmware/session/recording_session.hpp"
#include "hal/sim/manual_clock.hpp"
#include "hal/sim/plant_bus.hpp"

namespace hotfire::test {

/// Keeps what is appended in memory. Whoever holds `gate` stalls it, as a disk does; `refuse_after` makes it full.
class MemorySink final : public hal::RecordingSink {
 public:
  std::optional<hal::SinkRefusal> append(std::span<const std::byte> head, std::span<const std::byte> content) override {
    const std::lock_guard guard(gate);
    if (bytes.size() + head.size() + content.size() > refuse_after) {
      return hal::SinkRefusal{"the disk is full"};
    }
    bytes.append(reinterpret_cast<const char*>(head.data()), head.size());
    bytes.append(reinterpret_cast<const char*>(content.data()), content.size());
    return std::nullopt;
  }
  std::optional<hal::SinkRefusal> sync() override {
    return syncs_refused.load() ? std::optional(hal::SinkRefusal{"not safe"}) : std::nullopt;
  }

  std::mutex gate;
  std::string bytes;
  std::size_t refuse_after = std::string::npos;
  std::atomic<bool> syncs_refused{false};
};

inline const std::string kBenchImage = "schema 1\ntopology direct\nmass.inertia 96\nmass.damping 200\nmass.stiffness 1e4\n";

/// Options of a plant recorded to a file.
inline firmware::PlantOptions recorded_options(const std::string& path, std::uint64_t cycles, std::size_t actuators = 1) {
  firmware::PlantOptions options;
  options.recording = path;
  options.actuators = actuators;
  options.loop.cycles = cycles;
  options.loop.warm_up_cycles = 10;
  options.source.amplitude = 5.0;
  options.source.frequency = 7.0;
  options.command_line = "test";
  return options;
}

/// Runs a plant on a manual clock and records it to a file, as the program does.
template <class Model>
firmware::RecorderAccount record_run(const firmware::PlantOptions& options, const typename Model::Parameters& parameters,
                                     const std::string& image, const std::vector<firmware::PlayedFault>& faults = {}) {
  const double period = static_cast<double>(options.loop.period_ns) * 1e-9;
  using Plant = firmware::Plant<Model>;
  using Bus = firmware::PlayedBus<hal::sim::SimulatedPlantBus>;
  Plant plant(parameters, period, options.actuators, faults);
  hal::sim::SimulatedPlantBus wire(options.source, period);
  Bus bus(wire, faults, period);
  hal::sim::ManualClock clock;
  firmware::RecordingSession recording(options, firmware::RecordedPlant::of(plant, image));
  if (const auto failure = recording.start()) {
    return {0, 0, failure->what};
  }
  using Pace = firmware::OwnPace<hal::sim::ManualClock>;
  const auto loop = std::make_unique<firmware::Loop<Plant, Bus, hal::sim::ManualClock, Pace, firmware::Recorder>>(
      plant, bus, clock, options.loop, Pace(clock, options.loop.period_ns), &recording.recorder());
  loop->run(false, []() noexcept {});
  return recording.close();
}

/// The bench mass of `kBenchImage`.
inline model::Direct<double>::Parameters bench_parameters() {
  model::Direct<double>::Parameters parameters;
  parameters.mass.inertia = 96.0;
  parameters.mass.damping = 200.0;
  parameters.mass.stiffness = 1e4;
  return parameters;
}

inline firmware::RecorderAccount record_bench(const firmware::PlantOptions& options) {
  return record_run<model::Direct<double>>(options, bench_parameters(), kBenchImage);
}

}  // namespace hotfire::test
