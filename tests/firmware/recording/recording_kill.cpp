// SPDX-License-Identifier: Apache-2.0
// Kills a plant that records, without warning and at a random moment, again and again:
//   recording_kill HOTFIRE-RT [TIMES [SEED]]
// Every recording must open, replay to the same bits without a gap, and reach to within a second of the kill.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "firmware/replay/replay.hpp"
#include "hal/linux/posix_clock.hpp"
#include "tests/firmware/recording/recorded_run.hpp"

namespace hotfire {
namespace {

constexpr std::int64_t kMostMissingNs = 1'000'000'000;

/// Starts the program, waits until the recording has its name, lets it run for a time, kills it. Returns when it was killed
/// on CLOCK_MONOTONIC, 0 if it had ended by itself.
std::int64_t run_and_kill(const std::string& program, const std::string& image, const std::string& recording,
                          std::chrono::microseconds time) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    execl(program.c_str(), program.c_str(), "plant", "--image", image.c_str(), "--record", recording.c_str(), "--period-us",
          "250", "--actuators", "8", "--amplitude", "5", static_cast<char*>(nullptr));
    _exit(127);
  }
  while (!std::filesystem::exists(recording) && waitpid(child, nullptr, WNOHANG) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::this_thread::sleep_for(time);
  const std::int64_t killed = hal::PosixClock().now_ns();
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL ? killed : 0;
}

/// When the last recorded cycle was sent; 0 if there is none.
std::int64_t last_cycle_ns(const std::string& recording) {
  hal::RecordingReader reader(recording);
  hal::RecordedCycle cycle;
  std::int64_t last = 0;
  while (reader.next(cycle)) {
    last = cycle.head.written_ns;
  }
  return last;
}

/// What is wrong with the recording of a plant that was killed at `killed`; empty: nothing.
std::string fault_of(const std::string& recording, std::int64_t killed, std::int64_t named) {
  if (killed == 0) {
    return "the program ended before it was killed";
  }
  hal::RecordingReader reader(recording);
  if (!reader.error().empty()) {
    return reader.error();
  }
  const firmware::Replay result = firmware::replay(reader);
  if (!result.error.empty() || result.difference || result.gap || result.proved != result.recorded ||
      result.end != hal::RecordingReader::End::cut_off) {
    return "it does not replay to the same bits up to where it is cut off";
  }
  const std::int64_t missing = killed - std::max(last_cycle_ns(recording), named);
  std::printf("  %6llu cycles, the last %.0f ms before the kill\n", static_cast<unsigned long long>(result.proved),
              static_cast<double>(missing) * 1e-6);
  return missing > kMostMissingNs ? "more than the last second is missing" : "";
}

int run(const std::string& program, int times, unsigned seed) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("hotfire-kill-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "bench.image") << test::kBenchImage;
  const std::string recording = folder / "run.hfr";
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> moment_us(0, 2'000'000);
  int failed = 0;
  for (int i = 0; i < times; ++i) {
    std::filesystem::remove(recording);
    const std::int64_t began = hal::PosixClock().now_ns();
    const std::int64_t killed =
        run_and_kill(program, folder / "bench.image", recording, std::chrono::microseconds(moment_us(random)));
    const std::string fault = fault_of(recording, killed, began);
    if (!fault.empty()) {
      std::printf("FAILED: kill %d: %s\n", i + 1, fault.c_str());
      ++failed;
    }
  }
  std::filesystem::remove_all(folder);
  std::printf("%d of %d killed plants left a recording that opens, replays and is missing at most its last second\n",
              times - failed, times);
  return failed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace hotfire

int main(int count, char** values) {
  if (count < 2) {
    std::fprintf(stderr, "usage: %s HOTFIRE-RT [TIMES [SEED]]\n", values[0]);
    return 2;
  }
  const int times = count > 2 ? static_cast<int>(std::strtol(values[2], nullptr, 10)) : 50;
  const auto seed = count > 3 ? static_cast<unsigned>(std::strtoul(values[3], nullptr, 10)) : std::random_device{}();
  std::printf("seed %u\n", seed);
  return hotfire::run(values[1], times, seed);
}
