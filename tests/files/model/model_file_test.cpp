// SPDX-License-Identifier: Apache-2.0
#include "tools/files/model/model_file.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"
#include "tools/files/model/model_layout.hpp"

namespace hotfire {

using test::expect_message;

namespace {

const std::string kSimplex = "schema = 1\ntopology = \"simplex\"\n";
const std::string kDirect = "schema = 1\ntopology = \"direct\"\n[mass]\ninertia = 2.0\n";

/// Numbers with all 53 bits in use, between two bounds, in logarithms where the bounds are positive and far apart.
class RandomNumbers {
 public:
  double between(double lower, double upper) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    const double part = static_cast<double>(state_ >> 11) * 0x1p-53;
    return lower > 0.0 ? lower * std::pow(upper / lower, part) : lower + (upper - lower) * part;
  }

 private:
  std::uint64_t state_ = 7;
};

void fill_group(KeyGroup& group, int option, RandomNumbers& random) {
  if (!group.options.empty()) {
    *group.option = option % static_cast<int>(group.options.size());
  }
  if (group.active != nullptr) {
    *group.active = true;
  }
  for (const NumberKey& number : group.numbers) {
    if (group.uses(number.options)) {
      *number.value = random.between(number.lower, number.upper);
    }
  }
  // Curves of one group may share their points, whatever they depend on.
  for (const CurveKey& curve : group.curves) {
    *curve.points = 0;
  }
  for (const CurveKey& curve : group.curves) {
    if (!group.uses(curve.options)) {
      continue;
    }
    *curve.points = static_cast<int>(curve.capacity);
    for (int point = 0; point < *curve.points; ++point) {
      curve.x[point] = point + random.between(0.1, 0.9);
      curve.y[point] = random.between(curve.y_lower, curve.y_upper);
    }
  }
}

/// Every effect that one axis can have is active, every parameter that acts under the chosen options has a number inside its
/// bounds, every declared parameter a tolerance and every channel a noise.
void fill(ModelFile& model, int option) {
  RandomNumbers random;
  ModelLayout layout = layout_of(model);
  for (KeyGroup& part : layout.parts) {
    fill_group(part, option, random);
    for (const NumberKey& number : part.numbers) {
      model.tolerance[std::string{part.name} + "." + std::string{number.name}] = random.between(0.001, 1.0);
    }
  }
  for (KeyGroup& effect : layout.effects) {
    if (!effect.needs_other_axis) {
      fill_group(effect, option, random);
    }
  }
  for (const ModelChannel& channel : layout.channels) {
    model.noise[std::string{channel.name}] = random.between(1e-9, 1.0);
  }
}

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

void check_same_group(const KeyGroup& one, const KeyGroup& other) {
  for (std::size_t i = 0; i < one.numbers.size(); ++i) {
    CHECK_TEXT(same_bits(*one.numbers[i].value, *other.numbers[i].value), one.numbers[i].name.data());
  }
  CHECK(one.active == nullptr || (*one.active == *other.active && *one.option == *other.option));
  for (std::size_t c = 0; c < one.curves.size(); ++c) {
    LONGS_EQUAL(*one.curves[c].points, *other.curves[c].points);
    MEMCMP_EQUAL(one.curves[c].x, other.curves[c].x, one.curves[c].capacity * sizeof(double));
    MEMCMP_EQUAL(one.curves[c].y, other.curves[c].y, one.curves[c].capacity * sizeof(double));
  }
}

void check_same_bits(ModelFile& expected, ModelFile& actual) {
  const ModelLayout left = layout_of(expected);
  const ModelLayout right = layout_of(actual);
  for (const auto groups : {&ModelLayout::parts, &ModelLayout::effects}) {
    for (std::size_t g = 0; g < (left.*groups).size(); ++g) {
      check_same_group((left.*groups)[g], (right.*groups)[g]);
    }
  }
  CHECK(expected.noise == actual.noise);
  CHECK(expected.tolerance == actual.tolerance);
  STRCMP_EQUAL(expected.name.c_str(), actual.name.c_str());
}

}  // namespace

TEST_GROUP(Model) {
  test::Scratch scratch;

  ModelFile load(const std::string& content) const { return load_model(scratch.write("m.toml", content)); }
  SimplexParameters simplex(const std::string& more) const {
    return std::get<SimplexParameters>(load(kSimplex + more).parameters);
  }
  std::string refused(const std::string& content) const {
    return test::refusal([&] { load(content); });
  }
  void check_round_trip(ModelFile model, int option) const {
    model.name = "a \"quoted\" name, a \\, a\ttab, a\nline and \xC2\xB5";
    fill(model, option);
    ModelFile again = load(model_text(model));
    check_same_bits(model, again);
    LONGS_EQUAL(0, again.left_out.size());
  }
};

TEST(Model, written_and_read_back_has_the_same_bits_with_every_effect_and_option) {
  for (int option = 0; option < 3; ++option) {
    ModelFile model;
    model.parameters = SimplexParameters{};
    check_round_trip(model, option);
    model.parameters = DirectParameters{};
    check_round_trip(model, option);
    model.parameters = ImposedMotionParameters{};
    check_round_trip(model, option);
    model.parameters = ModalParameters{};
    check_round_trip(model, option);
  }
}

TEST(Model, negative_zero_and_numbers_beyond_64_bit_integers_survive_the_text) {
  ModelFile model;
  DirectParameters parameters;
  parameters.effects.active.fill(true);
  std::get<model::ForceOffset::Params<double>>(parameters.effects.values).force = -0.0;
  std::get<model::QuadraticStiffness::Params<double>>(parameters.effects.values).stiffness = 123456789012345.0;
  std::get<model::CubicStiffness::Params<double>>(parameters.effects.values).stiffness = 1e15;
  model.parameters = parameters;
  ModelFile again = load(model_text(model));
  check_same_bits(model, again = load(model_text(again)));
  const auto& effects = std::get<DirectParameters>(again.parameters).effects.values;
  CHECK(std::signbit(std::get<model::ForceOffset::Params<double>>(effects).force));
}

TEST(Model, a_string_carries_its_unit_and_a_bare_number_is_si) {
  const SimplexParameters parameters = simplex(
      "[servovalve]\nrated_flow = \"50 gallon/minute\"\n[actuator]\npiston_area = \"24.8 in^2\"\nsupply_pressure = \"3000 "
      "psi\"\n"
      "[engine]\ninertia = 9490\n");
  DOUBLES_EQUAL(3.15451e-3, parameters.servovalve.rated_flow, 1e-8);
  DOUBLES_EQUAL(0.0160, parameters.actuator.piston_area, 1e-6);
  DOUBLES_EQUAL(20.684e6, parameters.actuator.supply_pressure, 1e3);
  DOUBLES_EQUAL(9490.0, parameters.engine.inertia, 0.0);
}

TEST(Model, what_a_simplex_file_leaves_out_has_its_reference_value_and_is_listed) {
  const ModelFile model = load(kSimplex + "[structure]\nstiffness = 1e8\n");
  const auto& parameters = std::get<SimplexParameters>(model.parameters);
  DOUBLES_EQUAL(1e8, parameters.structure.stiffness, 0.0);
  DOUBLES_EQUAL(9490.0, parameters.engine.inertia, 0.0);
  CHECK(std::count(model.left_out.begin(), model.left_out.end(), "engine.inertia") == 1);
  CHECK(std::count(model.left_out.begin(), model.left_out.end(), "structure.stiffness") == 0);
}

TEST(Model, a_direct_mass_must_have_its_inertia_and_nothing_else) {
  DOUBLES_EQUAL(2.0, std::get<DirectParameters>(load(kDirect).parameters).mass.inertia, 0.0);
  expect_message(refused("schema = 1\ntopology = \"direct\"\n[mass]\ndamping = 1\n"),
                 {"m.toml:3:", "mass.inertia", "missing", "force.time^2/position"});
  expect_message(refused("schema = 1\ntopology = \"direct\"\n"), {"m.toml:1:", "mass.inertia", "missing"});
}

TEST(Model, a_direct_mass_takes_bare_numbers_only) {
  expect_message(refused("schema = 1\ntopology = \"direct\"\n[mass]\ninertia = \"95.1 kg\"\n"),
                 {"m.toml:4:11:", "mass.inertia", "\"95.1 kg\"", "takes no unit", "bare number"});
}

TEST(Model, noise_and_tolerance_are_read_by_channel_and_by_key) {
  const ModelFile model = load(kSimplex +
                               "[sensors]\npiston_noise = \"8 um\"\n[tolerance]\nservovalve.position_gain = 0.03\n"
                               "\"engine.inertia\" = 0.02\nactuator.leakage = \"30 %\"\n");
  DOUBLES_EQUAL(8e-6, model.noise.at("piston"), 1e-18);
  DOUBLES_EQUAL(0.03, model.tolerance.at("servovalve.position_gain"), 0.0);
  DOUBLES_EQUAL(0.02, model.tolerance.at("engine.inertia"), 0.0);
  DOUBLES_EQUAL(0.30, model.tolerance.at("actuator.leakage"), 1e-15);
  LONGS_EQUAL(3, model.tolerance.size());
}

TEST(Model, a_number_of_a_declared_effect_may_have_a_tolerance) {
  const ModelFile model = load(kSimplex +
                               "[tolerance]\neffects.gimbal_friction.coulomb_torque = 0.3\n"
                               "[effects.gimbal_friction]\nlaw = \"coulomb\"\ncoulomb_torque = 11e3\n");
  DOUBLES_EQUAL(0.3, model.tolerance.at("effects.gimbal_friction.coulomb_torque"), 0.0);
  CHECK(parse_model(model_text(model), "again.toml").tolerance == model.tolerance);
}

TEST(Model, an_effect_that_is_present_is_active_with_its_law) {
  const auto effects = simplex("[effects.gimbal_friction]\nlaw = \"dahl\"\ncoulomb_torque = 12e3\n").effects;
  bool active = false;
  SimplexParameters parameters;
  parameters.effects = effects;
  ModelFile model;
  model.parameters = parameters;
  for (const KeyGroup& group : layout_of(model).effects) {
    if (group.name == "gimbal_friction") {
      active = *group.active;
      LONGS_EQUAL(1, *group.option);
      DOUBLES_EQUAL(12e3, *group.numbers[0].value, 0.0);
    } else {
      CHECK(!*group.active);
    }
  }
  CHECK(active);
}

}  // namespace hotfire
