// SPDX-License-Identifier: Apache-2.0
#include "tools/files/import/import.hpp"

#include <cmath>
#include <memory>
#include <numbers>

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"

using namespace hotfire;
using namespace hotfire::test;

namespace {

constexpr const char* kMap = R"(schema = 1
[time]
column = "t"
unit = "ms"
[channels.command]
column = "BETA CMD"
unit = "deg"
[channels.piston]
column = "XP"
unit = "inch"
factor = -1
[csv]
delimiter = ";"
skip_lines = 2
)";

std::string table(const std::string& header) {
  std::string text = "Test stand 3\nrun 17\n" + header + "\n";
  for (int i = 0; i < 20; ++i) {
    text += std::to_string(2 * i) + " ; 9.5; " + std::to_string(0.5 * i) + ";" + std::to_string(-i) + "\n";
  }
  return text;
}

}  // namespace

TEST_GROUP(Import) {
  Scratch scratch;

  Record imported(const std::string& map, const std::string& source) {
    return import_record(scratch.write("run.txt", source), load_import_map(scratch.write("map.toml", map)),
                         scratch.path("run.csv"));
  }
  std::string refused(const std::string& map, const std::string& source) {
    return refusal([&] { imported(map, source); });
  }
};

TEST(Import, TakesTheColumnsOfTheMapWithTheirUnitsAndSigns) {
  const Record record = imported(kMap, table("t;spare;\"BETA CMD\";XP"));
  LONGS_EQUAL(20, record.rows);
  DOUBLES_EQUAL(2e-3, record.period, 1e-12);
  LONGS_EQUAL(2, record.channels.size());
  DOUBLES_EQUAL(3.5 * std::numbers::pi / 180.0, record.find("command")->values[7], 1e-12);
  DOUBLES_EQUAL(7 * 0.0254, record.find("piston")->values[7], 1e-12);
}

TEST(Import, APeriodReplacesATimeColumn) {
  const Record record = imported("schema = 1\nperiod = \"4 ms\"\n[channels.engine]\ncolumn = \"b\"\nunit = \"rad\"\n",
                                 "a,b\n1,0.25\n2,0.5\n3,0.75\n");
  DOUBLES_EQUAL(4e-3, record.period, 1e-12);
  DOUBLES_EQUAL(0.75, record.find("engine")->values[2], 0.0);
}

TEST(Import, AColumnThatIsNotThereIsRefusedWithThoseThatAre) {
  expect_message(refused(kMap, table("t;spare;BETA;XP")), {"run.txt:3", "BETA CMD", "t | spare | BETA | XP"});
}

TEST(Import, ARaggedRowAndAWordAreRefusedWithTheirLine) {
  expect_message(refused(kMap, table("t;spare;BETA CMD;XP") + "40;1;2\n"), {"run.txt:24", "3 columns", "4"});
  expect_message(refused(kMap, table("t;spare;BETA CMD;XP") + "40;1;n/a;2\n"), {"run.txt:24", "BETA CMD", "n/a"});
}

TEST(Import, ADeclaredDropOutKeepsWhatIsMissingInTheTable) {
  std::string source = table("t;spare;BETA CMD;XP");
  const std::string row = "10 ; 9.5; 2.500000;-5\n";
  source.replace(source.find(row), row.size(), "10 ; ;  ;NaN\n");
  const auto import_with = [&](double from, double to) {
    return import_record(scratch.write("run.txt", source), load_import_map(scratch.write("map.toml", kMap)),
                         scratch.path("run.csv"), {}, {DropOut{from, to}});
  };
  const Record record = import_with(0.010, 0.012);
  LONGS_EQUAL(20, record.rows);
  for (std::size_t i = 0; i < record.rows; ++i) {
    LONGS_EQUAL(i == 5, std::isnan(record.find("piston")->values[i]));
    LONGS_EQUAL(i == 5, std::isnan(record.find("command")->values[i]));
  }
  expect_message(refusal([&] { import_with(0.012, 0.014); }), {"does not make a record", ":7:"});
}

TEST(Import, WhatMakesNoRecordIsRefusedAndLeavesNoFile) {
  const std::string message = refused(kMap, table("t;spare;BETA CMD;XP") + "38;1;2;3\n");
  expect_message(message, {"run.txt", "does not make a record"});
  CHECK(!std::filesystem::exists(scratch.path("run.csv")));
}

TEST(Import, AMapIsRefusedWithLineKeyAndRemedy) {
  expect_message(refused("schema = 1\nperiod = \"2 ms\"\n", ""), {"map.toml", "channels", "missing"});
  expect_message(refused("schema = 1\n[channels.piston]\ncolumn = \"x\"\nunit = \"m\"\n", ""), {"time", "period"});
  expect_message(refused("schema = 1\nperiod = \"2 ms\"\n[channels.piston]\ncolum = \"x\"\n", ""),
                 {"map.toml:4", "channels.piston.colum", "column, unit, factor"});
  expect_message(refused("schema = 1\nperiod = \"2 s\"\n[channels.piston]\ncolumn = \"x\"\nunit = \"m\"\n", ""),
                 {"map.toml:2", "period", "50 us to 20 ms"});
}

TEST(Import, AFactorComesBeforeAnOffsetInTheColumnsUnit) {
  const Record record = imported(
      "schema = 1\nperiod = \"4 ms\"\n[channels.piston]\ncolumn = \"x\"\nunit = \"mm\"\nfactor = -10\noffset = \"1 cm\"\n",
      "x\n0\n1\n2\n");
  DOUBLES_EQUAL(0.010, record.find("piston")->values[0], 1e-15);
  DOUBLES_EQUAL(-0.010, record.find("piston")->values[2], 1e-15);
}

TEST(Import, ALogThatSaysOnSomeRowsWhatHappenedIsRead) {
  const std::string log =
      "Sampling Rate:  1000\nNo, CHANNEL0, CHANNEL1, Events\n 1, 0.5, 1.0, DAQ Start\n 2, 0.6, 1.5\n 3, 0.7, 2.0, DAQ "
      "Pause, DAQ "
      "Stop\n";
  const std::string map =
      "schema = 1\nperiod = \"1 ms\"\n[channels.piston]\ncolumn = \"CHANNEL0\"\nunit = \"m\"\n[csv]\nskip_lines "
      "= 1\n";
  const Record record = imported(map + "events = \"Events\"\n", log);
  LONGS_EQUAL(3, record.rows);
  DOUBLES_EQUAL(0.7, record.find("piston")->values[2], 0.0);
  expect_message(refused(map, log), {"run.txt:4", "3 columns", "the header has 4", "[csv] events = \"Events\""});
  expect_message(refused(map + "events = \"CHANNEL1\"\n", log), {"run.txt:2", "has to be the last column", "Events"});
  expect_message(refused(map + "events = \"Events\"\n", log + " 4, 0.8\n"), {"run.txt:6", "2 columns"});
}

TEST(Import, AKeyInAnotherTableIsRefusedWithWhereItBelongs) {
  const std::string channel = "[channels.piston]\ncolumn = \"x\"\nunit = \"m\"\n";
  expect_message(refused("schema = 1\n" + channel + "period = \"2 ms\"\n", ""),
                 {"map.toml:5", "channels.piston.period", "before the first [table]"});
  expect_message(refused("schema = 1\nunit = \"m\"\nperiod = \"2 ms\"\n" + channel, ""),
                 {"map.toml:2", "unit", "[channels.NAME]"});
  expect_message(refused("schema = 1\nskip_lines = 2\nperiod = \"2 ms\"\n" + channel, ""),
                 {"map.toml:2", "skip_lines", "[csv]"});
}

TEST(Import, ALogOfTenHertzIsRefusedWithTheKeyThatResamplesIt) {
  const std::string channel = "[channels.piston]\ncolumn = \"x\"\nunit = \"m\"\n";
  expect_message(refused("schema = 1\nperiod = \"100 ms\"\n" + channel, "x\n0\n1\n"), {"map.toml:2", "[resample]"});
  const Record record =
      imported("schema = 1\nperiod = \"100 ms\"\n" + channel + "[resample]\nperiod = \"20 ms\"\n", "x\n0\n0\n0\n0\n0\n");
  LONGS_EQUAL(21, record.rows);
  DOUBLES_EQUAL(0.02, record.period, 1e-12);
}
