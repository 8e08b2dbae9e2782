// SPDX-License-Identifier: Apache-2.0
// A loop of eight actuators at 4 kHz, whose recorder's disk stalls every other stretch of one and the same run:
//   recorder_stall [SECONDS OF A STRETCH [STRETCHES]]
// Compares the loop's step times and the cost of recording with the disk stalled and not, and counts the drops again in the
// file. Exit 1 if the medians differ by more than `kMostRatio` in every pair of stretches, or a single cycle is unaccounted
// for.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include "firmware/plant/reference_plant.hpp"
#include "hal/arithmetic/denormals.hpp"
#include "hal/linux/posix_clock.hpp"
#include "hal/recording/reader.hpp"
#include "tests/firmware/recording/recorded_run.hpp"

namespace hotfire {
namespace {

using Simplex = model::Simplex<double>;

constexpr double kMostRatio = 1.2;
constexpr std::int64_t kPeriodNs = 250'000;
constexpr std::size_t kActuators = 8;
constexpr std::size_t kReadings = kActuators * Simplex::channels.size();

/// A file whose disk stalls while it is told to.
class StallingFile final : public hal::RecordingSink {
 public:
  explicit StallingFile(hal::RecordingFile& file) : file_(file) {}

  std::optional<hal::SinkRefusal> append(std::span<const std::byte> head, std::span<const std::byte> content) override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !stalled_; });
    return file_.append(head, content);
  }
  std::optional<hal::SinkRefusal> sync() override { return file_.sync(); }

  void stall(bool stalled) {
    {
      const std::lock_guard guard(mutex_);
      stalled_ = stalled;
    }
    changed_.notify_all();
  }

 private:
  hal::RecordingFile& file_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stalled_ = false;
};

/// Hands cycles on to the recorder, and keeps what they and the handing on cost, with the disk stalled and not.
class MeasuredRecorder {
 public:
  MeasuredRecorder(firmware::Recorder& recorder, std::size_t count)
      : pairs(count, pair_of_histograms()), recorder_(recorder) {}

  void record(const hal::CycleHead& head, std::span<const double> commands, std::span<const double> readings) noexcept {
    const std::int64_t before = clock_.now_ns();
    recorder_.record(head, commands, readings);
    const std::int64_t after = clock_.now_ns();
    const std::size_t kind = stalled.load(std::memory_order_relaxed) ? 1 : 0;
    steps[kind].add(head.stepped_ns - head.read_ns);
    pairs[pair.load(std::memory_order_relaxed)][kind].add(head.stepped_ns - head.read_ns);
    costs[kind].add(after - before);
  }

  using PairOfHistograms = std::array<firmware::Histogram, 2>;
  static PairOfHistograms pair_of_histograms() { return {firmware::Histogram(10), firmware::Histogram(10)}; }

  std::atomic<bool> stalled{false};
  std::atomic<std::size_t> pair{0};  ///< of a stretch with the disk running, and one with it stalled
  PairOfHistograms steps = pair_of_histograms();
  PairOfHistograms costs = pair_of_histograms();
  std::vector<PairOfHistograms> pairs;  ///< steps by pair

 private:
  firmware::Recorder& recorder_;
  hal::PosixClock clock_;
};

/// Median of the second of two over that of the first.
double ratio_of_medians(const MeasuredRecorder::PairOfHistograms& times) {
  return static_cast<double>(times[1].quantile_ns(0.5)) / static_cast<double>(times[0].quantile_ns(0.5));
}

void print(const char* what, const MeasuredRecorder::PairOfHistograms& times) {
  for (std::size_t kind = 0; kind < 2; ++kind) {
    const auto at = [&](double share) { return static_cast<double>(times[kind].quantile_ns(share)) * 1e-3; };
    std::printf("  %-10s disk %-7s %8llu cycles   median %.2f   90 %% %.2f   99 %% %.2f   99.9 %% %.2f us\n", what,
                kind == 0 ? "running" : "stalled", static_cast<unsigned long long>(times[kind].count()), at(0.5), at(0.9),
                at(0.99), at(0.999));
  }
}

/// The header of a recording that is only counted, not replayed.
std::string header() {
  hal::RecordingHeader header;
  header.period_ns = kPeriodNs;
  header.actuators = kActuators;
  header.input = {"command", "rad"};
  header.channels = {{"piston", "m"}, {"engine", "rad"}, {"load_pressure", "Pa"}};
  header.start.assign(kReadings, 0.0);
  return hal::header_text(header);
}

int run(double seconds, int stretches) {
  const hal::FlushDenormals flush;
  const std::string path = std::filesystem::temp_directory_path() / ("hotfire-stall-" + std::to_string(getpid()) + ".hfr");
  hal::RecordingFile file(path, std::uint64_t{1} << 32);
  StallingFile disk(file);
  // A ring of two fifths of a stall: most stalled stretches drop, and the drops are to be counted.
  const auto slots = static_cast<std::size_t>(0.4 * seconds * 1e9 / kPeriodNs);
  firmware::Recorder recorder(disk, kActuators, kReadings, slots);
  if (const auto failure = file.create(header()); failure || recorder.start()) {
    std::fprintf(stderr, "recorder_stall: %s\n", failure ? failure->what.c_str() : "no thread");
    return 3;
  }
  const auto measured = std::make_unique<MeasuredRecorder>(recorder, static_cast<std::size_t>(stretches + 1) / 2);

  using Plant = firmware::Plant<Simplex>;
  using Bus = hal::sim::SimulatedPlantBus;
  using Pace = firmware::OwnPace<hal::PosixClock>;
  const double period = static_cast<double>(kPeriodNs) * 1e-9;
  Plant plant(firmware::reference_plant_with_every_effect(), period, kActuators);
  Bus bus({}, period);
  hal::PosixClock clock;
  const auto loop = std::make_unique<firmware::Loop<Plant, Bus, hal::PosixClock, Pace, MeasuredRecorder>>(
      plant, bus, clock, firmware::LoopSettings{kPeriodNs, 0, 1000, firmware::OverrunPolicy::skip}, Pace(clock, kPeriodNs),
      measured.get());
  std::atomic<bool> stop{false};
  std::thread director([&] {
    for (int stretch = 0; stretch < stretches; ++stretch) {
      const bool stalled = stretch % 2 == 1;
      disk.stall(stalled);
      measured->stalled = stalled;
      measured->pair = static_cast<std::size_t>(stretch) / 2;
      std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    }
    disk.stall(false);
    stop = true;
  });
  hal::lock_memory(std::size_t{256} * 1024);
  hal::schedule_first(80);
  loop->run(stop, []() noexcept {});
  director.join();
  const firmware::RecorderAccount account = recorder.close();

  hal::RecordingReader reader(path);
  hal::RecordedCycle cycle;
  while (reader.next(cycle)) {
  }
  std::filesystem::remove(path);
  const std::uint64_t ran = loop->result().account.cycles() + loop->result().warm_up_cycles;
  const bool exact = account.offered == ran && account.stored == reader.cycles() && account.dropped() == reader.dropped() &&
                     ran == reader.cycles() + reader.dropped();
  print("step", measured->steps);
  print("recording", measured->costs);
  // A stalled disk that slows the loop does so in every pair. A processor that changes its speed does so in one.
  double steps = HUGE_VAL;
  for (std::size_t pair = 0; pair < static_cast<std::size_t>(stretches) / 2; ++pair) {
    const double ratio = ratio_of_medians(measured->pairs[pair]);
    std::printf("step time, disk stalled over running, ratio of medians: %.3f\n", ratio);
    steps = std::min(steps, ratio);
  }
  std::printf("the least of them: %.3f (allowed %.1f)\n", steps, kMostRatio);
  std::printf("%llu cycles ran, %llu in the file, %llu dropped: %s\n", static_cast<unsigned long long>(ran),
              static_cast<unsigned long long>(reader.cycles()), static_cast<unsigned long long>(account.dropped()),
              exact ? "every one accounted for" : "NOT every one accounted for");
  return exact && account.dropped() > 0 && steps < kMostRatio ? 0 : 1;
}

}  // namespace
}  // namespace hotfire

int main(int count, char** values) {
  const double seconds = count > 1 ? std::strtod(values[1], nullptr) : 5.0;
  const int stretches = count > 2 ? static_cast<int>(std::strtol(values[2], nullptr, 10)) : 4;
  return hotfire::run(seconds, stretches);
}
