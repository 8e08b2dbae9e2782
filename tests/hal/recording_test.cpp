// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <atomic>
#include <barrier>
#include <cmath>
#include <csignal>
#include <cstring>
#include <thread>

#include "hal/linux/recording_file.hpp"
#include "hal/recording/header.hpp"
#include "hal/recording/reader.hpp"
#include "tests/files/scratch.hpp"

namespace hotfire::hal {

namespace {

RecordingHeader bench() {
  RecordingHeader header;
  header.version = "9.9";
  header.started = "2026-01-02T03:04:05Z";
  header.host = "rig";
  header.kernel = "6.1 rt";
  header.command_line = "hotfire-rt plant\n--odd";
  header.topology = "direct";
  header.period_ns = 250'000;
  header.steps_per_cycle = 1;
  header.actuators = 2;
  header.input = {"force", "N"};
  header.channels = {{"position", "m"}};
  header.start = {0.1, -std::nextafter(0.3, 1.0)};
  header.model = "schema 1\ntopology direct\n";
  return header;
}

/// The header with the hash of what it says now.
std::string with_right_hash(const std::string& text) {
  const std::string key = "header_hash ";
  const std::size_t at = text.find(key);
  if (at == std::string::npos) {
    return text;
  }
  Fnv1a hash;
  hash.add(std::as_bytes(std::span(text)).first(at));
  char digits[32];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash.value()));
  return text.substr(0, at) + key + digits + text.substr(at + key.size() + 16);
}

/// A block of cycles with these numbers, commands and readings derived from them. Before the first the loop left out so
/// many.
std::string block(const std::vector<std::uint64_t>& cycles, std::uint64_t skipped = 0) {
  std::string content;
  for (const std::uint64_t cycle : cycles) {
    CycleHead head;
    head.cycle = cycle;
    head.flags = (cycle == cycles.front() ? skipped : 0) << CycleHead::kSkippedShift;
    const auto value = static_cast<double>(cycle);
    const double values[] = {value, -value, value + 0.5, value + 0.25};
    content.append(reinterpret_cast<const char*>(&head), sizeof head);
    content.append(reinterpret_cast<const char*>(values), sizeof values);
  }
  BlockHead head;
  head.cycles = static_cast<std::uint32_t>(cycles.size());
  head.checksum = head.checksum_with(std::as_bytes(std::span(content)));
  return std::string(reinterpret_cast<const char*>(&head), sizeof head) + content;
}

std::string end_block(std::uint64_t dropped) {
  BlockHead head;
  head.kind = BlockHead::kEnd;
  head.dropped = dropped;
  head.checksum = head.checksum_with({});
  return {reinterpret_cast<const char*>(&head), sizeof head};
}

}  // namespace

TEST_GROUP(Recording) {
  test::Scratch scratch;
  const std::string start = header_text(bench());

  RecordingReader opened(const std::string& content) const {
    return RecordingReader(scratch.write("run.hfr", content).string());
  }

  static std::size_t files_beside(const std::string& path) {
    const std::filesystem::directory_iterator files(std::filesystem::path(path).parent_path());
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
  }

  static std::uint64_t count(RecordingReader & reader) {
    RecordedCycle cycle;
    std::uint64_t cycles = 0;
    for (; reader.next(cycle); ++cycles) {
      DOUBLES_EQUAL(static_cast<double>(cycle.head.cycle), cycle.commands[0], 0.0);
      DOUBLES_EQUAL(static_cast<double>(cycle.head.cycle) + 0.25, cycle.readings[1], 0.0);
    }
    return cycles;
  }
};

TEST(Recording, HeaderComesBackBitForBitWithUnitsAndProvenance) {
  const ParsedHeader parsed = parse_header(start);
  STRCMP_EQUAL("", parsed.error.c_str());
  UNSIGNED_LONGS_EQUAL(start.size(), parsed.bytes);
  STRCMP_EQUAL("hotfire-rt plant --odd", parsed.header.command_line.c_str());
  STRCMP_EQUAL("m", parsed.header.channels[0].unit.c_str());
  STRCMP_EQUAL(bench().model.c_str(), parsed.header.model.c_str());
  CHECK(parsed.header.start == bench().start);
  CHECK(header_text(parsed.header) == header_text(parse_header(header_text(parsed.header)).header));
}

TEST(Recording, NoByteOfAHeaderCanChangeUnnoticed) {
  for (std::size_t at = 0; at < start.size(); ++at) {
    for (const char bit : {'\x01', '\x10'}) {
      std::string changed = start;
      changed[at] = static_cast<char>(changed[at] ^ bit);
      CHECK_TRUE_TEXT(!parse_header(changed).error.empty(), changed.substr(at, 20).c_str());
    }
  }
}

TEST(Recording, HeaderWithAnotherPeriodUnitOrStartIsRefused) {
  const auto refused = [&](const std::string& before, const std::string& after) {
    std::string text = start;
    STRCMP_CONTAINS("its header is damaged",
                    parse_header(text.replace(text.find(before), before.size(), after)).error.c_str());
  };
  refused("period_ns 250000", "period_ns 750000");
  refused("channel position m", "channel position mm");
  refused("start 0x1.999999999999ap-4", "start 0x1.999999999999ap-5");
}

TEST(Recording, FileWithoutEndIsRefusedAtItsFirstLine) {
  const std::string error = RecordingReader("/dev/zero").error();
  STRCMP_CONTAINS("/dev/zero: not a recording of this version: line 1: it does not begin with", error.c_str());
}

TEST(Recording, HeaderIsSearchedForItsEndUpToALimit) {
  const std::string text = std::string(kRecordingMark) + std::string(kLongestHeader, 'x') + std::string(kLastHeaderLine);
  STRCMP_CONTAINS("no end within 67108864 bytes", opened(text).error().c_str());
  STRCMP_CONTAINS("the file is cut off", opened(std::string(kRecordingMark) + "version 1\n").error().c_str());
}

TEST(Recording, HeaderThatIsIncompleteOrForeignIsRefusedWithTheReason) {
  const auto refused = [](const std::string& text, const char* reason) {
    STRCMP_CONTAINS(reason, parse_header(with_right_hash(text)).error.c_str());
  };
  const auto without = [&](const std::string& line) {
    std::string text = start;
    return text.erase(text.find(line), line.size());
  };
  const auto with = [&](const std::string& before, const std::string& after) {
    std::string text = start;
    return text.replace(text.find(before), before.size(), after);
  };
  refused("time[s],command[rad]\n", "it is not a recording");
  refused(with("recording 2", "recording 1"), "another version");
  refused(start.substr(0, start.size() - 3), "cut off");
  refused(without("period_ns 250000\n"), "period_ns, actuators, input or channel is missing");
  refused(with("actuators 2", "actuators 9"), "more of them than a plant can have");
  refused(with("actuators 2", "actuators two"), "\"actuators two\"");
  refused(with("start 0x1.999999999999ap-4\n", ""), "one line `start`");
  refused(with("topology direct\nperiod", "topology direct\ncolour red\nperiod"), "\"colour red\": unknown key");
  refused(with("model schema 1", "model schema 2"), "the model in its header is not the one");
}

TEST(Recording, FileThatIsNotThereOrIsAFolderIsRefused) {
  STRCMP_CONTAINS("No such file", RecordingReader("no/such.hfr").error().c_str());
  STRCMP_CONTAINS("Is a directory", RecordingReader(scratch.path("").string()).error().c_str());
}

TEST(Recording, ClosedRecordingGivesItsCyclesAndItsDrops) {
  RecordingReader reader = opened(start + block({0, 1, 2}) + block({5, 6}) + end_block(4));
  STRCMP_EQUAL("", reader.error().c_str());
  RecordedCycle cycle;
  for (int i = 0; i < 4; ++i) {
    CHECK(reader.next(cycle));
  }
  UNSIGNED_LONGS_EQUAL(5, cycle.head.cycle);
  UNSIGNED_LONGS_EQUAL(2, cycle.dropped_before);
  UNSIGNED_LONGS_EQUAL(1, count(reader));
  CHECK(reader.end() == RecordingReader::End::closed);
  UNSIGNED_LONGS_EQUAL(5, reader.cycles());
  UNSIGNED_LONGS_EQUAL(4, reader.dropped());
}

TEST(Recording, CyclesThatTheLoopLeftOutAreDistinguishedFromThoseThatAreNotInTheFile) {
  RecordingReader reader = opened(start + block({0, 1, 2}) + block({7, 8}, 3));
  RecordedCycle cycle;
  for (int i = 0; i < 4; ++i) {
    CHECK(reader.next(cycle));
  }
  UNSIGNED_LONGS_EQUAL(7, cycle.head.cycle);
  UNSIGNED_LONGS_EQUAL(3, cycle.skipped_before);
  UNSIGNED_LONGS_EQUAL(1, cycle.dropped_before);
  CHECK(reader.next(cycle));
  UNSIGNED_LONGS_EQUAL(0, cycle.skipped_before);
  CHECK(!reader.next(cycle));
  UNSIGNED_LONGS_EQUAL(1, reader.dropped());
}

// A killed writer leaves any prefix of what it would have written.
TEST(Recording, EveryPrefixOpensAndGivesTheBlocksThatAreWhole) {
  const std::string first = block({0, 1, 2});
  const std::string second = block({3, 4});
  const std::string whole = start + first + second;
  for (std::size_t size = start.size(); size < whole.size(); ++size) {
    RecordingReader reader = opened(whole.substr(0, size));
    STRCMP_EQUAL("", reader.error().c_str());
    UNSIGNED_LONGS_EQUAL(size < start.size() + first.size() ? 0 : 3, count(reader));
    CHECK(reader.end() == RecordingReader::End::cut_off);
  }
}

TEST(Recording, NoByteOfABlockCanChangeUnnoticed) {
  const std::string first = block({0, 1, 2});
  for (std::size_t at = 0; at < first.size(); ++at) {
    std::string changed = first;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    RecordingReader reader = opened(start + changed + block({3, 4}) + end_block(0));
    UNSIGNED_LONGS_EQUAL(0, count(reader));
    CHECK(reader.end() != RecordingReader::End::closed);
  }
}

TEST(Recording, FileHasItsNameOnlyWithItsHeaderAndReplacesAnOlderOneThatItMayOverwrite) {
  const std::string path = scratch.write("run.hfr", "old").string();
  {
    RecordingFile file(path, 1 << 20, true);
    CHECK(!file.create(start));
    const std::string one = block({0});
    CHECK(!file.append(std::as_bytes(std::span(one)), {}));
  }
  RecordingReader reader(path);
  UNSIGNED_LONGS_EQUAL(1, count(reader));
  UNSIGNED_LONGS_EQUAL(1, files_beside(path));
}

TEST(Recording, FileThatExistsIsRefusedWithTheRemedyAndStaysAsItWas) {
  const std::string path = scratch.write("run.hfr", "old").string();
  {
    const auto failure = RecordingFile(path, 1 << 20).create(start);
    CHECK(failure.has_value());
    STRCMP_CONTAINS("run.hfr exists", failure->what.c_str());
    STRCMP_CONTAINS("--overwrite", failure->remedy.c_str());
  }
  UNSIGNED_LONGS_EQUAL(3, std::filesystem::file_size(path));
  UNSIGNED_LONGS_EQUAL(1, files_beside(path));
}

TEST(Recording, FileIsReadableForItsUserAndGroupAlone) {
  const mode_t before = umask(0);
  const std::string path = scratch.path("run.hfr").string();
  CHECK(!RecordingFile(path, 1 << 20).create(start));
  umask(before);
  CHECK(std::filesystem::status(path).permissions() == std::filesystem::perms{0640});
}

// Two programs with one --record: the second finds the name taken, whatever it may overwrite, and the first one's file
// whole.
TEST(Recording, FileThatAProgramWritesIsReplacedByNoOther) {
  const std::string path = scratch.path("run.hfr").string();
  const std::string one = block({0});
  RecordingFile first(path, 1 << 20);
  CHECK(!first.create(start));
  for (const bool overwrite : {false, true}) {
    RecordingFile second(path, 1 << 20, overwrite);
    const auto failure = second.create(start);
    CHECK(failure.has_value());
    STRCMP_CONTAINS(overwrite ? "is being written by another program" : "exists", failure->what.c_str());
    CHECK(!first.append(std::as_bytes(std::span(one)), {}));
  }
  RecordingReader reader(path);
  RecordedCycle cycle;
  CHECK(reader.next(cycle) && reader.next(cycle));
  UNSIGNED_LONGS_EQUAL(1, files_beside(path));
}

TEST(Recording, OfProgramsThatStartTogetherOneGetsTheNameAndItsRecordingIsWhole) {
  for (int round = 0; round < 60; ++round) {
    const std::string path = scratch.path("run" + std::to_string(round) + ".hfr").string();
    std::atomic<int> made{0};
    std::barrier together(2);
    const auto record = [&](bool overwrite) {
      RecordingFile file(path, 1 << 20, overwrite);
      together.arrive_and_wait();
      const bool is_mine = !file.create(start);
      together.arrive_and_wait();
      if (is_mine) {
        ++made;
        const std::string cycles = block({0, 1, 2});
        file.append(std::as_bytes(std::span(cycles)), {});
      }
    };
    std::thread one(record, round % 2 == 0);
    std::thread two(record, round % 3 == 0);
    one.join();
    two.join();
    LONGS_EQUAL(1, made.load());
    RecordingReader reader(path);
    STRCMP_EQUAL("", reader.error().c_str());
    UNSIGNED_LONGS_EQUAL(3, count(reader));
  }
}

TEST(Recording, LinkIsRefusedAndWhatItLeadsToStaysAsItWas) {
  const std::string target = scratch.write("target", "old").string();
  const std::string path = scratch.path("link.hfr").string();
  std::filesystem::create_symlink(target, path);
  for (const bool overwrite : {false, true}) {
    const auto failure = RecordingFile(path, 1 << 20, overwrite).create(start);
    CHECK(failure.has_value());
    STRCMP_CONTAINS("link.hfr is a link", failure->what.c_str());
  }
  UNSIGNED_LONGS_EQUAL(3, std::filesystem::file_size(target));
}

// What a program killed while it made a file leaves, or what somebody has put there.
TEST(Recording, TemporaryThatExistsIsNeitherFollowedNorReplaced) {
  const std::string target = scratch.write("target", "old").string();
  const std::string path = scratch.path("run.hfr").string();
  std::filesystem::create_symlink(target, path + "." + std::to_string(getpid()) + ".part");
  const auto failure = RecordingFile(path, 1 << 20).create(start);
  CHECK(failure.has_value());
  STRCMP_CONTAINS(".part: File exists", failure->what.c_str());
  UNSIGNED_LONGS_EQUAL(3, std::filesystem::file_size(target));
  CHECK(!std::filesystem::exists(path));
}

TEST(Recording, FileThatWouldGrowBeyondItsLimitRefusesTheBlockWhole) {
  const std::string path = scratch.path("run.hfr").string();
  const std::string one = block({0});
  RecordingFile file(path, start.size() + one.size());
  CHECK(!file.create(start));
  CHECK(!file.append(std::as_bytes(std::span(one)), {}));
  const auto refused = file.append(std::as_bytes(std::span(one)), {});
  CHECK(refused.has_value());
  CHECK(!refused->is_error);
  STRCMP_CONTAINS("--record-max-mib", refused->why.c_str());
  UNSIGNED_LONGS_EQUAL(start.size() + one.size(), std::filesystem::file_size(path));
}

TEST(Recording, FileThatCannotBeMadeIsRefusedWithTheRemedy) {
  RecordingFile nowhere(scratch.path("none/run.hfr").string(), 1 << 20);
  const auto failure = nowhere.create(start);
  CHECK(failure.has_value());
  STRCMP_CONTAINS("none/run.hfr: No such file", failure->what.c_str());
  STRCMP_CONTAINS("name a file", failure->remedy.c_str());
  CHECK(RecordingFile("/dev/null", 1 << 20).create(start).has_value());
}

TEST(Recording, BlockThatTheDiskTakesOnlyInPartIsTakenBack) {
  const std::string path = scratch.path("run.hfr").string();
  const std::string one = block({0, 1, 2});
  RecordingFile file(path, 1 << 20);
  CHECK(!file.create(start));
  CHECK(!file.append(std::as_bytes(std::span(one)), {}));
  // A limit on the size of files stands in for a disk that is full.
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{start.size() + one.size() + 40, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const auto refused = file.append(std::as_bytes(std::span(one)), {});
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, SIG_DFL);
  CHECK(refused.has_value());
  CHECK(refused->is_error);
  STRCMP_CONTAINS("run.hfr: File too large", refused->why.c_str());
  UNSIGNED_LONGS_EQUAL(start.size() + one.size(), std::filesystem::file_size(path));
  const std::string end = end_block(1);
  CHECK(!file.append(std::as_bytes(std::span(end)), {}));
  CHECK(!file.sync());
  RecordingReader reader(path);
  UNSIGNED_LONGS_EQUAL(3, count(reader));
  CHECK(reader.end() == RecordingReader::End::closed);
}

}  // namespace hotfire::hal
