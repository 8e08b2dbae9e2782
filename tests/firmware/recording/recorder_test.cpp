// SPDX-License-Identifier: Apache-2.0
#include "firmware/recording/recorder.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <chrono>
#include <thread>

#include "hal/recording/header.hpp"
#include "hal/recording/reader.hpp"
#include "tests/files/scratch.hpp"
#include "tests/firmware/recording/recorded_run.hpp"
#include "tests/support/allocation_guard.hpp"

namespace hotfire::firmware {

using test::MemorySink;

namespace {

constexpr std::size_t kActuators = 8;
constexpr std::size_t kReadings = 24;

void offer(Recorder& recorder, std::uint64_t first, std::uint64_t count) {
  const std::array<double, kActuators> commands{};
  const std::array<double, kReadings> readings{};
  for (std::uint64_t cycle = first; cycle < first + count; ++cycle) {
    hal::CycleHead head;
    head.cycle = cycle;
    recorder.record(head, commands, readings);
  }
}

}  // namespace

TEST_GROUP(Recorder) {
  test::Scratch scratch;
  MemorySink sink;

  /// What a reader finds in the sink.
  hal::RecordingReader read_back() {
    hal::RecordingHeader header;
    header.period_ns = 1'000'000;
    header.actuators = kActuators;
    header.input = {"command", "rad"};
    header.channels = {{"piston", "m"}, {"engine", "rad"}, {"load_pressure", "Pa"}};
    header.start.assign(kReadings, 0.0);
    hal::RecordingReader reader(scratch.write("run.hfr", hal::header_text(header) + sink.bytes).string());
    hal::RecordedCycle cycle;
    while (reader.next(cycle)) {
    }
    return reader;
  }

  static void expect_not_safe(const RecorderAccount& account, std::uint64_t dropped) {
    STRCMP_EQUAL("not safe", account.failure.c_str());
    CHECK(account.is_error);
    UNSIGNED_LONGS_EQUAL(dropped, account.dropped());
  }
};

TEST(Recorder, EveryCycleIsStoredWhenTheSinkKeepsUp) {
  Recorder recorder(sink, kActuators, kReadings, 20'000);
  CHECK(!recorder.start());
  offer(recorder, 0, 10'000);
  const RecorderAccount account = recorder.close();
  UNSIGNED_LONGS_EQUAL(10'000, account.offered);
  UNSIGNED_LONGS_EQUAL(10'000, account.stored);
  CHECK(!recorder.dropping());
  const hal::RecordingReader reader = read_back();
  UNSIGNED_LONGS_EQUAL(10'000, reader.cycles());
  UNSIGNED_LONGS_EQUAL(0, reader.dropped());
  CHECK(reader.end() == hal::RecordingReader::End::closed);
}

// The thread may or may not have taken a first block into the stalled sink: the ring still holds it, so the count is exact.
TEST(Recorder, StalledSinkDropsExactlyWhatTheRingCannotHold) {
  Recorder recorder(sink, kActuators, kReadings, 1000);
  CHECK(!recorder.start());
  {
    const std::lock_guard stall(sink.gate);
    offer(recorder, 0, 1000);
    CHECK(!recorder.dropping());
    offer(recorder, 1000, 234);
    CHECK(recorder.dropping());
  }
  const RecorderAccount account = recorder.close();
  UNSIGNED_LONGS_EQUAL(1234, account.offered);
  UNSIGNED_LONGS_EQUAL(1000, account.stored);
  UNSIGNED_LONGS_EQUAL(234, account.dropped());
  UNSIGNED_LONGS_EQUAL(234, read_back().dropped());
}

TEST(Recorder, DropsBetweenCyclesAreTheGapsThatAReaderFinds) {
  Recorder recorder(sink, kActuators, kReadings, 500);
  CHECK(!recorder.start());
  std::uint64_t cycle = 0;
  for (int stall = 0; stall < 3; ++stall) {
    const std::lock_guard guard(sink.gate);
    offer(recorder, cycle, 700);
    cycle += 700;
  }
  const RecorderAccount account = recorder.close();
  const hal::RecordingReader reader = read_back();
  UNSIGNED_LONGS_EQUAL(2100, account.offered);
  CHECK(account.dropped() >= 200);
  UNSIGNED_LONGS_EQUAL(account.stored, reader.cycles());
  UNSIGNED_LONGS_EQUAL(account.dropped(), reader.dropped());
}

TEST(Recorder, SinkThatRefusesEndsTheRecordingAndEveryCycleAfterIsCounted) {
  sink.refuse_after = 200 * hal::cycle_bytes(kActuators, kReadings);
  Recorder recorder(sink, kActuators, kReadings, 5000);
  CHECK(!recorder.start());
  offer(recorder, 0, 4000);
  const RecorderAccount account = recorder.close();
  STRCMP_EQUAL("the disk is full", account.failure.c_str());
  CHECK(account.is_error);
  UNSIGNED_LONGS_EQUAL(4000, account.offered);
  CHECK(account.stored < 200);
  const hal::RecordingReader reader = read_back();
  UNSIGNED_LONGS_EQUAL(account.stored, reader.cycles());
  UNSIGNED_LONGS_EQUAL(account.dropped(), reader.dropped());
}

// What was written may be gone: the recorder says so while the loop runs, and takes no more.
TEST(Recorder, SinkThatCannotMakeItsContentSafeEndsTheRecordingWithAnError) {
  sink.syncs_refused = true;
  Recorder recorder(sink, kActuators, kReadings, 5000);
  CHECK(!recorder.start());
  std::uint64_t cycle = 0;
  while (!recorder.dropping()) {
    offer(recorder, cycle++, 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  expect_not_safe(recorder.close(), 1);
}

TEST(Recorder, ContentThatCannotBeMadeSafeAtTheEndIsAnErrorToo) {
  Recorder recorder(sink, kActuators, kReadings, 5000);
  CHECK(!recorder.start());
  offer(recorder, 0, 100);
  sink.syncs_refused = true;
  expect_not_safe(recorder.close(), 0);
}

TEST(Recorder, RecordingAllocatesNothingWhetherTheRingIsFullOrNot) {
  Recorder recorder(sink, kActuators, kReadings, 100);
  CHECK(!recorder.start());
  const std::lock_guard stall(sink.gate);
  const test::AllocationGuard guard;
  offer(recorder, 0, 1000);
  UNSIGNED_LONGS_EQUAL(0, guard.allocations());
  UNSIGNED_LONGS_EQUAL(0, guard.releases());
  sink.gate.unlock();
  recorder.close();
  sink.gate.lock();
}

}  // namespace hotfire::firmware
