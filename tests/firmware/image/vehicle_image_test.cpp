// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>

#include "firmware/image/plant_image.hpp"
#include "tests/firmware/image/delay_and_table.hpp"
#include "tests/firmware/plant/whole_vehicle.hpp"
#include "tools/simulate/vehicle_image_text.hpp"

namespace hotfire {

using firmware::MasvRig;
using firmware::parse_plant_image;
using firmware::PlantImage;
using firmware::TaosRig;

namespace {

const std::string kTaos = std::string(R"(schema = 1
topology = "taos"
[actuator.yaw]
supply_pressure = "3000 psi"
)") + test::kDelayAndTable +
                          R"([gimbal]
thrust = 1.5e6
rated_thrust = 1.86e6
dead_load = -3.4e4
unloaded_structure = 0.41
yaw_misalignment = 2e-3
[gimbal.friction]
law = "vibrated_lugre"
coulomb_torque = 2.3e3
coefficient = 0.071
viscous = 123.0
vibration_ratio = 0.37
)";

/// The text with the line of a key replaced; without it if there is nothing to replace it with.
std::string with_line(const std::string& text, const std::string& key, const std::string& line) {
  const std::size_t from = text.find("\n" + key + " ") + 1;
  CHECK_TRUE_TEXT(from > 0, key.c_str());
  return text.substr(0, from) + line + text.substr(text.find('\n', from) + (line.empty() ? 1 : 0));
}

}  // namespace

TEST_GROUP(VehicleImage) {
  test::Scratch scratch;

  template <class Rig, class Parameters>
  static void check_same_bits(const VehicleFile& declared) {
    const std::string text = plant_image_text(declared);
    const PlantImage image = parse_plant_image(text, "image");
    STRCMP_EQUAL("", image.error.c_str());
    const Rig& arrived = std::get<Rig>(*image.parameters);
    // An image tells every number bit for bit: two rigs are the same if their images are.
    PlantImageWriter writer(Rig::Vehicle::topology);
    model::visit_vehicle_keys(arrived, writer);
    STRCMP_EQUAL(text.c_str(), writer.text().c_str());
    // What an image would not tell would not have arrived.
    const auto& sent = std::get<Parameters>(declared.parameters);
    CHECK(sent.constant_arms == arrived.vehicle.constant_arms);
    for (std::size_t i = 0; i < sent.axes.size(); ++i) {
      CHECK(sent.axes[i].effects.active == arrived.vehicle.axes[i].effects.active);
      CHECK(sent.attach[i].engine() == arrived.vehicle.attach[i].engine());
      CHECK(sent.attach[i].vehicle() == arrived.vehicle.attach[i].vehicle());
    }
    for (std::size_t e = 0; e < sent.gimbals.size(); ++e) {
      CHECK(sent.gimbals[e].compliant == arrived.vehicle.gimbals[e].compliant);
      CHECK(sent.gimbals[e].stiffness == arrived.vehicle.gimbals[e].stiffness);
      LONGS_EQUAL(sent.gimbals[e].friction.option, arrived.vehicle.gimbals[e].friction.option);
    }
    LONGS_EQUAL(sent.modes.modes, arrived.vehicle.modes.modes);
    CHECK(sent.modes.frequency == arrived.vehicle.modes.frequency);
    CHECK(sent.modes.damping_ratio == arrived.vehicle.modes.damping_ratio);
    CHECK(sent.modes.shape == arrived.vehicle.modes.shape);
    CHECK(sent.modes.residual == arrived.vehicle.modes.residual);
    DOUBLES_EQUAL(declared.sensors.piston.lag, arrived.sensors.piston.lag, 0.0);
    DOUBLES_EQUAL(declared.sensors.string.step, arrived.sensors.string.step, 0.0);
    if (declared.sensors.string_shape.rows() > 0) {
      CHECK(declared.sensors.string_shape == arrived.sensors.string_shape.leftCols(sent.modes.modes));
      CHECK(declared.sensors.string_residual == arrived.sensors.string_residual);
    }
  }

  static void refused(const std::string& text, const char* message) {
    STRCMP_CONTAINS(message, parse_plant_image(text, "image").error.c_str());
  }
};

TEST(VehicleImage, FourEnginesWithEverythingArriveBitForBit) {
  const VehicleFile vehicle = test::whole_vehicle(scratch);
  const auto& modes = std::get<MasvParameters>(vehicle.parameters).modes;
  CHECK(modes.modes > 0 && modes.residual.cwiseAbs().maxCoeff() > 0.0);
  check_same_bits<MasvRig, MasvParameters>(vehicle);
}

TEST(VehicleImage, OneEngineWithConstantArmsAndATableArrivesBitForBit) {
  check_same_bits<TaosRig, TaosParameters>(load_vehicle(scratch.write("taos.toml", kTaos)));
}

TEST(VehicleImage, MissingUnknownAndImpossibleLinesAreRefused) {
  const std::string text = plant_image_text(test::whole_vehicle(scratch));
  refused(with_line(text, "yaw3.engine.inertia", ""), "image: missing key yaw3.engine.inertia");
  refused(with_line(text, "engine4.gimbal.stiffness6", ""), "missing key engine4.gimbal.stiffness6");
  refused(with_line(text, "mode2.shape", ""), "missing key mode2.shape");
  const auto line = static_cast<unsigned>(std::count(text.begin(), text.end(), '\n') + 1);
  refused(text + "pitch5.engine.inertia 1\n",
          StringFromFormat("line %u: pitch5.engine.inertia = 1: unknown key", line).asCharString());
  refused(with_line(text, "pitch1.engine.inertia", "pitch1.engine.inertia -1"),
          "pitch1.engine.inertia = -1: allowed is a number from 1e-06");
  refused(with_line(text, "mode1.frequency", "mode1.frequency 0"), "mode1.frequency = 0: allowed is a number from 2.2");
  refused(with_line(text, "mode1.damping_ratio", "mode1.damping_ratio 1"), "mode1.damping_ratio = 1: allowed is");
  refused(with_line(text, "mode1.shape", "mode1.shape 1,2"), "mode1.shape = 1,2: allowed is 16 numbers");
  refused(with_line(text, "modes.count", "modes.count 65"), "modes.count = 65: allowed is a whole number from 0 to 64");
  refused(with_line(text, "modes.count", "modes.count 1.5"), "modes.count = 1.5: allowed is a whole number");
  refused(with_line(text, "engine2.constant_arms", "engine2.constant_arms maybe"),
          "engine2.constant_arms = maybe: allowed are no yes");
}

TEST(VehicleImage, ValuesThatContradictEachOtherAreRefused) {
  const std::string text = plant_image_text(test::whole_vehicle(scratch));
  refused(with_line(text, "engine2.gimbal.stiffness1", "engine2.gimbal.stiffness1 2e9,1e9,0,0,0,0"),
          "gimbal of engine 2: the stiffness matrix is not symmetric");
  refused(with_line(text, "pitch3.attach.engine_z", "pitch3.attach.engine_z 0.7"), "attach points of engine 3: the pitch");
  refused(with_line(text, "engine1.vibration.frequency", "engine1.vibration.frequency 0"),
          "engine1.vibration.frequency = 0: allowed is a number from 1");
}

TEST(VehicleImage, FaultOfAnActuatorThatTheVehicleHasNotIsRefused) {
  const std::string text = plant_image_text(load_vehicle(scratch.write("taos.toml", kTaos)));
  const std::string fault = "fault.0.kind leak\nfault.0.from 0\nfault.0.to 1\nfault.0.value 1e-9\nfault.0.actuator ";
  STRCMP_EQUAL("", parse_plant_image(text + fault + "2\n", "image").error.c_str());
  refused(text + fault + "3\n", "fault.0.actuator = 3: allowed is a whole number from 0 to 2");
}

TEST(VehicleImage, EngineHasOneThrustAtATimeWhicheverOfItsActuatorsNamesIt) {
  const std::string text = plant_image_text(load_vehicle(scratch.write("masv.toml", "schema = 1\ntopology = \"masv\"\n")));
  const auto thrust = [](int number, int actuator) {
    const std::string prefix = "fault." + std::to_string(number) + ".";
    return prefix + "kind thrust\n" + prefix + "from 0\n" + prefix + "to 1\n" + prefix + "actuator " +
           std::to_string(actuator) + "\n" + prefix + "value 1e6\n";
  };
  STRCMP_EQUAL("", parse_plant_image(text + thrust(0, 2) + thrust(1, 3), "image").error.c_str());
  refused(text + thrust(0, 1) + thrust(1, 2), "fault.1.kind: ");
  refused(text + thrust(0, 5) + thrust(1, 0), "a thrust of an engine, that has another one at that time");
}

}  // namespace hotfire
