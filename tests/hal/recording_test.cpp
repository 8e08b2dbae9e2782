#include <CppUTest/TestHarness.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>

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

/// A block of cycles with these numbers, commands and readings derived from them.
std::string block(const std::vector<std::uint64_t>& cycles) {
  std::string content;
  for (const std::uint64_t cycle : cycles) {
    CycleHead head;
    head.cycle = cycle;
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

TEST(Recording, HeaderThatLacksSomethingOrIsForeignIsRefusedWithTheReason) {
  const auto refused = [](const std::string& text, const char* reason) {
    STRCMP_CONTAINS(reason, parse_header(text).error.c_str());
  };
  const auto without = [&](const std::string& line) {
    std::string text = start;
    return text.erase(text.find(line), line.size());
  };
  const auto with = [&](const std::string& before, const std::string& after) {
    std::string text = start;
    return text.replace(text.find(before), before.size(), after);
  };
  refused("time[s],command[rad]\n", "no recording");
  refused(with("recording 1", "recording 2"), "another version");
  refused(start.substr(0, start.size() - 3), "cut off");
  refused(without("period_ns 250000\n"), "lacks period_ns");
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
    STRCMP_EQUAL("", file.append(std::as_bytes(std::span(one)), {}).c_str());
  }
  RecordingReader reader(path);
  UNSIGNED_LONGS_EQUAL(1, count(reader));
  CHECK(!std::filesystem::exists(path + ".part"));
}

TEST(Recording, FileThatExistsIsRefusedWithTheMendAndStaysAsItWas) {
  const std::string path = scratch.write("run.hfr", "old").string();
  {
    const auto failure = RecordingFile(path, 1 << 20).create(start);
    CHECK(failure.has_value());
    STRCMP_CONTAINS("run.hfr exists", failure->what.c_str());
    STRCMP_CONTAINS("--overwrite", failure->mend.c_str());
  }
  UNSIGNED_LONGS_EQUAL(3, std::filesystem::file_size(path));
  CHECK(!std::filesystem::exists(path + ".part"));
}

TEST(Recording, FileThatWouldGrowBeyondItsLimitRefusesTheBlockWhole) {
  const std::string path = scratch.path("run.hfr").string();
  const std::string one = block({0});
  RecordingFile file(path, start.size() + one.size());
  CHECK(!file.create(start));
  STRCMP_EQUAL("", file.append(std::as_bytes(std::span(one)), {}).c_str());
  STRCMP_CONTAINS("--record-max-mib", file.append(std::as_bytes(std::span(one)), {}).c_str());
  UNSIGNED_LONGS_EQUAL(start.size() + one.size(), std::filesystem::file_size(path));
}

TEST(Recording, FileThatCannotBeMadeIsRefusedWithTheMend) {
  RecordingFile nowhere(scratch.path("none/run.hfr").string(), 1 << 20);
  const auto failure = nowhere.create(start);
  CHECK(failure.has_value());
  STRCMP_CONTAINS("none/run.hfr: No such file", failure->what.c_str());
  STRCMP_CONTAINS("name a file", failure->mend.c_str());
  CHECK(RecordingFile("/dev/null", 1 << 20).create(start).has_value());
}

TEST(Recording, BlockThatTheDiskTakesOnlyInPartIsTakenBack) {
  const std::string path = scratch.path("run.hfr").string();
  const std::string one = block({0, 1, 2});
  RecordingFile file(path, 1 << 20);
  CHECK(!file.create(start));
  STRCMP_EQUAL("", file.append(std::as_bytes(std::span(one)), {}).c_str());
  // A limit on the size of files stands in for a disk that is full.
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{start.size() + one.size() + 40, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string why = file.append(std::as_bytes(std::span(one)), {});
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, SIG_DFL);
  STRCMP_CONTAINS("run.hfr: File too large", why.c_str());
  UNSIGNED_LONGS_EQUAL(start.size() + one.size(), std::filesystem::file_size(path));
  const std::string end = end_block(1);
  STRCMP_EQUAL("", file.append(std::as_bytes(std::span(end)), {}).c_str());
  RecordingReader reader(path);
  UNSIGNED_LONGS_EQUAL(3, count(reader));
  CHECK(reader.end() == RecordingReader::End::closed);
}

}  // namespace hotfire::hal
