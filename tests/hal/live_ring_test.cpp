// SPDX-License-Identifier: Apache-2.0
#include "hal/live/ring.hpp"

#include <CppUTest/TestHarness.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statfs.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <thread>
#include <vector>

#include "hal/linux/live_file.hpp"
#include "hal/live/description.hpp"

namespace hotfire::hal {

namespace {

constexpr LiveShape kShape{0, 3, 4};

/// A ring in the process's own memory.
struct Ring {
  explicit Ring(const LiveShape& shape) : memory(shape.words()), writer(memory, shape), reader(memory, shape) {}

  /// Puts a cycle whose every word is its number.
  void put(std::uint64_t number, std::size_t words) {
    writer.begin();
    for (std::size_t i = 0; i < words; ++i) {
      writer.put(number);
    }
    writer.publish();
  }

  std::vector<LiveWord> memory;
  LiveWriter writer;
  LiveReader reader;
};

LiveDescription bench() {
  LiveDescription description;
  description.header.period_ns = 1'000'000;
  description.header.actuators = 2;
  description.header.input = {"command", "rad"};
  description.header.channels = {{"piston", "m"}, {"engine", "rad"}};
  description.header.start = {0.0, 0.0, 0.0, 0.0};
  description.states = {{0, "safe"}, {4, "faulted"}};
  description.faults = {{7, "bus down", "the CAN interface is down"}};
  description.endings = {{2, "asked to stop"}};
  description.counters = {{"bus", "not sent, queue full"}, {"loop", "overruns"}};
  return description;
}

/// A name in memory that no other run of this test has.
std::string name_in_memory(const char* name) { return "/dev/shm/hotfire-test-" + std::to_string(getpid()) + "-" + name; }

}  // namespace

TEST_GROUP(LiveRing){};

TEST(LiveRing, ReaderGetsWhatWasPublishedAndNothingElse) {
  Ring ring(kShape);
  std::array<std::uint64_t, 3> words{};
  CHECK(!ring.reader.read(0, words));
  ring.put(100, 3);
  UNSIGNED_LONGS_EQUAL(1, ring.reader.published());
  CHECK(ring.reader.read(0, words));
  UNSIGNED_LONGS_EQUAL(100, words[2]);
  CHECK(!ring.reader.read(1, words));
}

TEST(LiveRing, CycleThatWasOverwrittenIsRefused) {
  Ring ring(kShape);
  for (std::uint64_t n = 0; n < 6; ++n) {
    ring.put(n, 3);
  }
  std::array<std::uint64_t, 3> words{};
  UNSIGNED_LONGS_EQUAL(2, ring.reader.oldest());
  CHECK(!ring.reader.read(1, words));
  for (std::uint64_t n = 2; n < 6; ++n) {
    CHECK(ring.reader.read(n, words));
    UNSIGNED_LONGS_EQUAL(n, words[0]);
  }
}

TEST(LiveRing, SlotThatIsBeingFilledIsRefusedForItsOldAndItsNewCycle) {
  Ring ring(kShape);
  for (std::uint64_t n = 0; n < 4; ++n) {
    ring.put(n, 3);
  }
  ring.writer.begin();
  ring.writer.put(std::uint64_t{4});
  std::array<std::uint64_t, 3> words{};
  CHECK(!ring.reader.read(0, words));
  CHECK(!ring.reader.read(4, words));
  CHECK(ring.reader.read(1, words));
}

TEST(LiveRing, MoreThanASlotHoldsIsLeftOutAndSpoilsNoOther) {
  Ring ring(kShape);
  ring.put(7, 3);
  ring.put(8, 50);
  std::array<std::uint64_t, 3> words{};
  CHECK(ring.reader.read(0, words));
  UNSIGNED_LONGS_EQUAL(7, words[0]);
  UNSIGNED_LONGS_EQUAL(0, ring.memory[kShape.first_slot() + 2 * (kShape.slot_words + 1)]);
}

TEST(LiveRing, WriterTakesNothingFromTheMemorySoNobodyCanDisturbIt) {
  Ring ring(kShape);
  ring.put(0, 3);
  for (LiveWord& word : ring.memory) {
    word = ~std::uint64_t{0};
  }
  for (std::uint64_t n = 1; n < 5; ++n) {
    ring.put(n, 3);
  }
  std::array<std::uint64_t, 3> words{};
  UNSIGNED_LONGS_EQUAL(5, ring.reader.published());
  CHECK(ring.reader.read(4, words));
  UNSIGNED_LONGS_EQUAL(4, words[1]);
}

TEST(LiveRing, NoCycleIsTornWhileAWriterOvertakesItsReader) {
  constexpr std::size_t kWords = 1000;
  constexpr int kTries = 100'000;
  Ring ring({0, kWords, 2});
  ring.put(0, kWords);
  std::atomic<bool> stop{false};
  std::thread writing([&] {
    for (std::uint64_t n = 1; !stop; ++n) {
      ring.put(n, kWords);
    }
  });
  std::vector<std::uint64_t> words(kWords);
  int good = 0;
  int torn = 0;
  for (int i = 0; i < kTries; ++i) {
    const std::uint64_t newest = ring.reader.published() - 1;
    if (ring.reader.read(newest, words)) {
      ++good;
      torn += std::count(words.begin(), words.end(), newest) == static_cast<std::ptrdiff_t>(kWords) ? 0 : 1;
    }
  }
  stop = true;
  writing.join();
  CHECK(good > 0);
  CHECK(good < kTries);
  LONGS_EQUAL(0, torn);
}

TEST_GROUP(LiveDescription){};

TEST(LiveDescription, TextGivesTheSameDescriptionAgain) {
  const ParsedDescription parsed = parse_description(description_text(bench()));
  STRCMP_EQUAL("", parsed.error.c_str());
  UNSIGNED_LONGS_EQUAL(9 + 2 + 4 + 2, parsed.description.slot_words());
  STRCMP_EQUAL("faulted", parsed.description.states[1].name.c_str());
  UNSIGNED_LONGS_EQUAL(7, parsed.description.faults[0].number);
  STRCMP_EQUAL("the CAN interface is down", parsed.description.faults[0].meaning.c_str());
  STRCMP_EQUAL("asked to stop", parsed.description.endings[0].name.c_str());
  STRCMP_EQUAL("not sent, queue full", parsed.description.counters[0].name.c_str());
  STRCMP_EQUAL("engine", parsed.description.header.channels[1].name.c_str());
}

TEST(LiveDescription, UnknownLineIsRefusedByName) {
  STRCMP_CONTAINS("\"colour 3 red\"", parse_description(description_text(bench()) + "colour 3 red\n").error.c_str());
  STRCMP_CONTAINS("\"fault seven x\"", parse_description(description_text(bench()) + "fault seven x\n").error.c_str());
  CHECK(!parse_description("no header").error.empty());
}

TEST_GROUP(LiveFile) {
  std::string path = name_in_memory("view");
  std::string text = description_text(bench());
  std::size_t words = bench().slot_words();

  void setup() override { unlink(path.c_str()); }
  void teardown() override { unlink(path.c_str()); }

  void check_refused(LiveFile & file, const char* why) {
    const auto refused = file.create(text, words, 10);
    CHECK(refused.has_value());
    STRCMP_CONTAINS(why, refused->what.c_str());
    CHECK(!refused->remedy.empty());
  }
};

TEST(LiveFile, CanOnlyBeReadAndGoesWithItsProgram) {
  {
    LiveFile file(path);
    CHECK(!file.create(text, words, 10));
    struct stat status {};
    LONGS_EQUAL(0, stat(path.c_str(), &status));
    UNSIGNED_LONGS_EQUAL(0440 & ~umask(umask(0)), status.st_mode & 0777);
  }
  LONGS_EQUAL(-1, access(path.c_str(), F_OK));
}

TEST(LiveFile, NameOfAProgramThatRunsIsRefusedAndStaysItsOwn) {
  LiveFile first(path);
  CHECK(!first.create(text, words, 10));
  LiveFile second(path);
  check_refused(second, "another program, which runs");
  LONGS_EQUAL(0, access(path.c_str(), F_OK));
}

TEST(LiveFile, NameOfAProgramThatWasKilledIsTakenOver) {
  const pid_t child = fork();
  if (child == 0) {
    LiveFile file(path);
    _exit(file.create(text, words, 10) ? 1 : 0);
  }
  int status = -1;
  waitpid(child, &status, 0);
  LONGS_EQUAL(0, status);
  LONGS_EQUAL(0, access(path.c_str(), F_OK));
  LiveFile file(path);
  CHECK(!file.create(text, words, 10));
}

TEST(LiveFile, AnythingElseOfThatNameIsKept) {
  std::ofstream(path) << "a letter";
  LiveFile file(path);
  check_refused(file, "is something else");
  std::string kept;
  std::getline(std::ifstream(path), kept);
  STRCMP_EQUAL("a letter", kept.c_str());
}

TEST(LiveFile, LinkIsNotFollowed) {
  const std::string target = name_in_memory("target");
  LONGS_EQUAL(0, symlink(target.c_str(), path.c_str()));
  LiveFile file(path);
  check_refused(file, path.c_str());
  LONGS_EQUAL(-1, access(target.c_str(), F_OK));
}

TEST(LiveFile, FileOnADiskIsRefusedBecauseTheLoopWouldWaitForIt) {
  const std::string on_disk = "live-view-" + std::to_string(getpid());
  struct statfs system {};
  LONGS_EQUAL(0, statfs(".", &system));
  constexpr long kInMemory = 0x01021994;
  if (system.f_type == kInMemory) {
    return;
  }
  LiveFile file(on_disk);
  check_refused(file, "is on a disk");
  LONGS_EQUAL(-1, access(on_disk.c_str(), F_OK));
}

}  // namespace hotfire::hal
