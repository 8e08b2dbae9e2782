// SPDX-License-Identifier: Apache-2.0
#include "tools/files/import/guess.hpp"

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"
#include "tools/files/import/import.hpp"

using namespace hotfire;
using namespace hotfire::test;

TEST_GROUP(Guess) { Scratch scratch; };

TEST(Guess, AMapOfNamedColumnsReadsTheLogAsItIs) {
  std::string log = "Stand 3\nt (ms);BETA CMD [deg];stroke [mm];note\n";
  for (int i = 0; i < 20; ++i) {
    log += std::to_string(2 * i) + ";0.5;" + std::to_string(i) + ";word\n";
  }
  const auto source = scratch.write("run.txt", log);
  const Record record =
      import_record(source, load_import_map(scratch.write("map.toml", guessed_map(source))), scratch.path("run.csv"));
  DOUBLES_EQUAL(2e-3, record.period, 1e-12);
  DOUBLES_EQUAL(7e-3, record.find("piston")->values[7], 1e-12);
  CHECK(record.find("command") != nullptr);
}

TEST(Guess, WhatNamesDoNotSayBecomesAComment) {
  const auto source =
      scratch.write("daq.txt",
                    "Sampling Interval:  0.001\nSample Number, CHANNEL0, Events\n1, -0.5, DAQ Start\n2, 0.25\n3, "
                    "0.5\n4, 0.75\n5, 1\n6, 1.5, DAQ Pause, DAQ Stop\n");
  expect_message(guessed_map(source), {"period = \"1 ms\"", "skip_lines = 1", "events = \"Events\"", "# [channels.NAME]",
                                       "# column = \"CHANNEL0\"", "-0.5 to 1.5"});
}

TEST(Guess, AFileWithoutAHeaderAboveNumbersIsRefused) {
  expect_message(refusal([&] { guessed_map(scratch.write("words.txt", "a, b\nc, d\n")); }),
                 {"words.txt", "no line of names"});
}
