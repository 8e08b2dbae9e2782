// SPDX-License-Identifier: Apache-2.0
#include "firmware/replay/replay.hpp"

#include <CppUTest/TestHarness.h>

#include <cstring>

#include "firmware/plant/reference_plant.hpp"
#include "tests/files/scratch.hpp"
#include "tests/firmware/recording/recorded_run.hpp"
#include "tests/firmware/recording/rewritten_recording.hpp"

namespace hotfire::firmware {

using End = hal::RecordingReader::End;
using test::kBenchImage;

TEST_GROUP(Replay) {
  test::Scratch scratch;
  const std::string path = scratch.path("run.hfr").string();

  std::string content() const { return test_recording::content_of(path); }
  Replay replayed() const { return test_recording::replayed(path); }

  template <class Change>
  void rewrite(Change && change) const {
    scratch.write("run.hfr", test_recording::rewritten(path, change));
  }
};

TEST(Replay, RecordedRunIsProvedTheSameBitsCycleForCycle) {
  const RecorderAccount account = test::record_bench(test::recorded_options(path, 990));
  UNSIGNED_LONGS_EQUAL(1000, account.stored);
  const Replay result = replayed();
  UNSIGNED_LONGS_EQUAL(1000, result.recorded);
  UNSIGNED_LONGS_EQUAL(1000, result.proved);
  CHECK(!result.difference && !result.gap);
  CHECK(result.end == End::closed);
}

TEST(Replay, EightActuatorsAreProvedTogether) {
  test::record_bench(test::recorded_options(path, 490, 8));
  const Replay result = replayed();
  UNSIGNED_LONGS_EQUAL(500, result.proved);
}

TEST(Replay, LastBitOfOneReadingIsNamedWithItsCycleActuatorAndChannel) {
  test::record_bench(test::recorded_options(path, 490, 3));
  // Three commands, then the readings of one mass after the other.
  const std::size_t second_reading = sizeof(hal::CycleHead) + 8 * (3 + model::Direct<double>::channels.size());
  rewrite([&](std::uint64_t cycle, std::string& bytes) {
    bytes[second_reading] = static_cast<char>(bytes[second_reading] ^ (cycle == 123 ? 1 : 0));
    return true;
  });
  const Replay result = replayed();
  UNSIGNED_LONGS_EQUAL(123, result.proved);
  UNSIGNED_LONGS_EQUAL(123, result.difference.value().cycle);
  STRCMP_CONTAINS("position of actuator 2: recorded ", result.difference->what.c_str());
}

TEST(Replay, OneWrongCommandShowsInItsCycle) {
  test::record_bench(test::recorded_options(path, 490));
  rewrite([&](std::uint64_t cycle, std::string& bytes) {
    const double wrong = 4.9;
    if (cycle == 77) {
      std::memcpy(bytes.data() + sizeof(hal::CycleHead), &wrong, sizeof wrong);
    }
    return true;
  });
  UNSIGNED_LONGS_EQUAL(77, replayed().difference.value().cycle);
}

TEST(Replay, HashThatDiffersBehindEqualReadingsIsADifferenceOfState) {
  test::record_bench(test::recorded_options(path, 490));
  const std::size_t hash = offsetof(hal::CycleHead, hash);
  rewrite([&](std::uint64_t cycle, std::string& bytes) {
    bytes[hash] = static_cast<char>(bytes[hash] ^ (cycle == 9 ? 1 : 0));
    return true;
  });
  const Replay result = replayed();
  UNSIGNED_LONGS_EQUAL(9, result.difference.value().cycle);
  STRCMP_CONTAINS("the state", result.difference->what.c_str());
}

TEST(Replay, NothingBehindADroppedCycleIsClaimed) {
  test::record_bench(test::recorded_options(path, 490));
  rewrite([](std::uint64_t cycle, std::string&) { return cycle < 200 || cycle > 210; });
  const Replay result = replayed();
  UNSIGNED_LONGS_EQUAL(200, result.gap.value());
  UNSIGNED_LONGS_EQUAL(200, result.proved);
  UNSIGNED_LONGS_EQUAL(11, result.dropped);
  UNSIGNED_LONGS_EQUAL(489, result.recorded);
}

TEST(Replay, LastBitOfOneParameterOfTheModelIsFoundByTheFirstCycleThatMoves) {
  const auto options = test::recorded_options(path, 490);
  std::string image = kBenchImage;
  image.replace(image.find("mass.inertia 96"), 15, "mass.inertia 96.00000000000002");
  test::record_run<model::Direct<double>>(options, test::bench_parameters(), image);
  const Replay result = replayed();
  CHECK(result.difference.has_value());
  UNSIGNED_LONGS_EQUAL(0, result.difference->cycle);
}

TEST(Replay, RecordingThatNeverClosedIsProvedAsFarAsItGoes) {
  test::record_bench(test::recorded_options(path, 490));
  scratch.write("run.hfr", content().substr(0, content().size() - 100));
  const Replay result = replayed();
  CHECK(result.end == End::cut_off);
  CHECK(!result.difference);
  UNSIGNED_LONGS_EQUAL(result.recorded, result.proved);
}

TEST(Replay, ExitStatusIsThatOfTheVerdict) {
  test::record_bench(test::recorded_options(path, 90));
  LONGS_EQUAL(0, run_replay(path, false));
  LONGS_EQUAL(6, run_replay(scratch.path("none").string(), false));
  rewrite([](std::uint64_t cycle, std::string&) { return cycle != 50; });
  LONGS_EQUAL(1, run_replay(path, true));
}

}  // namespace hotfire::firmware
