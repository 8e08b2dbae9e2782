// SPDX-License-Identifier: Apache-2.0
#include "firmware/lab/lab_image.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::firmware {

TEST_GROUP(LabImage) {
  std::string image =
      "schema 1\ntopology lab\nactuators 2\npiston_per_command 0.5\ncurrent_per_command 0.1\ncurrent_per_error 0\n"
      "current_limit 0.02\napproach_rate 1\nrest_speed 0.001\nstopping_time 1\nlimits.command_age 0.005\n"
      "limits.reading_age 0x1p-7,1\nlimits.lowest_reading -0.15\nlimits.highest_reading 0.15\nlimits.disagreement 0.001\n"
      "limits.lowest_position -0.06,-0.05\nlimits.highest_position 0.06,0.05\nlimits.speed 0.3,0.4\nlimits.speed_time 0.01\n"
      "limits.read_back_time 0.1\ninterlock.debounce 0.03\ninterlock.start_hold 0\ninterlock.longest_press 10\n"
      "interlock.least_armed 1\ninterlock.arming_timeout 60\n"
      "limits.command_rate 100\nlimits.position_error 0.005\n"
      "limits.position_error_time 0.5\nlimits.overruns 3\nline.emergency_stop estop\nline.hydraulic_enable hydraulic\n"
      "line.arm arm\nline.start start\nline.supply supply\nline.heartbeat heartbeat\nline.fault fault\nsegment.0.duration "
      "2\n"
      "segment.0.from 0.01,-1\nsegment.0.to 0.03,-0x1p+1\nsegment.0.amplitude 0,0\nsegment.0.frequency "
      "1\nsegment.0.last_frequency 1\n";

  void refused(const std::string& line, const std::string& instead, const char* part) const {
    std::string changed = image;
    changed.replace(changed.find(line), line.size(), instead);
    const LabImage read = parse_lab_image(changed, "image", 1e-3);
    CHECK(!read.settings);
    STRCMP_CONTAINS(part, read.error.c_str());
  }
};

TEST(LabImage, EveryKeyArrives) {
  const LabImage read = parse_lab_image(image, "image", 1e-3);
  STRCMP_EQUAL("", read.error.c_str());
  UNSIGNED_LONGS_EQUAL(2, read.settings->actuators);
  LONGS_EQUAL(7'812'500, read.settings->limits.actuators[0].reading_age_ns);
  UNSIGNED_LONGS_EQUAL(500, read.settings->limits.position_error_cycles);
  UNSIGNED_LONGS_EQUAL(3, read.settings->most_overruns);
  const ActuatorLimits& second = read.settings->limits.actuators[1];
  LONGS_EQUAL(1'000'000'000, second.reading_age_ns);
  DOUBLES_EQUAL(-0.05, second.lowest_position, 0.0);
  DOUBLES_EQUAL(0.05, second.highest_position, 0.0);
  DOUBLES_EQUAL(0.4, second.speed, 0.0);
  UNSIGNED_LONGS_EQUAL(10, read.settings->limits.speed_cycles);
  UNSIGNED_LONGS_EQUAL(100, read.settings->limits.read_back_cycles);
  const InterlockSettings& interlock = read.settings->interlock;
  CHECK(!interlock.start_is_arm);
  UNSIGNED_LONGS_EQUAL(30, interlock.debounce);
  UNSIGNED_LONGS_EQUAL(1, interlock.start_hold);
  UNSIGNED_LONGS_EQUAL(10'001, interlock.longest_press);
  UNSIGNED_LONGS_EQUAL(1000, interlock.least_armed);
  UNSIGNED_LONGS_EQUAL(60'000, interlock.most_armed);
  UNSIGNED_LONGS_EQUAL(1000, interlock.most_stopping);
  DOUBLES_EQUAL(0.02, read.settings->profile.at(1.0)[0], 1e-12);
  DOUBLES_EQUAL(-1.5, read.settings->profile.at(1.0)[1], 1e-12);
  STRCMP_EQUAL("hydraulic", read.lines.hydraulic_enable.c_str());
}

TEST(LabImage, LimitOfLoadPressureMayBeThereAndIsThenOfEveryActuator) {
  CHECK(!parse_lab_image(image, "image", 1e-3).settings->limits.has_load_pressure());
  image += "limits.load_pressure 2e7,0x1p+20\n";
  const LabImage read = parse_lab_image(image, "image", 1e-3);
  STRCMP_EQUAL("", read.error.c_str());
  CHECK(read.settings->limits.has_load_pressure());
  DOUBLES_EQUAL(2e7, read.settings->limits.actuators[0].load_pressure, 0.0);
  DOUBLES_EQUAL(0x1p+20, read.settings->limits.actuators[1].load_pressure, 0.0);
  const char* const allowed = "allowed is 2 numbers, commas between them, from 1e-09 to 5e+07 Pa";
  for (const char* instead : {"2e7,0", "2e7", "2e7,-1", "2e7,5.00001e7", "inf,inf", "nan,nan"}) {
    refused("limits.load_pressure 2e7,0x1p+20", (std::string("limits.load_pressure ") + instead).c_str(), allowed);
  }
  refused("limits.load_pressure", "limits.load_presure", "limits.load_presure = 2e7,0x1p+20: unknown key");
}

TEST(LabImage, PeriodOfTheReadingsMayBeThereAndSaysOtherwiseOnceAPeriodOfTheLab) {
  const auto limits = [this](const char* value) {
    const LabImage read = parse_lab_image(image + "limits.reading_period " + value + "\n", "image", 1e-2);
    STRCMP_EQUAL("", read.error.c_str());
    return read.settings->limits;
  };
  const FaultLimits none = parse_lab_image(image, "image", 1e-2).settings->limits;
  LONGS_EQUAL(10'000'000, none.reading_due_ns(10'000'000));
  CHECK(!none.readings_answer_sync);
  LONGS_EQUAL(10'000'000, limits("sync").reading_due_ns(10'000'000));
  CHECK(limits("sync").readings_answer_sync);
  LONGS_EQUAL(1'000'000, limits("0x1.0624dd2f1a9fcp-10").reading_due_ns(10'000'000));
  CHECK(!limits("0.001").readings_answer_sync);
  LONGS_EQUAL(1'000'000'000, limits("0.001").longest_reading_age_ns());
  image += "limits.reading_period 0.001\n";
  const std::string line = "limits.reading_period 0.001";
  refused(line, "limits.reading_period 0", "allowed is a number from 0.0001 to 600 s");
  refused(line, "limits.reading_period 5e-05", "allowed is a number from 0.0001 to 600 s");
  refused(line, "limits.reading_period nan", "allowed is a number from 0.0001 to 600 s");
  refused(line, "limits.reading_period synch", "allowed is a number from 0.0001 to 600 s");
  refused(line, "limits.reading_period 0.0079", "above limits.reading_age of actuator 1: its readings would be stale");
  refused(line, "limits.reading_periode 0.001", "unknown key");
  STRCMP_CONTAINS("more than 32 frames of a message in a period of 0.0325 s",
                  parse_lab_image(image, "image", 0.0325).error.c_str());
}

TEST(LabImage, WhatCannotBeIsRefusedWithItsLine) {
  refused("topology lab", "topology simplex", "line 2: topology = simplex: allowed are lab");
  refused("actuators 2", "actuators 9", "allowed is a number from 1 to 8");
  refused("current_per_command 0.1", "current_per_command 0", "no command would move anything");
  refused("current_limit 0.02", "current_limit 1", "from 1e-09 to 0.032 A");
  refused("limits.highest_position 0.06,0.05", "limits.highest_position 0.06,-0.1", "of actuator 2 is above");
  refused("limits.highest_position 0.06,0.05", "limits.highest_position 0.06", "allowed is 2 numbers");
  refused("interlock.least_armed 1", "interlock.least_armed 0.9", "from 1 to 600 s");
  refused("interlock.debounce 0.03", "interlock.debounce 0", "from 0.005 to 1 s");
  refused("interlock.arming_timeout 60", "interlock.arming_timeout 2\ninterlock.stranger 1", "stranger");
  refused("interlock.start_hold 0", "interlock.start_hold 59.5", "no press would start");
  // Without a button of its own, starting takes an act of its own.
  refused("line.start start\n", "", "interlock.start_hold = 0: allowed is a number from 1");
  refused("rest_speed 0.001", "rest_speed nan", "rest_speed = nan");
  refused("line.arm arm\n", "", "missing key line.arm");
  refused("segment.0.to 0.03", "segment.1.to 0.03", "missing key segment.0.to");
  refused("segment.0.to 0.03,-0x1p+1", "segment.0.to 0.03", "allowed is 2 numbers, commas between them, from");
  refused("segment.0.to 0.03", "segment.0.to 0.03,1", "allowed is 2 numbers");
  refused("segment.0.duration 2", "segment.0.duration 2,3", "allowed is a number");
  refused("schema 1", "schema 1\nstranger 1", "stranger");
}

}  // namespace hotfire::firmware
