// SPDX-License-Identifier: Apache-2.0
#include "firmware/image/plant_image.hpp"

#include <CppUTest/TestHarness.h>

#include <string>

#include "firmware/image/image_plant.hpp"

namespace hotfire::firmware {

namespace {

const std::string kMass = "schema 1\ntopology direct\nmass.inertia 0x1p+1\nmass.damping 3\nmass.stiffness 4.5\n";

const std::string kTable =
    "servovalve.rated_flow 0.003\nservovalve.natural_frequency 377\nservovalve.damping_ratio 0.8\n"
    "servovalve.position_gain 86\nservovalve.position_feedback 1\nservovalve.pressure_feedback_gain "
    "1e-7\nservovalve.pressure_feedback_corner 6\n"
    "actuator.piston_area 0.016\nactuator.supply_pressure 2e7\nactuator.bulk_modulus 1e9\nactuator.trapped_volume 5e-3\n"
    "actuator.leakage 2e-12\nactuator.piston_mass 50\nactuator.piston_damping 2e4\nactuator.stiffness 1.2e8\n"
    "actuator.moment_arm 0.75\nstructure.stiffness 5e7\nengine.inertia 9490\nengine.viscous_damping 1e4\n"
    "engine.duct_stiffness 4e5\neffects.soft_stiffness.law table\neffects.soft_stiffness.low_stiffness 4e7\n"
    "effects.soft_stiffness.load_scale 8e3\n";

std::string soft(const std::string& rows) { return "schema 1\ntopology simplex\n" + kTable + rows; }

}  // namespace

TEST_GROUP(PlantImage){static void refused(const std::string& text,
                                           const char* message){const PlantImage image = parse_plant_image(text, "p.image");
CHECK(!image.parameters);
STRCMP_CONTAINS("p.image: ", image.error.c_str());
STRCMP_CONTAINS(message, image.error.c_str());
}  // namespace hotfire::firmware
}
;

TEST(PlantImage, MassIsReadFromHexadecimalAndDecimalNumbers) {
  const PlantImage image = parse_plant_image(kMass, "p.image");
  STRCMP_EQUAL("", image.error.c_str());
  const auto& parameters = std::get<model::Direct<double>::Parameters>(*image.parameters);
  DOUBLES_EQUAL(2.0, parameters.mass.inertia, 0.0);
  DOUBLES_EQUAL(3.0, parameters.mass.damping, 0.0);
  DOUBLES_EQUAL(4.5, parameters.mass.stiffness, 0.0);
}

TEST(PlantImage, TableIsReadPointByPoint) {
  const PlantImage image =
      parse_plant_image(soft("effects.soft_stiffness.load.0 0\neffects.soft_stiffness.table_stiffness.0 4e7\n"
                             "effects.soft_stiffness.load.1 1e4\neffects.soft_stiffness.table_stiffness.1 1.2e8\n"),
                        "p.image");
  STRCMP_EQUAL("", image.error.c_str());
  const auto& parameters = std::get<model::Simplex<double>::Parameters>(*image.parameters);
  const auto& soft_stiffness = std::get<model::SoftStiffness::Params<double>>(parameters.effects.values);
  LONGS_EQUAL(2, soft_stiffness.option);
  LONGS_EQUAL(2, soft_stiffness.table.points);
  DOUBLES_EQUAL(1e4, soft_stiffness.table.x[1], 0.0);
  DOUBLES_EQUAL(1.2e8, soft_stiffness.table.y[1], 0.0);
}

TEST(PlantImage, TableThatDoesNotRiseOrHasGapsOrTooFewPointsIsRefused) {
  refused(soft("effects.soft_stiffness.load.0 5\neffects.soft_stiffness.table_stiffness.0 4e7\n"
               "effects.soft_stiffness.load.1 5\neffects.soft_stiffness.table_stiffness.1 1.2e8\n"),
          "line 28: effects.soft_stiffness.load.1 = 5: must be above the value before it");
  refused(soft("effects.soft_stiffness.load.0 0\neffects.soft_stiffness.table_stiffness.0 4e7\n"), "at least two points");
  refused(soft("effects.soft_stiffness.load.0 0\n"), "missing key effects.soft_stiffness.table_stiffness.0");
  refused(soft("effects.soft_stiffness.load.1 0\n"), "effects.soft_stiffness.load.1 = 0: unknown key");
}

TEST(PlantImage, NumberOutsideItsBoundsIsRefusedWithLineValueAndBounds) {
  refused("schema 1\ntopology direct\nmass.inertia -2\nmass.damping 3\nmass.stiffness 4\n",
          "line 3: mass.inertia = -2: allowed is a number from 1e-12 to 1e+12");
}

TEST(PlantImage, NanInfinityAndTextAreRefused) {
  for (const char* value : {"nan", "-nan", "inf", "1.0x", "heavy"}) {
    refused("schema 1\ntopology direct\nmass.inertia " + std::string(value) + "\nmass.damping 3\nmass.stiffness 4\n",
            "line 3: mass.inertia = ");
  }
}

TEST(PlantImage, UnknownMissingAndRepeatedKeysAreRefused) {
  refused(kMass + "mass.colour 3\n", "line 6: mass.colour = 3: unknown key");
  refused(kMass + "effects.levitation.height 3\n", "line 6: effects.levitation.height = 3: unknown key");
  refused("schema 1\ntopology direct\nmass.inertia 1\nmass.damping 3\n", "missing key mass.stiffness");
  refused(kMass + "mass.damping 3\n", "line 6: mass.damping = 3: the key is already in line 4");
  refused(kMass + "effects.cubic_stiffness.coloring 3\n", "missing key effects.cubic_stiffness.");
}

TEST(PlantImage, ActiveEffectNeedsEveryParameterAndAKnownLaw) {
  refused(kMass + "effects.sliding_friction.law sticky\n", "sliding_friction.law = sticky: allowed are coulomb dahl lugre");
  refused(kMass + "effects.sliding_friction.law dahl\n", "missing key effects.sliding_friction.coulomb_forward");
}

TEST(PlantImage, WrongSchemaTopologyAndLineAreRefused) {
  refused("", "missing key schema");
  refused("schema 2\ntopology direct\n", "schema = 2: this build reads schema 1");
  refused("schema 1\ntopology wheel\n",
          "topology = wheel: allowed are direct electromechanical imposed_motion modal simplex");
  refused(kMass + "mass.inertia\n", "line 6: \"mass.inertia\": expected `key value`");
  refused(kMass + "\n", "line 6: \"\": expected `key value`");
}

TEST(PlantImage, FileThatCannotBeReadIsRefusedWithTheReason) {
  const PlantImage image = read_plant_image("no/such/file.image");
  CHECK(!image.parameters);
  STRCMP_CONTAINS("no/such/file.image: cannot be read", image.error.c_str());
  STRCMP_CONTAINS("No such file", image.error.c_str());
  STRCMP_CONTAINS("/dev/zero:1: over 67108864 bytes", read_plant_image("/dev/zero").error.c_str());
  STRCMP_CONTAINS("Is a directory", read_plant_image("/tmp").error.c_str());
}

// A plant has room for `hal::kMaxReadings`; `hotfire-rt plant` takes as many copies as fit, and CAN only with a servovalve.
TEST(PlantImage, ReadingsAndServovalveOfAPlantAreThoseOfItsTopology) {
  const PlantParameters axis = model::Simplex<double>::Parameters{};
  const PlantParameters structure = model::Modal<double>::Parameters{};
  const PlantParameters moved = model::ImposedMotion<double>::Parameters{};
  LONGS_EQUAL(3, readings_of(axis));
  LONGS_EQUAL(9, readings_of(structure));
  LONGS_EQUAL(1, readings_of(moved));
  CHECK(topology_without_valve(axis).empty());
  CHECK(topology_without_valve(structure) == "modal");
  CHECK(topology_without_valve(moved) == "imposed_motion");
}

}  // namespace hotfire::firmware
