// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/explain/rigs/servo_record.hpp"
#include "tests/support/refusal.hpp"
#include "tools/explain/explain.hpp"

namespace hotfire::test {
namespace {

/// Dry friction, spread over a ten-thousandth of the largest speed.
ServoEffects::Force dry(double forward, double backward) {
  return [=](double, double v) { return (v > 0.0 ? forward : backward) * std::tanh(v / 1e-4); };
}

explain::Explanation explain_servo(const Record& record) {
  explain::ExplainOptions options;
  options.threads = 2;
  return explain::explain(declared_servo(), {record}, options);
}

/// One effect is named at its site, and no channel keeps more than so many times its noise on held-out rows.
void check_servo_named(const char* name, const char* site, const Record& record, double most = 1.15) {
  const auto found = explain_servo(record);
  CHECK_EQUAL(1U, found.result.effects.size());
  STRCMP_EQUAL(name, found.result.effects.front().name.c_str());
  STRCMP_EQUAL(site, found.result.effects.front().site.c_str());
  CHECK_EQUAL(2U, found.result.channels.size());
  for (const auto& channel : found.result.channels) {
    const double noise = channel.name == "motor_position" ? 100.0 * kServoNoise : kServoNoise;
    CHECK_TRUE(channel.explained.rms > 0.85 * noise);
    CHECK_TRUE(channel.explained.rms < most * noise);
  }
}

}  // namespace

TEST_GROUP(ExplainElectromechanical){};
TEST_GROUP(ExplainElectromechanicalAtLength){};

TEST(ExplainElectromechanical, NothingIsFoundWhereNothingIsMissing) {
  const auto found = explain_servo(servo_record({}));
  CHECK_EQUAL(0U, found.result.effects.size());
}

TEST(ExplainElectromechanical, PlayOfTheTransmissionIsNamed) {
  check_servo_named("backlash", "transmission", servo_record({.half_play = 5e-4}));
}

TEST(ExplainElectromechanicalAtLength, FrictionOfTheMotorIsNotThatOfTheLoad) {
  check_servo_named("motor_friction", "motor", servo_record({.on_motor = dry(20.0, 20.0)}), 1.4);
}

TEST(ExplainElectromechanicalAtLength, FrictionOfTheLoadIsNotThatOfTheMotor) {
  check_servo_named("sliding_friction", "mass_force", servo_record({.on_load = dry(24.0, 15.0)}), 1.4);
}

TEST(ExplainElectromechanicalAtLength, SaturationOfTheDriveIsNamed) {
  check_servo_named("drive_saturation", "drive",
                    servo_record({.drive = [](double volts) { return std::clamp(volts, -14.0, 14.0); }}));
}

TEST(ExplainElectromechanicalAtLength, DelayOfTheSetpointIsNamed) {
  check_servo_named("command_delay", "command", servo_record({}, 0.006));
}

TEST(ExplainElectromechanicalAtLength, StopOfTheLoadIsNamed) {
  check_servo_named("elastic_stop", "mass_force", servo_record({.on_load = [](double x, double) {
                      return x > 0.11 ? 5e3 * (x - 0.11) : x < -0.1 ? 5e3 * (x + 0.1) : 0.0;
                    }}));
}

// Six effects, five records each that no other test has: nine of ten are named and nothing else, eight of ten leave at most
// a tenth more than the noise.
TEST(ExplainElectromechanicalAtLength, EffectsAreNamedOnFreshRecords) {
  struct Missing {
    const char* name;
    ServoEffects effects;
    double delay = 0.0;
  };
  const auto stop = [](double x, double) { return x > 0.12 ? 4e3 * (x - 0.12) : x < -0.11 ? 4e3 * (x + 0.11) : 0.0; };
  const std::vector<Missing> all{{"backlash", {.half_play = 3e-4}},
                                 {"motor_friction", {.on_motor = dry(14.0, 18.0)}},
                                 {"sliding_friction", {.on_load = dry(12.0, 20.0)}},
                                 {"drive_saturation", {.drive = [](double v) { return std::clamp(v, -13.0, 13.0); }}},
                                 {"command_delay", {}, 0.004},
                                 {"elastic_stop", {.on_load = stop}}};
  std::size_t named = 0;
  std::size_t quiet = 0;
  std::size_t cases = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    for (const Missing& missing : all) {
      const auto found = explain_servo(servo_record(missing.effects, missing.delay, seed));
      const bool is_named = found.result.effects.size() == 1 && found.result.effects.front().name == missing.name;
      const bool is_quiet = std::ranges::all_of(found.result.channels, [](const auto& channel) {
        return channel.explained.rms < 1.1 * (channel.name == "motor_position" ? 100.0 * kServoNoise : kServoNoise);
      });
      named += is_named ? 1 : 0;
      quiet += is_quiet ? 1 : 0;
      cases += 1;
    }
  }
  CHECK_TRUE(10 * named >= 9 * cases);
  CHECK_TRUE(10 * quiet >= 8 * cases);
}

TEST(ExplainElectromechanical, RecordWithoutASetpointIsRefused) {
  Record record = servo_record({});
  record.channels.erase(record.channels.begin());
  STRCMP_CONTAINS("setpoint", refusal([&] { explain_servo(record); }).c_str());
}

}  // namespace hotfire::test
