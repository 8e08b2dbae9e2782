// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "hal/linux/gpiod_lines.hpp"
#include "hal/linux/posix_clock.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::hal {
namespace {

/// Runs a line of shell with the helpers of the virtual rig at hand; false if it fails.
bool shell(const std::string& command) { return std::system((". /rig/helpers; " + command).c_str()) == 0; }

/// Where the kernel shows the outside of a line of the bank.
std::filesystem::path outside(int line) {
  CHECK(shell("line_folder rig " + std::to_string(line) + " >/tmp/folder"));
  std::string folder;
  std::getline(std::ifstream("/tmp/folder"), folder);
  return folder;
}

/// The bank raises its interrupt a little later; of two changes that are closer than that, the kernel sees one.
void let_the_interrupt_run() {
  PosixClock clock;
  clock.sleep_until_ns(clock.now_ns() + 20'000'000);
}

void pull(int line, const std::string& direction) {
  std::ofstream(outside(line) / "pull") << "pull-" << direction;
  let_the_interrupt_run();
}

bool carries(int line, int level) {
  int value = -1;
  std::ifstream(outside(line) / "value") >> value;
  return value == level;
}

GpioSettings settings() {
  GpioSettings made;
  made.chip = "rig";
  made.inputs = {{"estop", true, true}, {"supply", false, false}, {"heartbeat", false, true}};
  made.outputs = {{"enable", false, false}, {"fault", true, true}};
  return made;
}

std::string refusal(const GpioSettings& wanted) {
  GpiodLines lines(wanted);
  const auto failure = lines.open();
  return failure ? failure->what + "; " + failure->remedy : std::string();
}

}  // namespace

/// Lines 0 estop (active low), 1 supply, 2 heartbeat; 3 enable, 4 fault (active low).
TEST_GROUP(Gpiod) {
  std::unique_ptr<GpiodLines> lines;

  void setup() override {
    CHECK(shell("bank_up rig estop supply heartbeat enable fault"));
    lines = std::make_unique<GpiodLines>(settings());
    const auto refused = lines->open();
    STRCMP_EQUAL("", refused ? refused->what.c_str() : "");
  }
  void teardown() override {
    lines.reset();
    CHECK(shell("clean_up"));
  }

  GpioLevels read() {
    GpioLevels levels = 0xFFFF;
    CHECK(lines->try_read(levels));
    return levels;
  }
};

TEST(Gpiod, InputsReadTheirLogicalLevelInTheOrderOfTheSettings) {
  LONGS_EQUAL(0b001, read());
  pull(0, "up");
  LONGS_EQUAL(0b000, read());
  pull(1, "up");
  LONGS_EQUAL(0b010, read());
  pull(2, "up");
  LONGS_EQUAL(0b110, read());
}

TEST(Gpiod, OutputsAreSafeFromTheRequestOnAndAgainAtTheEnd) {
  CHECK(carries(3, 0));
  CHECK(carries(4, 0));
  CHECK(lines->try_write(0b01));
  CHECK(carries(3, 1));
  CHECK(carries(4, 1));
  lines.reset();
  CHECK(carries(3, 0));
  CHECK(carries(4, 0));
}

TEST(Gpiod, EdgesCarryLineDirectionAndMonotonicTime) {
  PosixClock clock;
  std::array<GpioEdge, 8> edges;
  UNSIGNED_LONGS_EQUAL(0, lines->read_edges(edges));
  const std::int64_t before = clock.now_ns();
  pull(1, "up");
  pull(2, "up");
  pull(0, "up");
  pull(2, "down");
  const std::int64_t after = clock.now_ns();
  UNSIGNED_LONGS_EQUAL(3, lines->read_edges(edges));
  std::string estop;
  std::string heartbeat;
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(edges[i].time_ns > before);
    CHECK(edges[i].time_ns < after);
    (edges[i].input == 0 ? estop : heartbeat) += edges[i].active ? 'A' : 'i';
    CHECK(edges[i].input != 1);
  }
  STRCMP_EQUAL("i", estop.c_str());
  STRCMP_EQUAL("Ai", heartbeat.c_str());
  UNSIGNED_LONGS_EQUAL(0, lines->read_edges(edges));
}

TEST(Gpiod, EdgesThatDoNotFitAreThereAtTheNextCall) {
  for (const char* direction : {"up", "down", "up"}) {
    pull(2, direction);
  }
  std::array<GpioEdge, 2> edges;
  UNSIGNED_LONGS_EQUAL(2, lines->read_edges(edges));
  UNSIGNED_LONGS_EQUAL(1, lines->read_edges(edges));
  CHECK(edges[0].active);
}

TEST(Gpiod, CycleAllocatesNothing) {
  const test::AllocationGuard guard;
  GpioLevels levels = 0;
  std::array<GpioEdge, 4> edges;
  for (unsigned i = 0; i < 100; ++i) {
    CHECK(lines->try_read(levels));
    CHECK(lines->try_write(i & 1U));
    lines->read_edges(edges);
  }
  UNSIGNED_LONGS_EQUAL(0, guard.allocations());
}

TEST(Gpiod, ChipIsFoundByNameAndPathToo) {
  lines.reset();
  GpioSettings by_name = settings();
  by_name.chip = "gpiochip0";
  STRCMP_EQUAL("", refusal(by_name).c_str());
  by_name.chip = "/dev/gpiochip0";
  STRCMP_EQUAL("", refusal(by_name).c_str());
}

TEST(Gpiod, LinesThatAreMissingOrHeldAreRefusedWithTheRemedyAndNothingIsDriven) {
  STRCMP_CONTAINS("the inputs of GPIO chip rig are refused", refusal(settings()).c_str());
  STRCMP_CONTAINS("gpioinfo rig", refusal(settings()).c_str());
  lines.reset();
  GpioSettings wrong = settings();
  wrong.outputs = {{"enable", false, true}, {"valve", false, true}};
  STRCMP_CONTAINS("GPIO chip rig has no line valve", refusal(wrong).c_str());
  CHECK(carries(3, 0));
  wrong.chip = "rack";
  STRCMP_CONTAINS("no GPIO chip rack", refusal(wrong).c_str());
  wrong.inputs.clear();
  wrong.outputs.clear();
  STRCMP_CONTAINS("0 inputs and 0 outputs", refusal(wrong).c_str());
}

#if HOTFIRE_GPIOD_VERSION >= 2
TEST(Gpiod, QueueOfTheKernelThatRunsOverKeepsTheNewestEdgesAndTheLostOnesAreCounted) {
  constexpr unsigned kFlips = 300;
  const std::filesystem::path heartbeat = outside(2) / "pull";
  const std::filesystem::path estop = outside(0) / "pull";
  for (unsigned i = 0; i < kFlips; ++i) {
    std::ofstream(heartbeat) << (i % 2 == 0 ? "pull-up" : "pull-down");
    std::ofstream(estop) << (i % 2 == 0 ? "pull-up" : "pull-down");
    PosixClock clock;
    clock.sleep_until_ns(clock.now_ns() + 3'000'000);
  }
  let_the_interrupt_run();
  std::uint64_t seen = 0;
  std::array<GpioEdge, 64> edges;
  GpioEdge newest;
  for (std::size_t count = 1; count > 0; seen += count) {
    count = lines->read_edges(edges);
    newest = count > 0 ? edges[count - 1] : newest;
  }
  CHECK(lines->lost_edges() > 0);
  CHECK(seen + lines->lost_edges() <= 2 * kFlips);
  CHECK(seen >= 512);
  // Both lines were pulled down last: the heartbeat is then inactive, the active-low emergency stop active.
  CHECK_EQUAL(newest.input == 0, newest.active);
}
#endif

}  // namespace hotfire::hal
