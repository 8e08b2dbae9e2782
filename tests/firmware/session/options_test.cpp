// SPDX-License-Identifier: Apache-2.0
#include "firmware/session/options.hpp"

#include <CppUTest/TestHarness.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <map>

#include "firmware/session/key_file.hpp"
#include "firmware/session/option_table.hpp"

namespace hotfire::firmware {

namespace {

/// Whether an option begins a line of a help.
bool lists(const std::string& help, std::string_view option) {
  return help.find("\n  " + std::string(option) + " ") != std::string::npos;
}

/// The options of one mode that these arguments give.
template <class Own>
Own accepted(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"hotfire-rt", std::string(Own::mode)});
  const ParsedOptions parsed = parse_options(arguments);
  STRCMP_EQUAL("", parsed.message.c_str());
  CHECK(parsed.options.has_value());
  CHECK(std::holds_alternative<Own>(*parsed.options));
  return std::get<Own>(*parsed.options);
}

void refused(std::vector<std::string> arguments, const char* message) {
  arguments.insert(arguments.begin(), "hotfire-rt");
  const ParsedOptions parsed = parse_options(arguments);
  CHECK(!parsed.options);
  LONGS_EQUAL(2, parsed.status);
  STRCMP_CONTAINS(message, parsed.message.c_str());
}

}  // namespace

TEST_GROUP(Options){};

TEST(Options, TimingRunsTenThousandCyclesAndAllowsNoOverrunByDefault) {
  const auto options = accepted<TimingOptions>({});
  UNSIGNED_LONGS_EQUAL(10'000, options.loop.cycles);
  CHECK(options.max_overruns == std::uint64_t{0});
  CHECK(!options.max_latency_us);
}

TEST(Options, PlantRunsUntilAskedToStopAndHasNoLimitByDefault) {
  const auto options = accepted<PlantOptions>({"--image", "p.image"});
  UNSIGNED_LONGS_EQUAL(0, options.loop.cycles);
  CHECK(!options.max_overruns);
}

TEST(Options, ValuesAreTakenFromTheNextArgumentOrAfterAnEqualsSign) {
  const auto options = accepted<TimingOptions>({"--period-us", "250", "--policy=skip", "--cpu", "1", "--max-latency-us=12.5",
                                                "--command", "sine", "--amplitude", "-0.02", "--json"});
  LONGS_EQUAL(250'000, options.loop.period_ns);
  CHECK(options.loop.policy == OverrunPolicy::skip);
  LONGS_EQUAL(1, *options.cpu);
  DOUBLES_EQUAL(12.5, *options.max_latency_us, 0.0);
  CHECK(options.source.shape == hotfire::hal::sim::CommandSource::Shape::sine);
  DOUBLES_EQUAL(-0.02, options.source.amplitude, 0.0);
  CHECK(options.json);
}

TEST(Options, PeriodOutsideItsRangeIsRefusedWithTheRange) {
  refused({"timing", "--period-us", "49"}, "--period-us 49: allowed is a whole number from 50 to 10000");
  refused({"timing", "--period-us", "10001"}, "from 50 to 10000");
}

TEST(Options, SchedulingByDeadlineExcludesACpuAndAnOrdinaryProcess) {
  CHECK(accepted<TimingOptions>({"--scheduler", "deadline"}).scheduler == Scheduler::deadline);
  refused({"timing", "--scheduler", "rr"}, "--scheduler rr: allowed is fifo");
  refused({"timing", "--scheduler", "deadline", "--cpu", "1"}, "exclude each other");
  refused({"timing", "--scheduler", "deadline", "--priority", "0"}, "exclude each other");
}

TEST(Options, LayoutOfACanBusIsTheSmallestThatHasRoomUnlessSaid) {
  CHECK(frame_layout(accepted<PlantOptions>({"--image", "p", "--bus", "can0", "--actuators", "2"})) == can::Layout::classic);
  CHECK(frame_layout(accepted<PlantOptions>({"--image", "p", "--bus", "can0", "--actuators", "3"})) == can::Layout::fd);
  CHECK(accepted<ControllerOptions>({"--bus", "can0", "--layout", "fd"}).layout == can::Layout::fd);
  refused({"plant", "--image", "p", "--bus", "can0", "--actuators", "3", "--layout", "classic"}, "room for 2 actuators");
  CHECK(accepted<ControllerOptions>({"--bus", "can0", "--layout", "fd-split"}).layout == can::Layout::fd_split);
}

TEST(Options, KeyNeedsFramesThatHaveRoomForACode) {
  STRCMP_EQUAL("k", accepted<ControllerOptions>({"--bus", "can0", "--layout", "fd", "--key", "k"}).key.c_str());
  refused({"controller", "--bus", "can0", "--key", "k"}, "--layout fd, or fd-split");
  refused({"plant", "--image", "p", "--key", "k"}, "--bus can0");
}

TEST(Options, KeyIsAFileOfItsDigitsThatNobodyElseMayUse) {
  const std::string path = "/tmp/hotfire-key-" + std::to_string(getpid());
  const auto with = [&](const std::string& content, mode_t mode) {
    std::ofstream(path) << content;
    chmod(path.c_str(), mode);
    const ReadKey read = read_key(path);
    remove(path.c_str());
    return read;
  };
  const std::string digits = "000102030405060708090a0b0c0d0e0F";
  for (const char* end : {"", "\n"}) {
    const ReadKey good = with(digits + end, 0600);
    CHECK(!good.refused);
    BYTES_EQUAL(0, good.key[0]);
    BYTES_EQUAL(15, good.key[15]);
  }
  STRCMP_CONTAINS("others may use it", with(digits, 0640).refused->what.c_str());
  STRCMP_CONTAINS("others may use it", with(digits, 0604).refused->what.c_str());
  for (const std::string& wrong :
       {std::string(), digits + "0", digits.substr(1), std::string("x00102030405060708090a0b0c0d0e0F"), digits + "\n\n"}) {
    STRCMP_CONTAINS("not a key", with(wrong, 0600).refused->what.c_str());
  }
  STRCMP_CONTAINS("No such file", read_key(path).refused->what.c_str());
  STRCMP_CONTAINS("not a file", read_key("/tmp").refused->what.c_str());
  STRCMP_CONTAINS("openssl rand -hex 16", read_key("/dev/zero").refused->remedy.c_str());
}

TEST(Options, WhatABusCannotDoIsRefused) {
  refused({"controller"}, "--bus can0");
  refused({"timing", "--sync", "can"}, "no bus that SYNC could be on");
  refused({"plant", "--image", "p", "--sync", "can"}, "--sync can needs the CAN bus");
  refused({"plant", "--image", "p", "--strings"}, "--strings is of a plant on a CAN bus");
  refused({"plant", "--image", "p", "--load-pressure"}, "--load-pressure is of a plant on a CAN bus");
  CHECK(accepted<PlantOptions>({"--image", "p", "--bus", "can0", "--load-pressure"}).load_pressure);
  CHECK(!accepted<PlantOptions>({"--image", "p", "--bus", "can0"}).load_pressure);
  refused({"plant", "--image", "p", "--bus", ""}, "the name of a CAN interface");
}

TEST(Options, WrongUseIsRefusedWithWhatIsAllowed) {
  refused({}, "plant, timing, controller, lab or replay");
  refused({"fly"}, "plant, timing, controller, lab or replay");
  refused({"plant"}, "hotfire plant --model");
  refused({"timing", "--perod-us", "500"}, "unknown argument --perod-us");
  refused({"timing", "--cycles"}, "--cycles needs a value");
  refused({"timing", "--json=yes"}, "--json takes no value");
  refused({"timing", "--policy", "hope"}, "catch-up, skip, stop");
  refused({"timing", "--amplitude", "nan"}, "a number from");
  refused({"timing", "--cycles", "-1"}, "a whole number");
  refused({"timing", "--cycles", "10x"}, "a whole number");
  refused({"timing", "--priority", "0", "--require-realtime"}, "exclude each other");
}

TEST(Options, AnOptionOfAnotherModeIsRefusedWithTheModesThatTakeIt) {
  const std::map<std::string, std::vector<const char*>> options_by_modes{
      {"plant, timing, lab",
       {"--image", "--record", "--overwrite", "--record-buffer-s", "--record-max-mib", "--max-dropped"}},
      {"plant, controller, lab",
       {"--bus", "--layout", "--key", "--freshness-ms", "--bit-rate", "--data-bit-rate", "--max-lost"}},
      {"plant, timing, controller", {"--actuators", "--command", "--amplitude", "--frequency"}},
      {"plant, timing", {"--sync", "--max-missed-syncs", "--sync-patience-ms"}},
      {"plant, controller", {"--command-per-current"}},
      {"plant", {"--command-age-ms", "--heartbeat-age-ms", "--heartbeat-optional", "--strings", "--load-pressure"}},
      {"controller", {"--lockstep"}},
      {"lab", {"--gpio", "--confirm", "--rehearsal"}}};
  std::size_t limited = 0;
  for (const auto& [modes, options] : options_by_modes) {
    for (const char* option : options) {
      ++limited;
      for (const std::string mode : {"plant", "timing", "controller", "lab"}) {
        const std::string refusal =
            std::string(option) + " is not an option of " + mode + "; it is an option of " + modes + ";";
        const ParsedOptions parsed = parse_options({"hotfire-rt", mode, option, "1"});
        const bool taken = (", " + modes + ",").find(", " + mode + ",") != std::string::npos;
        CHECK_EQUAL_TEXT(!taken, parsed.message.find(refusal) != std::string::npos, (mode + " " + option).c_str());
      }
    }
  }
  // All others are of every run.
  const auto lines = option_lines();
  const auto of_every_run = [](const OptionLine& line) { return line.modes == std::array{true, true, true, true, false}; };
  LONGS_EQUAL(lines.size() - limited, std::count_if(lines.begin(), lines.end(), of_every_run));
}

TEST(Options, KeyOfAVehicleWhoseFileDecidesTheLayoutIsTaken) {
  STRCMP_EQUAL("k", accepted<PlantOptions>({"--image", "p", "--bus", "can0", "--key", "k"}).key.c_str());
  refused({"plant", "--image", "p", "--bus", "can0", "--actuators", "2", "--key", "k"}, "--layout fd, or fd-split");
}

TEST(Options, LabThatMovesRealActuatorsNeedsARecordingADigestAndRealTime) {
  const std::vector<std::string> lab{"--image", "p", "--bus", "can0", "--gpio", "rig"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), lab.begin(), lab.end());
    return more;
  };
  const auto options = accepted<LabOptions>(with({"--record", "run.hfr", "--confirm", "0123456789abcdef"}));
  STRCMP_EQUAL("0123456789abcdef", options.confirm.c_str());
  CHECK(!options.rehearsal);
  const auto refused_lab = [&](std::vector<std::string> more, const char* message) {
    std::vector<std::string> arguments = with(std::move(more));
    arguments.insert(arguments.begin(), "lab");
    refused(arguments, message);
  };
  refused_lab({}, "it needs --record FILE, --confirm DIGEST");
  refused_lab({"--record", "run.hfr"}, "--confirm DIGEST");
  refused_lab({"--confirm", "0123456789abcdef"}, "--record FILE");
  refused_lab({"--record", "run.hfr", "--confirm", "0123456789abcdef", "--priority", "0"}, "real time");
  CHECK(accepted<LabOptions>(with({"--rehearsal", "--priority", "0"})).rehearsal);
  refused_lab({"--rehearsal", "--policy", "catch-up"}, "leave --policy out");
}

TEST(Options, RecordingAndItsLimitsAreRead) {
  const auto options = accepted<PlantOptions>({"--image", "p", "--record", "run.hfr", "--record-buffer-s", "2.5",
                                               "--record-max-mib=64", "--overwrite", "--max-dropped", "7", "--actuators",
                                               "8", "--sync", "sim", "--max-missed-syncs", "0"});
  STRCMP_EQUAL("run.hfr", options.recording.c_str());
  DOUBLES_EQUAL(2.5, options.record_buffer_s, 0.0);
  UNSIGNED_LONGS_EQUAL(64, options.record_max_mib);
  CHECK(options.overwrite);
  UNSIGNED_LONGS_EQUAL(7, options.max_dropped);
  UNSIGNED_LONGS_EQUAL(8, options.actuators);
  CHECK(options.actuators_given);
  CHECK(!accepted<PlantOptions>({"--image", "p"}).actuators_given);
  CHECK(options.pace == PaceKind::sim);
  UNSIGNED_LONGS_EQUAL(0, options.most_missed_syncs);
  refused({"plant", "--image", "p", "--actuators", "9"}, "from 1 to 8");
  refused({"plant", "--image", "p", "--sync", "gps"}, "clock, sim, can");
  refused({"timing", "--record", "run.hfr"}, "--record needs a model");
}

TEST(Options, ReplayTakesOneRecording) {
  const auto options = accepted<ReplayOptions>({"run.hfr", "--json"});
  CHECK(options.json);
  STRCMP_EQUAL("run.hfr", options.recording.c_str());
  refused({"replay"}, "needs a recording");
  refused({"replay", "a.hfr", "b.hfr"}, "unknown argument b.hfr");
  refused({"replay", "a.hfr", "--image"}, "unknown argument --image");
}

TEST(Options, HelpOfAModeNamesItsOptionsAndNoOther) {
  const std::array<std::string, 4> modes{"plant", "timing", "controller", "lab"};
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const ParsedOptions parsed = parse_options({"hotfire-rt", modes[i], "--help"});
    LONGS_EQUAL(0, parsed.status);
    STRCMP_CONTAINS(("\n  hotfire " + modes[i] + " ").c_str(), parsed.message.c_str());
    STRCMP_CONTAINS("\nExit status: 0 good; ", parsed.message.c_str());
    for (const OptionLine& line : option_lines()) {
      CHECK_EQUAL_TEXT(line.modes[i], lists(parsed.message, line.name), (modes[i] + " " + std::string(line.name)).c_str());
    }
  }
  const std::string timing = help_of("timing");
  CHECK(lists(timing, "--find") && lists(timing, "--model") && !lists(timing, "--profile"));
}

TEST(Options, HelpOfEveryModeNamesTheModesOfAnOption) {
  const ParsedOptions parsed = parse_options({"hotfire-rt", "--help"});
  for (const OptionLine& line : option_lines()) {
    CHECK_TEXT(lists(parsed.message, line.name), std::string(line.name).c_str());
  }
  STRCMP_CONTAINS(("  --gpio CHIP" + std::string(17, ' ') + "lab: GPIO chip").c_str(), parsed.message.c_str());
  STRCMP_CONTAINS(("  --cpu C" + std::string(21, ' ') + "run on this CPU only").c_str(), parsed.message.c_str());
}

TEST(Options, HelpIsAtMostAHundredColumnsWideInItsTable) {
  for (const char* mode : {"", "plant", "timing", "controller", "lab", "replay"}) {
    const std::string help = help_of(mode);
    const std::string table = help.substr(help.find("\nOptions:"), help.rfind("\n\n") - help.find("\nOptions:"));
    std::size_t longest = 0;
    for (std::size_t at = 0, end = 0; at < table.size(); at = end + 1) {
      end = std::min(table.find('\n', at), table.size());
      longest = std::max(longest, end - at);
    }
    CHECK_TEXT(longest > 30 && longest <= 100, mode);
  }
}

}  // namespace hotfire::firmware
