// SPDX-License-Identifier: Apache-2.0
#include "tools/files/rig/profile_file.hpp"

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"

namespace hotfire {

using test::refusal;

TEST_GROUP(ProfileFile) {
  test::Scratch scratch;
  std::string head =
      "schema = 1\n[lab]\nactuators = 1\npiston_per_command = \"0.5 m/rad\"\ncurrent_per_command = 0.125\n"
      "current_per_error = 0\ncurrent_limit = \"20 mA\"\napproach_rate = 0.5\nrest_speed = \"1 mm/s\"\n"
      "stopping_time = 2\n[limits]\ncommand_age = \"2 ms\"\nreading_age = \"2 ms\"\nlowest_reading = -0.5\n"
      "highest_reading = 0.5\ndisagreement = 0.001\nlowest_position = -0.0625\nhighest_position = 0.0625\n"
      "command_rate = 40\nspeed = 50\nposition_error = 0.02\nposition_error_time = 0.3\n[lines]\nemergency_stop = "
      "\"estop\"\n"
      "hydraulic_enable = \"hydraulic\"\narm = \"arm\"\nsupply = \"supply\"\nheartbeat = \"heartbeat\"\nfault = \"fault\"\n";

  std::string lines(const std::string& profile) const { return load_profile(scratch.write("p.toml", head + profile)).image; }

  void refused(const std::string& profile, std::initializer_list<const char*> parts) const {
    test::expect_message(refusal([&] { lines(profile); }), parts);
  }
  void refused_head(const std::string& line, const std::string& instead, std::initializer_list<const char*> parts) {
    const std::string whole = head;
    head.replace(head.find(line), line.size(), instead);
    refused("[[profile]]\nkind = \"rest\"\nduration = 1\n", parts);
    head = whole;
  }
};

TEST(ProfileFile, ProfileBecomesLinesOfAnImageInSi) {
  const std::string text = lines(
      "[[profile]]\nkind = \"steps\"\nlevels = [0, 0.0625]\nhold = \"500 ms\"\n[[profile]]\nkind = \"sweep\"\n"
      "amplitude = 0.0625\nfrom = 0.25\nto = 8\nduration = 4\n[[profile]]\nkind = \"sines\"\namplitudes = [0.0625, 0.125]\n"
      "frequencies = [1, 2]\nperiods = 3\n[[profile]]\nkind = \"table\"\ntimes = [0, 1, 3]\ncommands = [0, 0.125, 0]\n"
      "[[profile]]\nkind = \"rest\"\nduration = 1\n");
  test::expect_message(
      text,
      {"topology lab\nactuators 1\npiston_per_command 0x1p-1\n", "limits.command_age 0x1.0624dd2f1a9fcp-9\n",
       "limits.overruns 0\nline.emergency_stop estop\n", "interlock.debounce 0x1.eb851eb851eb8p-6\n",
       "interlock.arming_timeout 0x1.ep+5\ninterlock.start_hold 0x1p+0\n", "segment.2.from 0x1p-4\nsegment.2.to 0x1p-4\n",
       "segment.4.amplitude 0x1p-4\nsegment.4.frequency 0x1p-2\nsegment.4.last_frequency 0x1p+3\n",
       "segment.11.duration 0x1p+1\nsegment.11.from 0x1p-3\nsegment.11.to 0x0p+0\n", "segment.12.duration 0x1p+0\n"});
}

TEST(ProfileFile, WhereAStretchDoesNotBeginWhereTheOneBeforeHasEndedAStraightLineAtTheSlewRateLeadsThere) {
  head.replace(head.find("approach_rate"), 0, "slew_rate = 0.25\n");
  const std::string text = lines(
      "[[profile]]\nkind = \"steps\"\nlevels = [0, 0.0625]\nhold = 1\n[[profile]]\nkind = \"sweep\"\namplitude = 0.0625\n"
      "from = 1\nto = 1\nduration = \"250 ms\"\n[[profile]]\nkind = \"rest\"\nduration = 1\n");
  // Up 1/16 rad in 1/4 s of the level's own time; down again to where the sweep begins; the sweep ends at its peak, and the
  // rest is 1/4 s away.
  test::expect_message(
      text, {"segment.1.duration 0x1p-2\nsegment.1.from 0x0p+0\nsegment.1.to 0x1p-4\n",
             "segment.2.duration 0x1.8p-1\nsegment.2.from 0x1p-4\nsegment.2.to 0x1p-4\n",
             "segment.3.duration 0x1p-2\nsegment.3.from 0x1p-4\nsegment.3.to 0x0p+0\n",
             "segment.4.duration 0x1p-2\nsegment.4.from 0x0p+0\n",
             "segment.5.duration 0x1p-2\nsegment.5.from 0x1p-4\nsegment.5.to 0x0p+0\n", "segment.6.duration 0x1.8p-1\n"});
}

TEST(ProfileFile, RateBeyondALimitIsRefusedBeforeAnythingIsDriven) {
  head.replace(head.find("command_rate = 40"), 17, "command_rate = 0.5");
  // 0.5 m/s are 1 rad/s; of the line, of the sine at its fastest, and of both together.
  lines("[[profile]]\nkind = \"table\"\ntimes = [0, 1]\ncommands = [-0.1, 0.1]\n");
  refused("[[profile]]\nkind = \"table\"\ntimes = [0, 0.1]\ncommands = [-0.06, 0.06]\n",
          {"profile.0", "by up to 1.2 rad/s", "limits.command_rate", "1 rad/s"});
  lines("[[profile]]\nkind = \"sweep\"\namplitude = 0.1\nfrom = 0.1\nto = 1.5\nduration = 10\n");
  refused("[[profile]]\nkind = \"sweep\"\namplitude = 0.1\nfrom = 0.1\nto = 1.6\nduration = 10\n",
          {"profile.0", "limits.command_rate"});
  refused("[[profile]]\nkind = \"sines\"\namplitudes = [0.1]\nfrequencies = [1, 1.6]\nperiods = 1\n",
          {"limits.command_rate"});
  refused_head("approach_rate = 0.5", "approach_rate = 1.5", {"lab.approach_rate", "allow 1 rad/s"});
  refused_head("approach_rate = 0.5", "approach_rate = 0.5\nslew_rate = 1.01", {"lab.slew_rate", "allow 1 rad/s"});
  refused_head("speed = 50", "speed = 0.2", {"lab.approach_rate", "allow 0.4 rad/s"});
}

TEST(ProfileFile, LimitsOfAnActuatorAreOneForAllOrAListWithOneForEach) {
  head.replace(head.find("actuators = 1"), 13, "actuators = 2");
  head.replace(head.find("speed = 50"), 10, "speed = [50, 25]");
  head.replace(head.find("highest_position = 0.0625"), 25, "highest_position = [0.0625, 0.03125]");
  const std::string text = lines("[[profile]]\nkind = \"rest\"\nduration = 1\n");
  test::expect_message(text, {"limits.speed 0x1.9p+5,0x1.9p+4\n", "limits.highest_position 0x1p-4,0x1p-5\n",
                              "limits.lowest_position -0x1p-4,-0x1p-4\n"});
  refused("[[profile]]\nkind = \"steps\"\nlevels = [0, 0.0626]\nhold = 1\n", {"the commands of actuator 2, "});
  refused_head("[50, 25]", "[50]", {"limits.speed", "for all actuators, or a list of 2, one for each"});
}

TEST(ProfileFile, LimitOfLoadPressureNeedNotBeSaidAndLeavesNoLineThen) {
  const std::string rest = "[[profile]]\nkind = \"rest\"\nduration = 1\n";
  CHECK(lines(rest).find("load_pressure") == std::string::npos);
  head.replace(head.find("actuators = 1"), 13, "actuators = 2");
  const std::string without = lines(rest);
  head.replace(head.find("speed = 50"), 10, "speed = 50\nload_pressure = \"16 MPa\"");
  std::string with = lines(rest);
  const std::string line = "limits.load_pressure 0x1.e848p+23,0x1.e848p+23\n";
  CHECK(with.find(line) != std::string::npos);
  STRCMP_EQUAL(without.c_str(), with.erase(with.find(line), line.size()).c_str());
  head.replace(head.find("\"16 MPa\""), 8, "[16e6, 8e6]");
  test::expect_message(lines(rest), {"limits.load_pressure 0x1.e848p+23,0x1.e848p+22\n"});
  refused_head("[16e6, 8e6]", "[16e6]", {"p.toml:21", "limits.load_pressure", "for all actuators, or a list of 2"});
  refused_head("[16e6, 8e6]", "0", {"p.toml:21", "limits.load_pressure", "allowed: 1e-09 to 5e+07 Pa"});
  refused_head("[16e6, 8e6]", "\"51 MPa\"", {"p.toml:21", "limits.load_pressure", "allowed: 1e-09 to 5e+07 Pa"});
  refused_head("[16e6, 8e6]", "\"16 mm\"", {"p.toml:21", "limits.load_pressure"});
  refused_head("load_pressure", "load_presure", {"p.toml:21", "did you mean \"load_pressure\"?"});
}

TEST(ProfileFile, PeriodOfTheReadingsNeedNotBeSaidAndIsATimeOrSync) {
  const std::string rest = "[[profile]]\nkind = \"rest\"\nduration = 1\n";
  CHECK(lines(rest).find("reading_period") == std::string::npos);
  head.replace(head.find("speed = 50"), 10, "speed = 50\nreading_period = \"sync\"");
  test::expect_message(lines(rest), {"limits.reading_period sync\n"});
  head.replace(head.find("\"sync\""), 6, "\"1 ms\"");
  test::expect_message(lines(rest), {"limits.reading_period 0x1.0624dd2f1a9fcp-10\n"});
  refused_head("\"1 ms\"", "\"50 us\"", {"p.toml:21", "limits.reading_period", "allowed: 0.0001 to 600 s"});
  refused_head("\"1 ms\"", "\"2.1 ms\"", {"p.toml:21", "limits.reading_period", "up to limits.reading_age, 0.002 s"});
  refused_head("\"1 ms\"", "\"synch\"", {"p.toml:21", "limits.reading_period"});
  refused_head("\"1 ms\"", "\"1 mm\"", {"p.toml:21", "limits.reading_period"});
  refused_head("reading_period", "reading_perod", {"p.toml:21", "did you mean \"reading_period\"?"});
}

TEST(ProfileFile, InterlockAndLinesThatNeedNotBeSaidAreReadWhereTheyAre) {
  head += "start = \"go\"\nsupply_read_back = \"contactor\"\nfault_read_back = \"lamp\"\n";
  const std::string rest = "[[profile]]\nkind = \"rest\"\nduration = 1\n";
  test::expect_message(lines(rest), {"line.start go\n", "line.supply_read_back contactor\n", "line.fault_read_back lamp\n",
                                     "interlock.start_hold 0x0p+0\n"});
  test::expect_message(lines("[interlock]\ndebounce = \"50 ms\"\nleast_armed = 4\narming_timeout = 32\nlongest_press = 8\n"
                             "start_hold = 2\n" +
                             rest),
                       {"interlock.debounce 0x1.999999999999ap-5\ninterlock.longest_press 0x1p+3\ninterlock.least_armed "
                        "0x1p+2\ninterlock.arming_timeout 0x1p+5\ninterlock.start_hold 0x1p+1\n"});
  refused("[interlock]\nleast_armed = \"999 ms\"\n" + rest, {"interlock.least_armed", "1 to 600 s"});
  refused("[interlock]\ndebounce = \"4 ms\"\n" + rest, {"interlock.debounce", "0.005 to 1 s"});
  refused("[interlock]\nbounce = 1\n" + rest, {"bounce"});
  refused_head("start = \"go\"", "start = \"arm\"", {"lines.start", "a line of its own"});
  head.erase(head.find("start = \"go\"\n"), 13);
  refused("[interlock]\nstart_hold = 0.5\n" + rest, {"interlock.start_hold", "1 to 60 s"});
}

TEST(ProfileFile, DigestIsOfAllThatTheRealTimeSideReads) {
  const std::string rest = "[[profile]]\nkind = \"rest\"\nduration = 1\n";
  const auto digest = [&] { return load_profile(scratch.write("p.toml", head + rest)).digest; };
  const std::uint64_t before = digest();
  CHECK_EQUAL(before, digest());
  head += "# a remark\n";
  CHECK_EQUAL(before, digest());
  head.replace(head.find("disagreement = 0.001"), 20, "disagreement = 0.002");
  CHECK(before != digest());
}

TEST(ProfileFile, ASineOrASweepSwingsAboutItsBiasAndIsHeldToTheLimitsThere) {
  const std::string text = lines(
      "[[profile]]\nkind = \"sines\"\namplitudes = [0.0625]\nfrequencies = [1]\nperiods = 3\nbias = -0.0625\n"
      "[[profile]]\nkind = \"sweep\"\namplitude = 0.0625\nfrom = 1\nto = 2\nduration = 4\nbias = 0.03125\n");
  test::expect_message(text, {"segment.0.from -0x1p-4\nsegment.0.to -0x1p-4\nsegment.0.amplitude 0x1p-4\n",
                              "segment.2.from 0x1p-5\nsegment.2.to 0x1p-5\nsegment.2.amplitude 0x1p-4\n"});
  refused("[[profile]]\nkind = \"sines\"\namplitudes = [0.0625]\nfrequencies = [1]\nperiods = 3\nbias = 0.0635\n",
          {"limits.highest_position"});
}

TEST(ProfileFile, OtherPartsTakeThePlaceOfItsOwnAndAllElseStays) {
  const auto path = scratch.write("p.toml", head + "[[profile]]\nkind = \"rest\"\nduration = 1\n");
  const LabProfile was = load_profile(path);
  const std::string text = profile_with_parts(path, "[[profile]]\nkind = \"rest\"\nduration = 2\n");
  const LabProfile is = load_profile(scratch.write("q.toml", text));
  DOUBLES_EQUAL(2.0, is.duration, 0.0);
  DOUBLES_EQUAL(0.125, is.highest_command, 0.0);
  DOUBLES_EQUAL(80.0, is.command_rate, 0.0);
  const auto settings_of = [](const std::string& image) { return image.substr(0, image.find("segment.0.")); };
  STRCMP_EQUAL(settings_of(was.image).c_str(), settings_of(is.image).c_str());
}

TEST(ProfileFile, AnAngleIsOneForAllActuatorsOrAListWithOneForEach) {
  head.replace(head.find("actuators = 1"), 13, "actuators = 2");
  const std::string text = lines(
      "[[profile]]\nkind = \"steps\"\nlevels = [0.0625, [0.0625, -0.125]]\nhold = 1\n[[profile]]\nkind = \"sweep\"\n"
      "amplitude = [\"0 rad\", 0.0625]\nfrom = 1\nto = 2\nduration = 4\n[[profile]]\nkind = \"sines\"\n"
      "amplitudes = [[0.125, 0.0625]]\nfrequencies = [1, 2]\nperiods = 3\n[[profile]]\nkind = \"table\"\ntimes = [0, 1]\n"
      "commands = [0, [0.125, 0.0625]]\n");
  test::expect_message(
      text, {"segment.0.from 0x1p-4,0x1p-4\n", "segment.2.to 0x1p-4,-0x1p-3\n", "segment.4.amplitude 0x0p+0,0x1p-4\n",
             "segment.7.amplitude 0x1p-3,0x1p-4\n", "segment.8.from 0x0p+0,0x0p+0\nsegment.8.to 0x1p-3,0x1p-4\n"});
  refused("[[profile]]\nkind = \"steps\"\nlevels = [[0, 0, 0]]\nhold = 1\n",
          {"profile.0.levels", "for all actuators, or a list of 2, one for each"});
  refused("[[profile]]\nkind = \"steps\"\nlevels = [[0, 0.126]]\nhold = 1\n", {"the commands of actuator 2, ", "0.126 rad"});
}

TEST(ProfileFile, WhatCannotBeIsRefusedWithItsLineAndWhatIsAllowed) {
  refused("", {"profile: missing; declare at least one"});
  refused("[[profile]]\nkind = \"swep\"\n", {"p.toml:31", "profile.0.kind", "did you mean \"sweep\"?"});
  refused("[[profile]]\nkind = \"rest\"\n", {"profile.0.duration: missing"});
  refused("[[profile]]\nkind = \"rest\"\nduration = \"1 m\"\n", {"profile.0.duration"});
  refused("[[profile]]\nkind = \"steps\"\nlevels = []\nhold = 1\n",
          {"profile.0.levels", "a list, each entry a number in rad"});
  refused("[[profile]]\nkind = \"sines\"\namplitudes = [0.01]\nfrequencies = [1]\nperiods = 0\n",
          {"profile.0.periods", "1 to"});
  refused("[[profile]]\nkind = \"table\"\ntimes = [0, 2, 1]\ncommands = [0, 0, 0]\n", {"rising, but 1 follows 2"});
  refused("[[profile]]\nkind = \"table\"\ntimes = [0, 2]\ncommands = [0]\n", {"as many as commands"});
  refused_head("current_limit = \"20 mA\"", "current_limit = \"40 mA\"", {"lab.current_limit", "0.032 A"});
  refused_head("actuators = 1", "actuators = 9", {"lab.actuators", "1 to 8"});
  refused_head("supply = \"supply\"", "supply = \"two words\"", {"lines.supply", "without spaces"});
  refused_head("disagreement = 0.001\n", "", {"limits.disagreement: missing; allowed: a number in m"});
  refused_head("rest_speed", "rest_sped", {"rest_sped"});
}

TEST(ProfileFile, PositionBeyondTheLimitsIsRefusedBeforeAnythingIsDriven) {
  refused("[[profile]]\nkind = \"steps\"\nlevels = [0, 0.126]\nhold = 1\n",
          {"profile.0", "0.126 rad", "limits.highest_position"});
  refused("[[profile]]\nkind = \"sweep\"\namplitude = 0.13\nfrom = 1\nto = 2\nduration = 1\n", {"limits.lowest_position"});
}

TEST(ProfileFile, TheProfileOfTheDocumentationIsGood) {
  CHECK(is_profile(HOTFIRE_LAB_PROFILE));
  const LabProfile profile = load_profile(HOTFIRE_LAB_PROFILE);
  // A sweep, five steps, nine sines and a table; the lines to where a level is are in its own time.
  const double parts = 60.0 + 10.0 + 3 * (20.0 + 10.0 + 5.0) + 3.0;
  DOUBLES_EQUAL(parts, profile.duration, 1e-9);
  test::expect_message(profile.image, {"topology lab\n", "segment.0.amplitude", "line.arm arm\n"});
}

}  // namespace hotfire
