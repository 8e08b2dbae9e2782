// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "tests/files/scratch.hpp"
#include "tests/support/attach_points.hpp"
#include "tools/files/text/error.hpp"
#include "tools/library/declared_plant.hpp"
#include "tools/linear/linear_model.hpp"
#include "tools/linear/write_model.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/trials/profiles.hpp"
#include "tools/trials/sweep.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::linear {
namespace {

constexpr double kPeriod = 1e-3;

/// Everything that the issue names, on one axis.
const std::string kSimplex = R"(schema = 1
topology = "simplex"
[effects.gimbal_friction]
law = "lugre"
coulomb_torque = 8e3
stiffness = 5e7
static_ratio = 1.2
stribeck_velocity = 0.02
damping = 1e3
[effects.soft_stiffness]
law = "compliance"
low_stiffness = 4e7
load_scale = 8e3
)";

const std::string kTaos = std::string(R"(schema = 1
topology = "taos"
[structure]
stiffness = 1.04e8
[effects.soft_stiffness]
law = "compliance"
low_stiffness = 5.2e7
load_scale = 6e3
)") + test::kInclinedAttachPoints +
                          R"([gimbal]
thrust = 1.86e6
stiffness = [[2e9,0,0,0,0,0],[0,2e9,0,0,0,0],[0,0,2e9,0,0,0],[0,0,0,1.7e7,0,0],[0,0,0,0,1.7e7,0],[0,0,0,0,0,1.7e7]]
[gimbal.friction]
law = "lugre"
coulomb_torque = 2e4
stiffness = 1e8
static_ratio = 1.2
stribeck_velocity = 0.02
damping = 3e3
[sensors.piston]
lag = 2e-3
)";

const std::string kMasv = R"(schema = 1
topology = "masv"
[structure]
stiffness = 1.05e8
[effects.soft_stiffness]
law = "compliance"
low_stiffness = 5.2e7
load_scale = 6e3
[gimbal]
thrust = 1.86e6
[gimbal.friction]
law = "lugre"
coulomb_torque = 2e4
stiffness = 1e8
[modes]
table = "modes.csv"
)";

/// Two modes of four engines, each with its own shape, and what lies beyond them.
std::string mode_table() {
  std::ostringstream text;
  text << "mode,frequency[Hz],damping[1]";
  for (const char* kind : {"attach", "gimbal"}) {
    for (int engine = 1; engine <= 4; ++engine) {
      text << ',' << kind << ".pitch" << engine << ',' << kind << ".yaw" << engine;
    }
  }
  text << "\n1,3.3,0.02";
  for (int port = 0; port < 16; ++port) {
    text << ',' << (port < 8 ? 2e-3 * std::cos(port) : 1e-3 * std::sin(port));
  }
  text << "\n2,9.1,0.03";
  for (int port = 0; port < 16; ++port) {
    text << ',' << (port < 8 ? 3e-3 * std::sin(2.0 * port + 1.0) : 1e-3 * std::cos(port));
  }
  text << '\n';
  return text.str();
}

struct Case {
  DeclaredPlant declared;
  ModelFile axis{};
  std::optional<VehicleFile> vehicle{};
  std::string suffix{};

  Record run(const std::vector<double>& command) const {
    const Record inputs = trials::command_record(command, "command" + suffix);
    return vehicle ? simulate(*vehicle, inputs) : simulate(axis, inputs);
  }
};

Case case_of(const std::string& text) {
  const test::Scratch scratch;
  scratch.write("modes.csv", mode_table());
  const auto path = scratch.write("model.toml", text);
  Case own{declared_plant(path, kPeriod, 1)};
  if (is_vehicle(path)) {
    own.vehicle = load_vehicle(path);
    own.suffix = std::holds_alternative<TaosParameters>(own.vehicle->parameters) ? ".pitch" : ".pitch1";
  } else {
    own.axis = load_model(path);
  }
  return own;
}

double phase_between(Complex a, Complex b) { return std::abs(std::arg(a / b)) * 180.0 / std::numbers::pi; }
double gain_between(Complex a, Complex b) { return std::abs(20.0 * std::log10(std::abs(a / b))); }

/// The sweep of a model: stepped sines, each held for `seconds`.
std::vector<trials::ChannelSweep> sweep_of(const Case& own, double amplitude, const std::vector<double>& frequencies,
                                           double seconds) {
  const Record record = own.run(trials::stepped_sines({{amplitude, frequencies}}, seconds));
  return trials::analyse_sweep(record, {.axis = own.suffix.empty() ? "" : own.suffix.substr(1)});
}

constexpr double kSmall = 1e-8;  // rad: far below where friction, flow and springs bend

void check_small_signals(const std::string& text, double seconds) {
  const Case own = case_of(text);
  const auto plant = make_plant(own.declared.parameters, kPeriod, {});
  const LinearModel model = small_signal_model(*plant, kPeriod);
  CHECK_TRUE(model.by_logarithm);
  for (const auto& sweep : sweep_of(own, kSmall, {0.4, 1.3, 3.0, 6.1, 9.0, 11.5, 14.0}, seconds)) {
    const int output = place_of(model.outputs, sweep.channel + own.suffix, "output");
    LONGS_EQUAL(7, sweep.response.size());
    for (const auto& point : sweep.response) {
      const Complex linear = response(model, output, 0, point.frequency, true);
      const std::string where = sweep.channel + " at " + std::to_string(point.frequency) + " Hz";
      CHECK_TEXT(gain_between(linear, point.gain) < 0.05, where.c_str());
      CHECK_TEXT(phase_between(linear, point.gain) < 0.3, where.c_str());
      // The continuous model behind an ideal hold is the same.
      const Complex continuous =
          response(model, output, 0, point.frequency, false) * hold_factor(point.frequency, kPeriod, kPeriod / 64);
      CHECK_TEXT(gain_between(continuous, point.gain) < 0.05, where.c_str());
      CHECK_TEXT(phase_between(continuous, point.gain) < 0.3, where.c_str());
    }
  }
}

/// Sines of five amplitudes, by describing functions and on the nonlinear model.
void check_describing_functions(const std::string& text, const std::vector<double>& degrees,
                                const std::vector<double>& frequencies) {
  const Case own = case_of(text);
  const auto plant = make_plant(own.declared.parameters, kPeriod, {});
  const HarmonicBalance system(*plant);
  for (const double own_degrees : degrees) {
    const double amplitude = trials::radians(own_degrees);
    const auto sweeps = sweep_of(own, amplitude, frequencies, 6.0);
    const auto described =
        described_response(system, 0, amplitude, kPeriod, frequencies, {"piston" + own.suffix, "engine" + own.suffix});
    LONGS_EQUAL(0, described.without.size());
    for (const auto& sweep : sweeps) {
      const auto& response = described.outputs.at(sweep.channel + own.suffix);
      for (std::size_t k = 0; k < frequencies.size(); ++k) {
        const std::string where =
            sweep.channel + " at " + std::to_string(own_degrees) + " deg, " + std::to_string(frequencies[k]) + " Hz";
        CHECK_TEXT(gain_between(response[k].gain, sweep.response[k].gain) < 0.5, where.c_str());
        CHECK_TEXT(phase_between(response[k].gain, sweep.response[k].gain) < 3.0, where.c_str());
      }
    }
  }
}

const std::string kDeadBand = "[effects.valve_deadband]\nhalf_width = 0.02\n";

}  // namespace

TEST_GROUP(Linear){};
TEST_GROUP(LinearAtLength){};

TEST(Linear, SmallDeviationsOfASimplexAreThoseOfASweep) { check_small_signals(kSimplex, 4.0); }

TEST(Linear, SmallDeviationsOfATaosAreThoseOfASweep) { check_small_signals(kTaos, 4.0); }

// A block so heavy that it rings at 20 Hz: the response at 14 Hz has it.
TEST(Linear, SmallDeviationsOfABearingWithABlockAreThoseOfASweep) {
  std::string blocked = kTaos;
  blocked.replace(blocked.find("[gimbal]\n"), 9, "[gimbal]\nblock_mass = 1000\nblock_inertia = 2000\n");
  check_small_signals(blocked, 4.0);
  const auto at_14_hz = [](const std::string& text) {
    const Case own = case_of(text);
    const LinearModel model = small_signal_model(*make_plant(own.declared.parameters, kPeriod, {}), kPeriod);
    return response(model, place_of(model.outputs, "engine.pitch", "output"), 0, 14.0, true);
  };
  CHECK_TRUE(gain_between(at_14_hz(blocked), at_14_hz(kTaos)) > 0.2);
}

TEST(Linear, SmallDeviationsOfAMasvAreThoseOfASweep) { check_small_signals(kMasv, 8.0); }

TEST(Linear, DescribingFunctionsOfASimplexAreThoseOfSimulatedSinesAtFiveAmplitudes) {
  check_describing_functions(kSimplex + kDeadBand, {0.05, 0.1, 0.2, 0.4, 1.6}, {0.5, 0.7, 2.0, 4.0, 7.0, 10.0, 14.0});
}

TEST(Linear, DescribingFunctionsOfATaosAreThoseOfSimulatedSinesAtFiveAmplitudes) {
  check_describing_functions(kTaos + kDeadBand, {0.05, 0.1, 0.2, 0.4, 0.8}, {0.5, 3.0, 8.0, 12.0});
}

TEST(LinearAtLength, DescribingFunctionsOfAMasvAreThoseOfSimulatedSinesAtFiveAmplitudes) {
  check_describing_functions(kMasv + kDeadBand, {0.05, 0.1, 0.2, 0.4, 1.6}, {1.0, 8.0});
}

TEST(Linear, ALoadIsWhatATorqueOffsetOfTheModelIs) {
  const Case loaded = case_of(kSimplex + "[effects.torque_offset]\ntorque = -20000\n");
  const Case unloaded = case_of(kSimplex);
  const LinearModel by_effect = small_signal_model(*make_plant(loaded.declared.parameters, kPeriod, {}), kPeriod);
  const LinearModel by_option =
      small_signal_model(*make_plant(unloaded.declared.parameters, kPeriod, {{}, {20000.0}}), kPeriod);
  const LinearModel without = small_signal_model(*make_plant(unloaded.declared.parameters, kPeriod, {}), kPeriod);
  const double rounding = 1e-9 * by_effect.a.cwiseAbs().maxCoeff();
  CHECK_TRUE((by_effect.a - by_option.a).cwiseAbs().maxCoeff() <= rounding);
  // A soft spring is stiffer under load, and a loaded valve gives less flow.
  CHECK_TRUE((by_option.a - without.a).cwiseAbs().maxCoeff() > 1e3 * rounding);
}

TEST(Linear, AModelAboutAnAmplitudeHasTheResponseOfItsDescribingFunctions) {
  const Case own = case_of(kSimplex + kDeadBand);
  const auto plant = make_plant(own.declared.parameters, kPeriod, {});
  const HarmonicBalance system(*plant);
  for (const double frequency : {1.0, 6.0}) {
    const auto described = described_response(system, 0, trials::radians(0.3), kPeriod, {frequency}, {"piston", "engine"});
    LONGS_EQUAL(1, described.balances.size());
    const LinearModel model = quasi_linear_model(system, kPeriod, described.balances.front());
    for (const std::string name : {"piston", "engine"}) {
      const Complex linear = response(model, place_of(model.outputs, name, "output"), 0, frequency, true);
      const Complex balanced = described.outputs.at(name).front().gain;
      CHECK_TRUE(gain_between(linear, balanced) < 0.02);
      CHECK_TRUE(phase_between(linear, balanced) < 0.2);
    }
  }
}

TEST(Linear, AWrittenModelSaysWhatItsRowsAndColumnsAre) {
  const Case own = case_of(kSimplex);
  const LinearModel model = small_signal_model(*make_plant(own.declared.parameters, kPeriod, {}), kPeriod);
  const test::Scratch scratch;
  write_model(model, scratch.path("m.json"));
  std::ifstream file(scratch.path("m.json"));
  const auto json = nlohmann::json::parse(file);
  STRCMP_EQUAL("piston", json["states"][4]["name"].get<std::string>().c_str());
  STRCMP_EQUAL("m/s", json["states"][5]["unit"].get<std::string>().c_str());
  DOUBLES_EQUAL(model.a(5, 4), json["A"][5][4].get<double>(), 0.0);
  write_model(model, scratch.path("m.csv"));
  std::ifstream rows(scratch.path("m.csv"));
  std::stringstream text;
  text << rows.rdbuf();
  CHECK_TRUE(text.str().find("\nA,piston,m,piston_rate,m/s,") != std::string::npos);
  write_model(model, scratch.path("m.mat"));
  CHECK_TRUE(std::filesystem::file_size(scratch.path("m.mat")) > 128);
  CHECK_THROWS(UsageError, write_model(model, scratch.path("m.xls")));
}

TEST(Linear, WhatHasNoSmallDeviationsIsRefused) {
  const auto refused = [](const std::string& text) {
    const Case own = case_of(text);
    CHECK_THROWS(UsageError, make_plant(own.declared.parameters, kPeriod, {}));
  };
  refused("schema = 1\ntopology = \"direct\"\n[mass]\ninertia = 2.0\n");
  refused(kTaos + "[gimbal.vibration]\npitch_velocity = 0.01\n");
  refused(kSimplex +
          "[effects.term_flow]\nmemory = \"lag\"\nargument = \"spool\"\nfactor = \"none\"\norder = \"curve_last\"\ntime = "
          "0.02\ngain = 1e-3\n");
}

}  // namespace hotfire::linear
