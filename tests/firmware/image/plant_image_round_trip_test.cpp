// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "firmware/image/plant_image.hpp"
#include "model/keys.hpp"
#include "tests/firmware/image/delay_and_table.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/simulate/plant_image_text.hpp"

namespace hotfire {

namespace {

/// Units, a table, laws and channels; decimals that no binary number hits.
const std::string kSimplex = std::string(R"(schema = 1
name = "round trip"
topology = "simplex"
[servovalve]
rated_flow = "50 gallon/minute"
[actuator]
piston_area = "24.8 in^2"
supply_pressure = "3000 psi"
[engine]
inertia = 9490.1
)") + test::kDelayAndTable + R"([effects.gimbal_friction]
law = "lugre"
coulomb_torque = 12.3e3
[effects.sensor_lag]
channel = "engine"
time_constant = 0.0031
)";

const char* const kDirect = R"(schema = 1
name = "mass"
topology = "direct"
[mass]
inertia = 95.1089
damping = 203.5034
stiffness = 0.0
[effects.sliding_friction]
law = "coulomb"
coulomb_forward = 20.39
coulomb_backward = 19.1
)";

const char* const kMoved = R"(schema = 1
topology = "imposed_motion"
[body]
damping = 1100.1
[effects.free_play]
of = "damper"
half_width = 0.0021
)";

const char* const kModal = R"(schema = 1
topology = "modal"
[mode1]
frequency = 5.1
mobility = 0.0203
joint = -0.31
[mode6]
frequency = 40.2
mobility = 0.011
[effects.elastic_stop]
stiffness = 8003.0
forward = 0.0021
)";

const char* const kElectromechanical = R"(schema = 1
topology = "electromechanical"
[motor]
torque_constant = 0.103
inertia = 1.1e-4
current_corner = 3001.0
[transmission]
ratio = 99.1
stiffness = 2.03e4
[mass]
inertia = 2.01
[effects.backlash]
half_width = 0.00103
)";

template <class Parameters>
std::vector<std::uint64_t> bits_of(const Parameters& parameters) {
  std::vector<std::uint64_t> bits;
  model::visit_parameters(parameters, [&](const model::Key&, const auto&, double value) {
    bits.push_back(std::bit_cast<std::uint64_t>(value));
  });
  return bits;
}

}  // namespace

TEST_GROUP(PlantImageRoundTrip) {
  std::filesystem::path path = std::filesystem::temp_directory_path() / "hotfire_plant_image_round_trip.toml";

  void teardown() override { std::filesystem::remove(path); }

  template <class Parameters>
  void check(const std::string& toml) {
    std::ofstream(path) << toml;
    const ModelFile model = load_model(path);
    const std::string text = plant_image_text(model);
    const firmware::PlantImage image = firmware::parse_plant_image(text, "image");
    STRCMP_EQUAL("", image.error.c_str());
    const auto& declared = std::get<Parameters>(model.parameters);
    const auto& arrived = std::get<Parameters>(*image.parameters);
    CHECK(bits_of(declared) == bits_of(arrived));
    CHECK(declared.effects.active == arrived.effects.active);
    ModelFile again = model;
    again.parameters = arrived;
    STRCMP_EQUAL(text.c_str(), plant_image_text(again).c_str());
  }
};

TEST(PlantImageRoundTrip, SimplexOfAModelFileArrivesBitForBit) { check<SimplexParameters>(kSimplex); }

TEST(PlantImageRoundTrip, DirectMassOfAModelFileArrivesBitForBit) { check<DirectParameters>(kDirect); }

TEST(PlantImageRoundTrip, MovedBodyOfAModelFileArrivesBitForBit) { check<ImposedMotionParameters>(kMoved); }

TEST(PlantImageRoundTrip, StructureOfAModelFileArrivesBitForBit) { check<ModalParameters>(kModal); }

TEST(PlantImageRoundTrip, MotorOfAModelFileArrivesBitForBit) { check<ElectromechanicalParameters>(kElectromechanical); }

}  // namespace hotfire
