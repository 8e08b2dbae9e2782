// SPDX-License-Identifier: Apache-2.0
#include "tests/interface/cases.hpp"

#include <algorithm>
#include <cmath>

#include "model/numerics/step_size.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/simulate/excitation.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/simulate/simulate_vehicle.hpp"

namespace hotfire::test {

namespace {

const std::string kHead = "schema = 1\ntopology = ";
const std::string kEffects = R"(
[effects.gimbal_friction]
law = "lugre"
coulomb_torque = 12e3
[effects.soft_stiffness]
law = "compliance"
low_stiffness = 3.4e7
load_scale = 1.2e4
[effects.valve_deadband]
half_width = 0.004
)";
const std::string kGimbal = R"(
[gimbal]
thrust = 1.86e6
[gimbal.friction]
law = "lugre"
coulomb_torque = 2e4
[sensors.piston]
lag = "1 ms"
noise = "10 um"
step = "5 um"
)";
const std::string kStrings = "[strings]\nlag = \"2 ms\"\nnoise = \"20 um\"\nplacement_error = \"5 mm\"\n";

/// Two sines and a step, another for each input, below the model's limits.
double wave(std::size_t row, std::size_t input, double size) {
  const double t = 1e-3 * static_cast<double>(row);
  const auto phase = static_cast<double>(input);
  return size * (std::sin(12.0 * t + phase) + 0.4 * std::sin(61.0 * t + 2.0 * phase) + (t > 0.3 ? 0.5 : 0.0));
}

Record record_of(std::size_t rows, const std::vector<Channel>& channels) {
  Record record;
  record.path = "case.csv";
  record.period = 1e-3;
  record.rows = rows;
  record.channels = channels;
  return record;
}

Channel channel(const std::string& name, const std::string& unit, std::size_t rows, std::size_t input, double size) {
  Channel made{name, unit, {}};
  for (std::size_t row = 0; row < rows; ++row) {
    made.values.push_back(wave(row, input, size));
  }
  return made;
}

Case simplex(std::size_t rows) {
  Case made{
      "simplex",   kHead + "\"simplex\"\n" + kEffects + "[effects.sensor_delay]\nchannel = \"engine\"\ndelay = 0.0021\n",
      1e-3,        1,
      {"command"}, {},
      {}};
  const Record record = record_of(rows, {channel("command", "rad", rows, 0, 0.02)});
  made.driven = {record.channels[0].values};
  made.simulated = simulate(parse_model(made.text, "case.toml"), record);
  return made;
}

/// The force of a record is interpolated between rows; what a plant step gets of it drives a period of one step.
template <class Plant>
void drive_by_force(const typename Plant::Parameters& parameters, const Record& record, Case& made) {
  const int steps = model::steps_per_period<Plant>(parameters, record.period);
  made.period = record.period / steps;
  made.periods_per_row = static_cast<std::size_t>(steps);
  const Excitation force(record.channels[0].values, steps, Excitation::Between::interpolated);
  for (std::size_t row = 0; row < record.rows; ++row) {
    for (int step = 0; step < steps; ++step) {
      made.driven[0].push_back(force(row, step));
    }
  }
}

Case direct(std::size_t rows) {
  Case made{"direct",
            kHead +
                "\"direct\"\n[mass]\ninertia = 2.0\ndamping = 3.0\nstiffness = 5e4\n"
                "[effects.sliding_friction]\nlaw = \"lugre\"\ncoulomb_forward = 4.0\ncoulomb_backward = 3.0\n",
            0.0,
            1,
            {"force"},
            {{}},
            {}};
  const Record record = record_of(rows, {channel("force", "", rows, 0, 30.0)});
  const ModelFile model = parse_model(made.text, "case.toml");
  drive_by_force<model::Direct<double>>(std::get<DirectParameters>(model.parameters), record, made);
  made.simulated = simulate(model, record);
  return made;
}

/// At rest over its first rows, as a plant starts. The state at a row has moved on by one step of the path.
Case imposed_motion(std::size_t rows) {
  Case made{"imposed_motion",
            kHead +
                "\"imposed_motion\"\n[body]\ninertia = 2.0\ndamping = 300.0\n[effects.free_play]\nof = \"damper\"\n"
                "half_width = 0.002\n[effects.sliding_friction]\nlaw = \"lugre\"\ncoulomb_forward = 4.0\n"
                "coulomb_backward = 3.0\n",
            0.0,
            1,
            {"position"},
            {{}},
            {}};
  Record record = record_of(rows, {channel("position", "", rows, 0, 0.02)});
  std::vector<double>& path = record.channels[0].values;
  std::fill_n(path.begin(), std::min<std::size_t>(model::Interpolation::kMostNodes, rows), 0.0);
  const ModelFile model = parse_model(made.text, "case.toml");
  const int steps =
      steps_in_row<model::ImposedMotion<double>>(std::get<ImposedMotionParameters>(model.parameters), record.period);
  made.period = record.period / steps;
  made.periods_per_row = static_cast<std::size_t>(steps);
  const Excitation position(path, steps, Excitation::Between::ahead);
  for (std::size_t row = 0; row < rows; ++row) {
    for (int step = 0; step < steps; ++step) {
      made.driven[0].push_back(position(row, step));
    }
  }
  made.simulated = simulate(model, record);
  return made;
}

/// The force is interpolated between rows, as of a direct mass.
Case modal(std::size_t rows) {
  Case made{"modal",
            kHead +
                "\"modal\"\n[mode1]\nfrequency = 5.0\nmobility = 0.5\njoint = 0.4\nplace2 = 0.3\n[mode2]\nfrequency = 17.0\n"
                "mobility = 0.2\njoint = -0.8\n[effects.elastic_stop]\nstiffness = 2e4\nforward = 1e-3\n",
            0.0,
            1,
            {"force"},
            {{}},
            {}};
  const Record record = record_of(rows, {channel("force", "", rows, 0, 30.0)});
  const ModelFile model = parse_model(made.text, "case.toml");
  drive_by_force<model::Modal<double>>(std::get<ModalParameters>(model.parameters), record, made);
  made.simulated = simulate(model, record);
  return made;
}

/// The setpoint is held between rows.
Case electromechanical(std::size_t rows) {
  Case made{"electromechanical",
            kHead +
                "\"electromechanical\"\n[controller]\nproportional_gain = 200\nintegral_gain = 500\nposition_feedback = 1\n"
                "velocity_feedback = 0.02\nlimit = 24\n[motor]\ntorque_constant = 0.1\ninertia = 1e-4\nresistance = 1\n"
                "inductance = 1e-3\n[transmission]\nratio = 100\nstiffness = 2e4\ndamping = 5\n[mass]\ninertia = "
                "2\nstiffness = 300\n"
                "[effects.backlash]\nhalf_width = 1e-3\n[effects.motor_friction]\nlaw = \"lugre\"\ncoulomb_forward = 4.0\n"
                "coulomb_backward = 3.0\n",
            1e-3,
            1,
            {"setpoint"},
            {},
            {}};
  const Record record = record_of(rows, {channel("setpoint", "", rows, 0, 0.05)});
  made.driven = {record.channels[0].values};
  made.simulated = simulate(parse_model(made.text, "case.toml"), record);
  return made;
}

/// A measured load, constant: `simulate` interpolates most loads between rows, and a plant holds its inputs.
struct Load {
  std::string name;
  std::string unit;
  double value;
};

Case vehicle(const std::string& topology, const std::string& rest, const std::vector<std::string>& axes,
             const std::vector<Load>& loads, std::size_t rows) {
  Case made{topology, kHead + '"' + topology + "\"\n" + rest, 1e-3, 1, {}, {}, {}};
  std::vector<Channel> channels;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    channels.push_back(channel("command." + axes[i], "rad", rows, i, 0.015));
    made.inputs.push_back(channels.back().name);
    made.driven.push_back(channels.back().values);
  }
  for (const Load& load : loads) {
    channels.push_back({load.name, load.unit, std::vector<double>(rows, load.value)});
    made.inputs.push_back(load.name);
    made.driven.push_back(channels.back().values);
  }
  made.simulated = simulate(parse_vehicle(made.text, "case.toml"), record_of(rows, channels));
  return made;
}

/// The simulation repeats what drives it.
bool is_output(const Case& own, const Channel& channel) {
  return !channel.name.starts_with("command") && std::ranges::find(own.inputs, channel.name) == own.inputs.end();
}

}  // namespace

std::vector<double> Case::readings_at(std::size_t after) const {
  std::vector<double> readings;
  for (const Channel& channel : simulated.channels) {
    if (is_output(*this, channel)) {
      readings.push_back(channel.values[after / periods_per_row]);
    }
  }
  return readings;
}

std::vector<std::string> Case::outputs() const {
  std::vector<std::string> names;
  for (const Channel& channel : simulated.channels) {
    if (is_output(*this, channel)) {
      names.push_back(channel.name);
    }
  }
  return names;
}

Case case_of(const std::string& topology, std::size_t rows) {
  if (topology == "simplex") {
    return simplex(rows);
  }
  if (topology == "direct") {
    return direct(rows);
  }
  if (topology == "imposed_motion") {
    return imposed_motion(rows);
  }
  if (topology == "modal") {
    return modal(rows);
  }
  if (topology == "electromechanical") {
    return electromechanical(rows);
  }
  if (topology == "taos") {
    return vehicle("taos", kEffects + kGimbal + kStrings, {"pitch", "yaw"},
                   {{"force.x", "N", 26e4},
                    {"force.y", "N", -13e4},
                    {"force.z", "N", 6.6e4},
                    {"torque.pitch", "N.m", 4.1e3},
                    {"torque.yaw", "N.m", -2.3e3},
                    {"vibration.pitch", "rad/s", 0.017},
                    {"vibration.yaw", "rad/s", -0.03},
                    {"thrust", "N", 1.2e6}},
                   rows);
  }
  return vehicle("masv", "[effects.valve_deadband]\nhalf_width = 0.004\n" + kGimbal,
                 {"pitch1", "yaw1", "pitch2", "yaw2", "pitch3", "yaw3", "pitch4", "yaw4"},
                 {{"force.x3", "N", 26e4},
                  {"torque.yaw2", "N.m", 2.3e3},
                  {"vibration.pitch4", "rad/s", 0.02},
                  {"thrust.engine1", "N", 1.2e6}},
                 rows);
}

std::vector<Case> cases(std::size_t rows) {
  std::vector<Case> all;
  for (const char* topology : kTopologies) {
    all.push_back(case_of(topology, rows));
  }
  for (const char* topology : {"imposed_motion", "modal", "electromechanical"}) {
    all.push_back(case_of(topology, rows));
  }
  return all;
}

}  // namespace hotfire::test
