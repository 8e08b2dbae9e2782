// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "firmware/lab/lab_image.hpp"
#include "firmware/session/live_session.hpp"
#include "tools/watch/server.hpp"
#include "tools/watch/watcher.hpp"

namespace hotfire::watch {

namespace {

using firmware::CycleOutputs;
using firmware::Ending;
using firmware::LiveCounters;
using firmware::LiveSession;
using firmware::LoopResult;
using nlohmann::json;

/// A program of one actuator at 1 kHz that shows itself: its command is the number of the cycle, its piston minus that.
class Program {
 public:
  explicit Program(const std::string& path, const std::string& topology = "simplex") {
    options_.live_view = path;
    firmware::RecordedPlant plant;
    plant.topology = topology;
    plant.input = {"command", "rad"};
    plant.channels = {{"piston", "m"}};
    plant.start = {0.0};
    live_.emplace(options_);
    is_shown_ = !live_->start(plant, LiveCounters().add("bus", "sent", [this] { return cycle_; }), *result_, outputs_);
  }

  void run(std::uint64_t cycles, std::uint64_t flags = hal::CycleHead::kSlept) {
    for (const std::uint64_t end = cycle_ + cycles; cycle_ < end; ++cycle_) {
      const auto release = static_cast<std::int64_t>(cycle_) * 1'000'000;
      const double command = static_cast<double>(cycle_);
      const double piston = -command;
      outputs_.record({cycle_, release, release + 5000, release + 6000, release + 16'000, release + 17'000, 0, 0, flags},
                      {&command, 1}, {&piston, 1});
    }
  }
  void end(Ending ending) { live_->close(ending); }
  bool is_shown() const { return is_shown_; }

 private:
  firmware::RunOptions options_;
  std::unique_ptr<LoopResult> result_ = std::make_unique<LoopResult>(1'000'000);
  CycleOutputs outputs_;
  std::optional<LiveSession> live_;
  std::uint64_t cycle_ = 0;
  bool is_shown_ = false;
};

/// The source gives the cycles 0 to count - 1, and then none.
void check_next_cycles(LiveSource& source, std::uint64_t count) {
  LiveCycle cycle;
  for (std::uint64_t n = 0; n < count; ++n) {
    CHECK(source.next(cycle));
    UNSIGNED_LONGS_EQUAL(n, cycle.head.cycle);
    DOUBLES_EQUAL(-static_cast<double>(n), cycle.readings[0], 0.0);
    UNSIGNED_LONGS_EQUAL(n, cycle.counters[0]);
  }
  CHECK(!source.next(cycle));
}

json answer_of(const Watcher& watcher, const Request& request) { return json::parse(watcher.answer(request)); }

/// Asks until the answer is so, for two seconds at most.
template <class Wanted>
json wait_for(const Watcher& watcher, const Request& request, Wanted wanted) {
  json answer;
  for (int i = 0; i < 200; ++i) {
    answer = answer_of(watcher, request);
    if (wanted(answer)) {
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return answer;
}

json wait_for_state(const Watcher& watcher, const char* state) {
  return wait_for(watcher, {}, [state](const json& answer) { return answer["state"] == state; });
}

}  // namespace

/// A live view of a test's own.
TEST_BASE(LiveViewTest) {
  std::string path = "/dev/shm/hotfire-watch-test-" + std::to_string(getpid());

  void setup() override { unlink(path.c_str()); }
  void teardown() override { unlink(path.c_str()); }
};

TEST_GROUP_BASE(LiveSource, LiveViewTest){};

TEST(LiveSource, ProgramMayStartLaterEndAndStartAgain) {
  LiveSource source(path);
  CHECK(!source.refresh());
  CHECK(source.state() == LiveSource::State::absent);
  for (int run = 0; run < 2; ++run) {
    Program program(path);
    CHECK(program.is_shown());
    program.run(3);
    CHECK(source.refresh());
    CHECK(!source.refresh());
    CHECK(source.state() == LiveSource::State::running);
    check_next_cycles(source, 3);
    program.end(Ending::asked);
    CHECK(!source.refresh());
    CHECK(source.state() == LiveSource::State::ended);
    STRCMP_EQUAL("asked to stop", source.why().c_str());
  }
}

TEST(LiveSource, CyclesThatCameTooFastAreCounted) {
  LiveSource source(path);
  Program program(path);
  source.refresh();
  // The view keeps a second.
  program.run(2500);
  LiveCycle cycle;
  std::uint64_t seen = 0;
  while (source.next(cycle)) {
    ++seen;
  }
  UNSIGNED_LONGS_EQUAL(1000, seen);
  UNSIGNED_LONGS_EQUAL(1500, source.missed());
  UNSIGNED_LONGS_EQUAL(2499, cycle.head.cycle);
}

TEST(LiveSource, ProgramThatWasKilledIsKnownToBeGone) {
  const pid_t child = fork();
  if (child == 0) {
    Program program(path);
    program.run(5);
    _exit(program.is_shown() ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  LONGS_EQUAL(0, status);
  LiveSource source(path);
  CHECK(source.refresh());
  CHECK(source.state() == LiveSource::State::died);
}

TEST(LiveSource, FileThatIsNoLiveViewIsRefusedUntilOneIsThere) {
  std::ofstream(path) << std::string(5000, 'x');
  LiveSource source(path);
  CHECK(!source.refresh());
  CHECK(source.state() == LiveSource::State::refused);
  STRCMP_CONTAINS("no live view", source.why().c_str());
  unlink(path.c_str());
  Program program(path);
  CHECK(source.refresh());
  CHECK(source.state() == LiveSource::State::running);
}

TEST(LiveSource, ViewThatIsCutShortIsRefused) {
  std::string bytes;
  {
    Program program(path);
    program.run(10);
    std::ifstream file(path, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(file), {});
  }
  for (const std::size_t kept : {std::size_t{0}, std::size_t{100}, bytes.size() / 2, bytes.size() - 1, bytes.size() - 8}) {
    unlink(path.c_str());
    std::ofstream(path, std::ios::binary) << bytes.substr(0, kept);
    LiveSource source(path);
    CHECK(!source.refresh());
    CHECK(source.state() == LiveSource::State::refused);
  }
}

TEST_GROUP(History) {
  hal::LiveDescription description;

  void setup() override {
    description.header.period_ns = 1'000'000;
    description.header.actuators = 1;
    description.header.input = {"command", "rad"};
    description.header.channels = {{"piston", "m"}};
    description.header.start = {0.0};
  }

  static void add(History & history, std::uint64_t cycle, double piston) {
    const double command = 0.0;
    hal::CycleHead head;
    head.cycle = cycle;
    head.release_ns = 7'000'000'000 + static_cast<std::int64_t>(cycle) * 1'000'000;
    history.add({head, {&command, 1}, {&piston, 1}, {}});
  }
};

TEST(History, RowHasTheExtremesOfItsCyclesAndTheLastValue) {
  History history(description);
  for (std::uint64_t cycle = 0; cycle < 101; ++cycle) {
    add(history, cycle, cycle == 60 ? 9.0 : cycle == 70 ? -4.0 : 1.0);
  }
  UNSIGNED_LONGS_EQUAL(2, history.rows());
  STRCMP_EQUAL("piston", history.channels()[1].name.c_str());
  DOUBLES_EQUAL(0.05, history.time(1), 1e-12);
  DOUBLES_EQUAL(1.0, history.values(0)[1].greatest, 0.0);
  DOUBLES_EQUAL(-4.0, history.values(1)[1].least, 0.0);
  DOUBLES_EQUAL(9.0, history.values(1)[1].greatest, 0.0);
  DOUBLES_EQUAL(1.0, history.values(1)[1].last, 0.0);
}

TEST(History, ProgramThatIsMetOnItsWayHasItsOwnTime) {
  History history(description);
  for (std::uint64_t cycle = 5000; cycle < 5051; ++cycle) {
    add(history, cycle, 0.0);
  }
  DOUBLES_EQUAL(5.0, history.time(0), 1e-12);
}

TEST(History, KeepsTheLastFiveMinutesAndNoMore) {
  History history(description);
  for (std::uint64_t row = 0; row < History::kMostRows + 100; ++row) {
    add(history, 50 * row, static_cast<double>(row));
  }
  UNSIGNED_LONGS_EQUAL(99, history.oldest_row());
  DOUBLES_EQUAL(99.0, history.values(99)[1].last, 0.0);
  DOUBLES_EQUAL(static_cast<double>(History::kMostRows + 98), history.values(history.rows() - 1)[1].last, 0.0);
}

TEST(History, TimesAreThoseOfTheCycles) {
  History history(description);
  const double value = 0.0;
  hal::CycleHead head{1, 1'000'000, 1'040'000, 1'050'000, 1'250'000, 2'100'000, 0, 0, hal::CycleHead::kSlept};
  history.add({head, {&value, 1}, {&value, 1}, {}});
  LONGS_EQUAL(40'000, history.wake_up().greatest_ns());
  LONGS_EQUAL(200'000, history.step().greatest_ns());
  DOUBLES_EQUAL(200e3, history.step().quantile_ns(0.5), 1.0);
}

TEST_GROUP_BASE(Watcher, LiveViewTest){};

TEST(Watcher, AnswersWithTheProgramThenOnlyWithWhatIsNew) {
  Program program(path);
  program.run(200);
  const Watcher watcher(path);
  const json first = answer_of(watcher, {{}, 0, {1}});
  STRCMP_EQUAL("simplex", first["program"]["topology"].get<std::string>().c_str());
  UNSIGNED_LONGS_EQUAL(4, first["program"]["channels"].size());
  UNSIGNED_LONGS_EQUAL(3, first["rows"].size());
  DOUBLES_EQUAL(-49.0, first["rows"][0][1].get<double>(), 0.0);
  DOUBLES_EQUAL(0.0, first["rows"][0][2].get<double>(), 0.0);
  CHECK(first["interlock"].is_null());
  program.run(51);
  const Request next{first["epoch"], first["next"], {1, 99}};
  const json second = wait_for(watcher, next, [](const json& answer) { return answer["rows"].size() == 2; });
  CHECK(!second.contains("program"));
  CHECK(second["sent"] == json::array({1}));
  DOUBLES_EQUAL(0.15, second["rows"][0][0].get<double>(), 1e-9);
}

TEST(Watcher, AnotherProgramBeginsANewEpoch) {
  const Watcher watcher(path);
  const json nobody = answer_of(watcher, {});
  CHECK(nobody["state"] == "absent");
  json first;
  {
    Program program(path);
    program.run(100);
    first = wait_for_state(watcher, "running");
    program.end(Ending::overrun);
    const json ended = wait_for_state(watcher, "ended");
    CHECK(ended["why"] == "stopped by an overrun");
  }
  Program program(path);
  program.run(100);
  const json second =
      wait_for(watcher, {first["epoch"], 2, {0}}, [](const json& answer) { return answer["state"] == "running"; });
  CHECK(second["epoch"] != first["epoch"]);
  CHECK(second.contains("program"));
}

TEST(Watcher, ProgramThatShowsNoCycleIsSilent) {
  Program program(path);
  program.run(10);
  const Watcher watcher(path);
  CHECK(answer_of(watcher, {})["state"] == "running");
  CHECK(wait_for_state(watcher, "silent")["state"] == "silent");
  program.run(1);
  CHECK(wait_for_state(watcher, "running")["state"] == "running");
}

TEST(Watcher, InterlockAndFaultOfALabAreNamed) {
  Program program(path, std::string(firmware::kLabTopology));
  program.run(10, hal::CycleHead::lab_flags(4, 7));
  const Watcher watcher(path);
  const json answer = answer_of(watcher, {});
  CHECK(answer["interlock"]["state"] == "faulted");
  LONGS_EQUAL(7, answer["interlock"]["fault"].get<int>());
  bool named = false;
  for (const json& fault : answer["program"]["faults"]) {
    named = named || (fault["number"] == 7 && fault["name"] == "bus down");
  }
  CHECK(named);
}

}  // namespace hotfire::watch
