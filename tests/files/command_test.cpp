// SPDX-License-Identifier: Apache-2.0
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"

namespace hotfire {

using test::expect_message;

TEST_GROUP(Command) {
  test::Scratch scratch;
  std::string out;
  std::string err;

  /// Runs `hotfire` with these arguments and keeps what it prints. Returns its
  /// exit status.
  int status_of(const std::string& arguments) {
    const auto read = [](const std::filesystem::path& path) {
      std::ifstream file(path);
      return std::string(std::istreambuf_iterator<char>(file), {});
    };
    const auto printed = scratch.path("out");
    const auto complained = scratch.path("err");
    const std::string line =
        std::string{HOTFIRE_PROGRAM} + " " + arguments + " >" + printed.string() + " 2>" + complained.string();
    const int status = std::system(line.c_str());
    out = read(printed);
    err = read(complained);
    return WEXITSTATUS(status);
  }

  std::string record() const { return scratch.write("good.csv", "time[s],command[deg]\n0,0\n0.002,1\n0.004,1\n").string(); }
  /// Long enough for Welch's method, and no sine.
  static std::string ramp() {
    std::string text = "time[s],command[deg]\n";
    for (int row = 0; row < 2000; ++row) {
      text += std::to_string(0.01 * row) + "," + std::to_string(1e-4 * row) + "\n";
    }
    return text;
  }
  std::string model() const {
    return scratch
        .write("good.toml",
               "schema = 1\nname = \"bench\"\ntopology = \"simplex\"\n[effects.backlash]\nhalf_width = \"0.1 mm\"\n")
        .string();
  }
};

TEST(Command, check_says_what_each_file_is_in_one_line_and_nothing_else) {
  LONGS_EQUAL(0, status_of("check " + model() + " " + record()));
  expect_message(out, {"good.toml: model \"bench\", topology simplex, effects: backlash", "engine.inertia",
                       "good.csv: record, 3 rows, period 0.002 s (500 Hz)", "command[rad]"});
  LONGS_EQUAL(2, std::count(out.begin(), out.end(), '\n'));
  STRCMP_EQUAL("", err.c_str());
}

TEST(Command, check_looks_at_every_file_before_it_exits_with_6) {
  const std::string bad = scratch.write("bad.csv", "time[s],piston[m]\n0,x\n").string();
  LONGS_EQUAL(6, status_of("check " + bad + " " + record() + " none.toml odd.xls"));
  expect_message(out, {"bad.csv: refused", "good.csv: record", "none.toml: refused", "odd.xls: refused"});
  expect_message(err, {"hotfire: ", "bad.csv:2: column piston: \"x\"", "none.toml: cannot be opened",
                       ".toml (a model, a profile or a CAN schedule), .csv (a record)", ".log (a candump log)"});
}

TEST(Command, check_prints_json_on_request) {
  LONGS_EQUAL(6, status_of("check --json " + model() + " " + record() + " none.csv"));
  expect_message(out, {"\"kind\": \"model\"", "\"effects\": [\n      \"backlash\"\n    ]", "\"rows\": 3",
                       "\"period\": 0.002", "\"good\": false", "\"error\": \"none.csv: cannot be opened"});
}

TEST(Command, a_misspelt_word_is_wrong_use_and_named_with_the_nearest_known_one) {
  LONGS_EQUAL(2, status_of("chekc x"));
  expect_message(err, {"hotfire: unknown argument \"chekc\"", "did you mean \"check\"?", "'hotfire --help'"});
  LONGS_EQUAL(2, status_of("simulate --modl x"));
  expect_message(err, {"unknown argument \"--modl\"", "did you mean \"--model\"?", "'hotfire simulate --help'"});
  STRCMP_EQUAL("", out.c_str());
}

TEST(Command, without_what_it_needs_is_wrong_use) {
  LONGS_EQUAL(2, status_of(""));
  expect_message(err, {"missing: a command", "'hotfire new rig'"});
  LONGS_EQUAL(2, status_of("check"));
  expect_message(err, {"hotfire: missing: FILE;", "'hotfire check --help'"});
  LONGS_EQUAL(2, status_of("explain"));
  STRCMP_EQUAL(
      "hotfire: missing: --model, --out, records; 'hotfire new rig' makes a project that has them; see 'hotfire explain "
      "--help'\n",
      err.c_str());
  LONGS_EQUAL(2, status_of("simulate --model m --input i --output o --fit-start=-3"));
}

TEST(Command, keys_describes_a_table_an_effect_and_a_key) {
  LONGS_EQUAL(0, status_of("keys"));
  expect_message(out, {"servovalve", "gimbal_friction", "at engine_torque"});
  LONGS_EQUAL(0, status_of("keys gimbal_friction servovalve.rated_flow"));
  expect_message(out, {"[effects.gimbal_friction]", "law = \"coulomb\"", "coulomb_torque = ", "N.m",
                       "of vibrated_lugre only", "[servovalve]\nrated_flow = 0.003155 m^3/s, allowed: "});
  CHECK(out.find("position_gain") == std::string::npos);
  LONGS_EQUAL(0, status_of("keys --topology taos --json gimbal"));
  expect_message(out, {"\"table\": \"gimbal\"", "\"key\": \"thrust\"", "\"unit\": \"N\""});
  LONGS_EQUAL(2, status_of("keys servovalve.rated_flwo"));
  expect_message(err, {"rated_flwo", "servovalve.rated_flow", "'hotfire keys --topology simplex'"});
}

TEST(Command, every_key_that_keys_names_is_taken_by_a_model_file_with_its_reference_value) {
  // The table of a declared part as `keys` prints it is one of a model file, up to the unit of each line.
  LONGS_EQUAL(0, status_of("keys servovalve actuator structure engine"));
  std::string text = "schema = 1\ntopology = \"simplex\"\n";
  std::istringstream lines(out);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[")) {
      text += line + "\n";
    } else if (!line.starts_with(" ")) {
      text += line.substr(0, line.find_first_of(" ,", line.find(" = ") + 3)) + "\n";
    }
  }
  CHECK(std::count(text.begin(), text.end(), '\n') > 20);
  LONGS_EQUAL(0, status_of("check " + scratch.write("keys.toml", text).string()));
}

TEST(Command, a_file_that_is_not_there_is_named_with_the_one_that_may_be_meant) {
  const std::string path = model();
  LONGS_EQUAL(6, status_of("check " + path.substr(0, path.size() - 5) + "s.toml"));
  expect_message(err, {"goods.toml: cannot be opened", "did you mean \"", "/good.toml\"?"});
  LONGS_EQUAL(6, status_of("convert " + record() + " " + scratch.path("none").string() + "/run.mf4"));
  expect_message(err, {"cannot be written", "mkdir -p ", "/none"});
}

TEST(Command, help_has_an_example_and_every_command_prints_its_version) {
  for (const std::string command : {"", "check ", "simulate ", "sweep ", "step ", "stiffness ", "hammer ", "quiescent ",
                                    "strings ", "findings ", "import ", "header ", "keys "}) {
    LONGS_EQUAL(0, status_of(command + "--help"));
    expect_message(out, {"Example: hotfire"});
    LONGS_EQUAL(0, status_of(command + "--version"));
    expect_message(out, {"0."});
  }
}

TEST(Command, simulate_writes_a_mass_that_no_record_measured_in_the_unit_of_its_force) {
  const std::string mass =
      scratch.write("mass.toml", "schema = 1\nname = \"m\"\ntopology = \"direct\"\n[mass]\ninertia = 2\n").string();
  const auto output = scratch.path("moved.csv");
  for (const auto& [force, header] : {std::pair{"N", "position[m]"}, {"N.m", "position[rad]"}, {"V", "position[1]"}}) {
    const std::string text = "time[s],force[" + std::string(force) + "]\n0,0\n0.002,1\n0.004,1\n";
    const std::string input = scratch.write("force.csv", text).string();
    LONGS_EQUAL(0, status_of("simulate --model " + mass + " --input " + input + " --output " + output.string()));
    std::ifstream file(output);
    std::string line;
    std::getline(file, line);
    STRCMP_CONTAINS(header, line.c_str());
    LONGS_EQUAL(0, status_of("check " + output.string()));
  }
}

TEST(Command, simulate_writes_a_record_on_the_grid_of_its_input_and_one_line) {
  const std::string output = scratch.path("model.csv").string();
  LONGS_EQUAL(0, status_of("simulate --model " + model() + " --input " + record() + " --output " + output));
  expect_message(out, {"model.csv: 3 rows", "times faster than real time"});
  LONGS_EQUAL(1, std::count(out.begin(), out.end(), '\n'));
  LONGS_EQUAL(0, status_of("check " + output));
  expect_message(out, {"3 rows, period 0.002 s", "command[rad], piston[m], engine[rad], load_pressure[Pa]"});
}

TEST(Command, header_writes_the_parameters_of_one_axis_as_exact_constants) {
  const auto header = scratch.path("image.hpp");
  LONGS_EQUAL(0, status_of("header --model " + model() + " --name kBench --output " + header.string()));
  std::ifstream file(header);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  expect_message(text, {"from \"good.toml\"", "ImageEntry kBench[] = {", "    {\"engine.inertia\", 0x1.289p+13},\n",
                        "    {\"effects.backlash.half_width\", 0x1.a36e2eb1c432dp-14},\n"});
  const std::string taos = scratch.write("taos.toml", "schema = 1\ntopology = \"taos\"\n").string();
  LONGS_EQUAL(2, status_of("header --model " + taos + " --output " + header.string()));
  expect_message(err, {"a header holds one axis"});
  LONGS_EQUAL(0, status_of("header --json --model " + model() + " --output " + header.string()));
  expect_message(out, {"\"output\"", "\"name\": \"kPlantImage\""});
  LONGS_EQUAL(2, status_of("header --name 2nd --model " + model() + " --output " + header.string()));
  expect_message(err, {"--name 2nd", "a C++ name"});
}

TEST(Command, a_test_on_a_model_is_analysed_again_from_its_record) {
  const std::string kept = scratch.path("test.csv").string();
  const std::string bench = model();
  LONGS_EQUAL(0, status_of("step --model " + bench + " --amplitudes 0.4 --hold 0.5 --json --output " + kept));
  const std::string simulated = out;
  expect_message(simulated, {"\"engine\"", "\"overshoot\"", "\"hesitation\""});
  LONGS_EQUAL(0, status_of("step --record " + kept + " --hold 0.5 --json"));
  STRCMP_EQUAL(simulated.c_str(), out.c_str());
  LONGS_EQUAL(0, status_of("sweep --model " + bench + " --profile sines --from 6 --to 10 --count 9 --picture " +
                           scratch.path("bode.svg").string()));
  expect_message(out, {"piston at 0.4 deg", "notch 7."});
  CHECK_TRUE(std::filesystem::exists(scratch.path("bode.svg")));
  LONGS_EQUAL(0, status_of("hammer --model " + bench));
  expect_message(out, {"engine: ", " Hz, damping ratio"});
  LONGS_EQUAL(2, status_of("step --model " + bench + " --record " + kept));
  expect_message(err, {"either --model", "or --record"});
  LONGS_EQUAL(6, status_of("hammer --record " + record()));
  expect_message(err, {"no column engine"});
}

TEST(Command, stiffness_of_a_test_is_read_again_from_its_record_with_the_model_beside_it) {
  const std::string bench = scratch
                                .write("lab.toml",
                                       "schema = 1\ntopology = \"simplex\"\n[effects.soft_stiffness]\nlaw = \"compliance\"\n"
                                       "low_stiffness = 5.2e7\nload_scale = 6e3\n")
                                .string();
  const std::string kept = scratch.path("sines.csv").string();
  const std::string picture = scratch.path("stiffness.svg").string();
  const std::string of_bench = "stiffness --model " + bench;
  LONGS_EQUAL(0, status_of(of_bench + " --amplitudes 0.05,0.4 --count 20 --output " + kept + " --picture " + picture));
  expect_message(out,
                 {"0.05 deg: notch ", "0.4 deg: notch ", "peak force ", "actuator ", "eq. 4-7: ", "asymptote: 7.75 Hz"});
  CHECK_TRUE(std::filesystem::exists(picture));
  const std::string simulated = out;
  LONGS_EQUAL(0, status_of(of_bench + " --record " + kept));
  STRCMP_EQUAL(simulated.c_str(), out.c_str());
  LONGS_EQUAL(0, status_of(of_bench + " --record " + kept + " --json"));
  expect_message(out, {"\"load_stiffness\": 57500000.0", "\"asymptote\"", "\"amplitude_degrees\": 0.0", "\"test\"",
                       "\"expected\"", "\"peak_force\"", "\"actuator_stiffness\""});
  LONGS_EQUAL(2, status_of("stiffness --record " + kept));
  expect_message(err, {"missing: --model"});
  LONGS_EQUAL(2, status_of(of_bench + " --from 9 --to 5"));
  expect_message(err, {"--from 9 --to 5", "--from below --to"});
  LONGS_EQUAL(6, status_of(of_bench + " --record " + kept + " --from 12 --to 20"));
  expect_message(err, {"sines.csv: piston has no notch from 12 to 20 Hz", "--from and --to set"});
  LONGS_EQUAL(0, status_of("simulate --model " + bench + " --output " + kept + " --input " +
                           scratch.write("ramp.csv", ramp()).string()));
  LONGS_EQUAL(6, status_of(of_bench + " --record " + kept));
  expect_message(err, {"sines.csv: command is not a stepped sine", "hotfire sweep --profile sines"});
  const std::string mass =
      scratch.write("mass.toml", "schema = 1\ntopology = \"direct\"\n[mass]\ninertia = 1\ndamping = 1\nstiffness = 9\n")
          .string();
  LONGS_EQUAL(6, status_of("stiffness --model " + mass));
  expect_message(err, {"mass.toml: topology = \"direct\"", "allowed: \"simplex\""});
}

TEST(Command, a_model_of_two_axes_is_checked_and_run_on_the_axis_that_is_named) {
  const std::string taos = scratch.write("taos.toml", "schema = 1\nname = \"two\"\ntopology = \"taos\"\n").string();
  LONGS_EQUAL(0, status_of("check " + taos));
  expect_message(out, {"model \"two\", topology taos, 2 axes, 0 modes, rigid gimbal"});
  LONGS_EQUAL(2, status_of("step --model " + taos));
  expect_message(err, {"--axis"});
  LONGS_EQUAL(0, status_of("step --model " + taos + " --axis yaw --amplitudes 0.2 --hold 0.5"));
  expect_message(out, {"engine at 0.500 s, +0.00 to +0.20 deg"});
  const std::string both =
      scratch.write("both.csv", "time[s],command.pitch[deg],command.yaw[deg]\n0,0,0\n0.002,1,1\n0.004,1,1\n").string();
  LONGS_EQUAL(0, status_of("simulate --model " + taos + " --input " + both + " --output " + scratch.path("o.csv").string()));
  expect_message(out, {"o.csv: 3 rows"});
  LONGS_EQUAL(
      6, status_of("simulate --model " + taos + " --input " + record() + " --output " + scratch.path("o.csv").string()));
  expect_message(err, {"no column command.pitch"});
}

TEST(Command, hammer_and_quiescent_take_the_axis_that_is_named) {
  const std::string taos = scratch.write("taos.toml", "schema = 1\ntopology = \"taos\"\n").string();
  LONGS_EQUAL(2, status_of("hammer --model " + taos));
  expect_message(err, {"--axis"});
  LONGS_EQUAL(0, status_of("hammer --model " + taos + " --axis yaw --picture " + scratch.path("decay.svg").string()));
  expect_message(out, {"engine.yaw: ", " Hz, damping ratio"});
  LONGS_EQUAL(2, status_of("quiescent --model " + taos + " --axis roll"));
  expect_message(err, {"--axis roll", "pitch, yaw"});
  LONGS_EQUAL(0, status_of("quiescent --model " + taos + " --axis pitch --seconds 20 --picture " +
                           scratch.path("spectrum.svg").string()));
  expect_message(out, {"piston.pitch: largest peak at"});
  CHECK_TRUE(std::filesystem::exists(scratch.path("decay.svg")) && std::filesystem::exists(scratch.path("spectrum.svg")));
}

TEST(Command, strings_give_the_angles_of_a_test_from_the_poses_of_another) {
  const std::string taos = scratch.write("taos.toml", "schema = 1\ntopology = \"taos\"\n[strings]\n").string();
  std::string poses = "time[s],command.pitch[deg],command.yaw[deg]\n";
  for (int row = 0; row < 600; ++row) {
    const int pose = row / 100;
    poses += std::to_string(0.01 * row) + "," + std::to_string(pose % 3 - 1) + "," + std::to_string(pose / 3) + "\n";
  }
  const std::string settled = scratch.path("settled.csv").string();
  LONGS_EQUAL(0, status_of("simulate --model " + taos + " --input " + scratch.write("p.csv", poses).string() + " --output " +
                           settled));
  const std::string angles = scratch.path("angles.csv").string();
  const std::string both = " --settled " + settled + " --record " + settled + " --output " + angles;
  LONGS_EQUAL(0, status_of("strings --hold 0.9" + both));
  expect_message(out, {"angles.csv: calibrated on 6 settled poses", "mdeg rms", "pitch"});
  LONGS_EQUAL(0, status_of("strings --hold 0.9 --json" + both));
  expect_message(out, {"\"poses\": 6", "pitch_error_rad"});
  LONGS_EQUAL(0, status_of("check " + angles));
  LONGS_EQUAL(6, status_of("strings" + both));
  expect_message(err, {"settled.csv", "0 poses are held for 2 s", "at least five"});
  LONGS_EQUAL(6, status_of("strings --settled " + record() + " --record " + settled + " --output " + angles));
  expect_message(err, {"no column string1"});
}

TEST(Command, check_says_how_much_of_a_bus_a_schedule_takes_and_refuses_one_that_does_not_fit) {
  const std::string good =
      scratch.write("good.toml", "schema = 1\n[bus]\nbit_rate = 1e6\n[frames]\nSYNC = 0.001\n").string();
  const std::string bad = scratch.write("bad.toml", "schema = 1\n[bus]\nbit_rate = 1e5\n[frames]\nSYNC = 0.001\n").string();
  LONGS_EQUAL(0, status_of("check " + good));
  expect_message(out, {"CAN schedule, 1 frames, worst-case bus load 7.5 % of 1 Mbit/s, allowed 70 %"});
  LONGS_EQUAL(6, status_of("check " + bad));
  expect_message(err, {"bad.toml: worst-case bus load 75.0 %"});
}

TEST(Command, candump_log_is_written_read_back_and_simulated) {
  const std::string csv =
      scratch.write("r.csv", "time[s],command[rad],piston[m]\n0,0,0\n0.002,0.01,0\n0.004,0.01,0\n").string();
  const std::string log = scratch.path("r.log").string();
  LONGS_EQUAL(0, status_of("convert --command-per-current 5 " + csv + " " + log));
  LONGS_EQUAL(0, status_of("check " + log));
  expect_message(out, {"r.log: record, 3 rows, period 0.002 s (500 Hz)", "current[A], piston[m]"});
  const std::string output = scratch.path("model.csv").string();
  LONGS_EQUAL(0,
              status_of("simulate --model " + model() + " --command-per-current 5 --input " + log + " --output " + output));
  expect_message(out, {"model.csv: 3 rows"});
  LONGS_EQUAL(6, status_of("simulate --model " + model() + " --input " + log + " --output " + output));
  expect_message(err, {"no column command", "--command-per-current"});
  LONGS_EQUAL(2, status_of("convert " + csv + " r.xls"));
  LONGS_EQUAL(0, status_of("convert --json " + csv + " " + scratch.path("r.mf4").string()));
  expect_message(out, {"r.mf4\"", "\"rows\": 3", "\"period\": 0.002", "\"name\": \"command\"", "\"unit\": \"rad\""});
}

TEST(Command, import_reads_a_candump_log_with_its_dbc_file_and_says_without_one_what_is_needed) {
  const std::string log =
      scratch.write("rig.log", "(1.000) can0 100#0A\n(1.002) can0 100#0B\n(1.004) can0 100#0C\n").string();
  const std::string dbc =
      scratch.write("rig.dbc", "BO_ 256 FEEDBACK: 1 Drive\n SG_ POSITION : 0|8@1+ (1,0) [0|0] \"mm\" X\n").string();
  const std::string map = scratch.write("map.toml", "schema = 1\n[channels.piston]\ncolumn = \"POSITION\"\n").string();
  const std::string output = scratch.path("rig.csv").string();
  LONGS_EQUAL(0, status_of("import " + log + " --dbc " + dbc + " --map " + map + " --output " + output));
  expect_message(out, {"rig.csv: 3 rows, period 0.002 s, piston"});
  LONGS_EQUAL(0, status_of("check " + output));
  expect_message(out, {"rig.csv: record, 3 rows, period 0.002 s (500 Hz)", "piston[m]"});
  LONGS_EQUAL(0, status_of("import --json " + log + " --dbc " + dbc + " --map " + map + " --output " + output));
  expect_message(out, {"rig.csv\"", "\"rows\": 3", "\"name\": \"piston\"", "\"unit\": \"m\"", "\"notes\": []"});
  LONGS_EQUAL(2, status_of("import --json --guess " + log));
  expect_message(err, {"--json", "--guess"});
  LONGS_EQUAL(2, status_of("import " + log + " --map " + map + " --output " + output));
  expect_message(err, {"rig.log: is a candump log", "--dbc rig.dbc"});
  LONGS_EQUAL(6, status_of("import " + log + " --dbc none.dbc --map " + map + " --output " + output));
  expect_message(err, {"none.dbc: cannot be opened"});
  LONGS_EQUAL(0, status_of("import --help"));
  expect_message(out, {"Example: hotfire import rig.log --dbc rig.dbc --map map.toml"});
}

TEST(Command, simulate_refuses_bad_data_with_6_and_leaves_no_output) {
  const std::string output = scratch.path("model.csv").string();
  const std::string no_command = scratch.write("no_command.csv", "time[s],piston[m]\n0,0\n0.002,1\n").string();
  LONGS_EQUAL(6, status_of("simulate --model " + model() + " --input " + no_command + " --output " + output));
  expect_message(err, {"no_command.csv", "command", "piston"});
  STRCMP_EQUAL("", out.c_str());
  CHECK(!std::filesystem::exists(output));
}

TEST(Command, explain_refuses_a_rigs_limits_where_it_looks_for_no_experiment_and_an_exclusion_of_no_record) {
  const std::string taos = scratch.write("taos.toml", "schema = 1\nname = \"two\"\ntopology = \"taos\"\n").string();
  const std::string record =
      scratch.write("r.csv", "time[s],command.pitch[rad],piston.pitch[m]\n0,0,0\n0.002,0,0\n0.004,0,0\n").string();
  const std::string common = "explain --out " + scratch.path("found").string() + " " + record + " ";
  LONGS_EQUAL(2, status_of(common + "--model " + taos + " --lab profile.toml"));
  expect_message(err, {"--lab", "simplex"});
  LONGS_EQUAL(2, status_of(common + "--model " + model() + " --exclude other.csv@0-1"));
  expect_message(err, {"--exclude other.csv", "r.csv"});
  CHECK(!std::filesystem::exists(scratch.path("found")));
}

TEST(Command, explain_stops_looking_after_its_seconds_and_reports_the_best_by_then) {
  // A mass that meets friction which its model does not have: a search of several seconds.
  const std::string rig = scratch
                              .write("mass.toml",
                                     "schema = 1\nname = \"mass\"\ntopology = \"direct\"\n[mass]\ninertia = 1\ndamping = 1\n"
                                     "stiffness = 100\n[tolerance]\nmass.damping = 0.5\n")
                              .string();
  std::string rows = "time[s],force[N],position[m]\n";
  double position = 0.0;
  double velocity = 0.0;
  for (int row = 0; row < 60000; ++row) {
    const double time = 1e-3 * row;
    const double force = 20.0 * std::sin(3.0 * time) + 10.0 * std::sin(7.7 * time);
    rows += std::to_string(time) + "," + std::to_string(force) + "," +
            std::to_string(position + 1e-4 * std::sin(1e4 * row)) + "\n";
    const double friction = 4.0 * std::tanh(velocity / 1e-3);
    velocity += 1e-3 * (force - velocity - 100.0 * position - 300.0 * position * position * position - friction);
    position += 1e-3 * velocity;
  }
  const std::string record = scratch.write("mass.csv", rows).string();
  const std::string found = scratch.path("found").string();
  LONGS_EQUAL(0, status_of("explain --json --seconds 1 --threads 1 --model " + rig + " --out " + found + " " + record));
  expect_message(out, {"ended early", "--seconds"});
  CHECK(std::filesystem::exists(scratch.path("found") / "explained.toml"));
  LONGS_EQUAL(2, status_of("explain --seconds 0 --model " + rig + " --out " + found + " " + record));
  expect_message(err, {"--seconds"});
}

}  // namespace hotfire
