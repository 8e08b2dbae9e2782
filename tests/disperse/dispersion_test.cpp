// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/dispersion.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"
#include "tools/analysis/chart.hpp"
#include "tools/disperse/dispersion_report.hpp"
#include "tools/disperse/worker.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::disperse {

namespace {

constexpr Share kWhole{};
const std::function<void(int, int)> kSilent = [](int, int) {};

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_GROUP(Dispersion) {
  test::Scratch scratch;
  int calls = 0;

  Plan plan(int draws = 20) const {
    return {.model = scratch.write("model.toml",
                                   "schema = 1\ntopology = \"simplex\"\n[tolerance]\nengine.inertia = 0.1\n"
                                   "structure.stiffness = 0.05\n"),
            .tolerances = {},
            .command = {"step", "--hold", "1"},
            .channels = {},
            .draws = draws,
            .seed = 4,
            .program = "digest"};
  }

  /// A command whose result is the inertia of the model that it is given.
  CommandRunner inertia() {
    return [this](const std::vector<std::string>& words) -> CommandOutcome {
      ++calls;
      STRCMP_EQUAL("--json", words.back().c_str());
      DeclaredModel model(words[words.size() - 2]);
      for (const DeclaredNumber& number : model.numbers()) {
        if (number.keys.front() == "engine.inertia") {
          return {
              0,
              fmt::format("{{\"size\": {{\"inertia\": {}, \"square\": {}}}}}", *number.value, *number.value * *number.value),
              ""};
        }
      }
      return {6, "", "no inertia"};
    };
  }

  std::string table_of(const std::string& folder, Share share = kWhole) {
    Dispersion own(plan(), scratch.path(folder), share);
    own.run(inertia(), kSilent);
    return own.is_complete() ? DispersionReport(own, {}).table() : std::string{};
  }
};

TEST(Dispersion, EachDrawIsRunOnceOnAModelOfItsOwn) {
  const std::string table = table_of("one");
  LONGS_EQUAL(21, calls);
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  STRCMP_EQUAL("draw,status,engine.inertia[kg.m^2],structure.stiffness[N/m],size.inertia,size.square", line.c_str());
  for (int draw = 0; std::getline(lines, line); ++draw) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) {
      cells.push_back(cell);
    }
    STRCMP_EQUAL(std::to_string(draw).c_str(), cells[0].c_str());
    // What the command found in its model is what the table says was drawn.
    STRCMP_EQUAL(cells[2].c_str(), cells[4].c_str());
  }
}

TEST(Dispersion, ARunThatWasStoppedContinuesAndGivesTheSameBits) {
  const std::string whole = table_of("whole");
  calls = 0;
  {
    Dispersion first(plan(), scratch.path("stopped"), kWhole);
    const CommandRunner run = inertia();
    CHECK_THROWS(std::runtime_error, first.run(
                                         [&](const std::vector<std::string>& words) {
                                           if (calls == 7) {
                                             throw std::runtime_error("stopped");
                                           }
                                           return run(words);
                                         },
                                         kSilent));
  }
  LONGS_EQUAL(7, calls);
  // A kill may cut the last line.
  const auto file = scratch.path("stopped") / "share-1-of-1.draws";
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 5);
  STRCMP_EQUAL(whole.c_str(), table_of("stopped").c_str());
  LONGS_EQUAL(7 + 15, calls);
}

TEST(Dispersion, SharesTogetherGiveTheBitsOfOneRun) {
  const std::string whole = table_of("whole");
  calls = 0;
  STRCMP_EQUAL("", table_of("shared", {1, 3}).c_str());
  STRCMP_EQUAL("", table_of("shared", {2, 3}).c_str());
  STRCMP_EQUAL(whole.c_str(), table_of("shared", {3, 3}).c_str());
  LONGS_EQUAL(21, calls);
}

TEST(Dispersion, ResultsOfAnotherMachineAreMerged) {
  const std::string whole = table_of("whole");
  std::string text;
  for (int index = 1; index <= 2; ++index) {
    const std::string folder = fmt::format("machine{}", index);
    table_of(folder, {index, 2});
    text += Dispersion(plan(), scratch.path(folder), {index, 2}).store().text({index, 2});
  }
  calls = 0;
  Dispersion here(plan(), scratch.path("here"), kWhole);
  here.store().merge(text, "text");
  here.run(inertia(), kSilent);
  LONGS_EQUAL(0, calls);
  STRCMP_EQUAL(whole.c_str(), DispersionReport(here, {}).table().c_str());
}

TEST(Dispersion, AWorkerRunsWhatItIsGivenAndTakesWhatOthersRan) {
  const std::string whole = table_of("whole");
  Dispersion there(plan(), scratch.path("there"), {2, 2});
  std::istringstream asked("20\n3\n3\n");
  std::ostringstream printed;
  calls = 0;
  CHECK_FALSE(work(there, inertia(), kSilent, asked, printed));
  LONGS_EQUAL(2, calls);
  const DrawStore& store = there.store();
  STRCMP_EQUAL((store.header() + "20\n" + store.line(20) + store.line(3) + store.line(3)).c_str(), printed.str().c_str());

  // The other worker takes the two results, and runs the rest.
  std::string lines = store.header() + store.line(20) + store.line(3);
  for (int draw = 0; draw < 20; ++draw) {
    lines += draw == 3 ? "" : fmt::format("{}\n", draw);
  }
  Dispersion here(plan(), scratch.path("here"), {1, 2});
  std::istringstream rest(lines + "report\n");
  calls = 0;
  CHECK_TRUE(work(here, inertia(), kSilent, rest, printed));
  LONGS_EQUAL(19, calls);
  STRCMP_EQUAL(whole.c_str(), DispersionReport(here, {}).table().c_str());

  // What it took is on its own disk, and it says so when it starts again.
  Dispersion again(plan(), scratch.path("here"), {1, 1});
  std::istringstream nothing;
  std::ostringstream known;
  CHECK_FALSE(work(again, inertia(), kSilent, nothing, known));
  STRCMP_EQUAL((again.store().header() + "20 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20\n").c_str(),
               known.str().c_str());
}

TEST(Dispersion, AWorkerRefusesOtherInputsAndWhatIsNoDraw) {
  Plan other = plan();
  other.seed = 5;
  Dispersion there(other, scratch.path("there"), {2, 2});
  Dispersion here(plan(), scratch.path("here"), {1, 2});
  const auto work_on = [&](const std::string& lines) {
    std::istringstream in(lines);
    std::ostringstream out;
    work(here, inertia(), kSilent, in, out);
  };
  test::expect_message(test::refusal([&] { work_on(there.store().header()); }),
                       {"a result of another worker:1:", "seed was 5, now 4"});
  CHECK_THROWS(UsageError, work_on("21\n"));
  CHECK_THROWS(UsageError, work_on("repot\n"));
}

TEST(Dispersion, ResultsOfOtherInputsAreRefusedAndNamed) {
  table_of("one");
  const auto refusal = [&](const Plan& other) {
    return test::refusal([&] { const Dispersion own(other, scratch.path("one"), kWhole); });
  };
  Plan other = plan();
  other.seed = 5;
  test::expect_message(refusal(other), {"share-1-of-1.draws:1:", "seed was 4, now 5", "--out"});
  test::expect_message(refusal(plan(21)), {"draws was 20, now 21"});
  other = plan();
  other.command.back() = "2";
  test::expect_message(refusal(other), {"command was"});
  other = plan();
  other.program = "another";
  test::expect_message(refusal(other), {"program was"});
  other = plan();
  scratch.write("model.toml",
                "schema = 1\ntopology = \"simplex\"\n[engine]\ninertia = 9000\n[tolerance]\nengine.inertia = 0.1\n"
                "structure.stiffness = 0.05\n");
  test::expect_message(refusal(other), {"model was"});
}

TEST(Dispersion, AFileThatTheCommandReadsIsPartOfTheInputs) {
  Plan with_file = plan();
  with_file.command = {"step", scratch.write("input.csv", "1").string()};
  { Dispersion(with_file, scratch.path("one"), kWhole).run(inertia(), kSilent); }
  scratch.write("input.csv", "2");
  test::expect_message(test::refusal([&] { const Dispersion own(with_file, scratch.path("one"), kWhole); }),
                       {"files was", "input.csv"});
}

TEST(Dispersion, AChangedLineIsRefusedWithItsNumber) {
  table_of("one");
  const auto file = scratch.path("one") / "share-1-of-1.draws";
  std::string text = content_of(file);
  const auto at = text.find("inertia", text.find("\"draw\":3"));
  text[at + 9] = text[at + 9] == '1' ? '2' : '1';
  std::ofstream(file, std::ios::binary) << text;
  test::expect_message(test::refusal([&] { table_of("one"); }), {"share-1-of-1.draws:5:", "delete it"});
}

TEST(Dispersion, TwoProcessesDoNotWorkOnOneShare) {
  const Dispersion first(plan(), scratch.path("one"), kWhole);
  test::expect_message(test::refusal([&] { const Dispersion second(plan(), scratch.path("one"), kWhole); }),
                       {"share-1-of-1.draws", "another process"});
}

TEST(Dispersion, ADrawWhoseCommandFailsStaysInTheTable) {
  Dispersion own(plan(), scratch.path("one"), kWhole);
  const CommandRunner run = inertia();
  own.run(
      [&](const std::vector<std::string>& words) {
        return calls == 5 ? (++calls, CommandOutcome{6, "", words[4] + ": bad"}) : run(words);
      },
      kSilent);
  const DispersionReport report(own, {});
  LONGS_EQUAL(1, report.failed());
  STRCMP_CONTAINS("\n5,6,", report.table().c_str());
  const nlohmann::ordered_json json = report.json();
  LONGS_EQUAL(19, json["quantities"]["size.inertia"]["draws"].get<int>());
  // The folder of the model differs from run to run and is no part of the result.
  STRCMP_EQUAL("draw.toml: bad", json["failed"][0]["complaint"].get<std::string>().c_str());
}

TEST(Dispersion, WordsThatAreWrongInEveryDrawEndTheRun) {
  Dispersion own(plan(), scratch.path("one"), kWhole);
  CHECK_THROWS(UsageError, own.run([&](const auto&) { return CommandOutcome{2, "", "unknown argument"}; }, kSilent));
  CHECK_THROWS(FileError, own.run([&](const auto&) { return CommandOutcome{6, "", "no record"}; }, kSilent));
  Plan wrong = plan();
  wrong.command = {"step", "--picture", "p.svg"};
  CHECK_THROWS(UsageError, Dispersion(wrong, scratch.path("two"), kWhole));
  wrong.command = {"step", "--json"};
  CHECK_THROWS(UsageError, Dispersion(wrong, scratch.path("two"), kWhole));
}

TEST(Dispersion, TheRecordOfADrawGivesItsExtremesAndThePercentilesOverTime) {
  Plan simulated = plan(4);
  simulated.command = {"simulate", "--input", "in.csv"};
  simulated.channels = {"engine"};
  Dispersion own(simulated, scratch.path("one"), kWhole);
  own.run(
      [&](const std::vector<std::string>& words) {
        std::ofstream(words[4]) << fmt::format("time[s],engine[rad]\n0,0\n0.01,{}\n0.02,1\n", ++calls);
        return CommandOutcome{0, fmt::format("{{\"seconds\": {}}}", calls), ""};
      },
      kSilent);
  const DispersionReport report(own, {.percentiles = {50.0}});
  LONGS_EQUAL(3, report.quantities().size());
  STRCMP_EQUAL("record.engine.greatest", report.quantities()[1].name.c_str());
  DOUBLES_EQUAL(1.0, report.quantities()[1].declared, 0.0);
  DOUBLES_EQUAL(5.0, report.quantities()[1].values.back(), 0.0);
  const analysis::Chart chart = report.pictures().at("channel-engine.svg");
  // Draws 1 to 4 have 2 to 5 in the second row.
  DOUBLES_EQUAL(3.5, chart.panels.front().curves.front().y[1], 1e-15);
  DOUBLES_EQUAL(1.0, chart.panels.front().curves.back().y[1], 0.0);
}

TEST(Dispersion, TheReportNamesWhatAQuantityFollows) {
  Dispersion own(plan(), scratch.path("one"), kWhole);
  own.run(inertia(), kSilent);
  const DispersionReport report(own, {.quantities = {"*.square"}, .percentiles = {50.0}});
  const nlohmann::ordered_json json = report.json();
  LONGS_EQUAL(1, json["quantities"].size());
  DOUBLES_EQUAL(1.0, json["quantities"]["size.square"]["rank_correlation"]["engine.inertia"].get<double>(), 1e-12);
  STRCMP_CONTAINS("engine.inertia (+1.00)", report.text().c_str());
  CHECK(report.pictures().contains("square.svg"));
  CHECK_THROWS(UsageError, DispersionReport(own, {.quantities = {"sqare"}}));
}

}  // namespace hotfire::disperse
