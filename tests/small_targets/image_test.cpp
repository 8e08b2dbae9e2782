// SPDX-License-Identifier: Apache-2.0
#include "model/image.hpp"

#include <CppUTest/TestHarness.h>

#include <axis.hpp>
#include <string>
#include <table_image.hpp>
#include <vector>

#include "model/direct.hpp"
#include "model/keys.hpp"
#include "tools/files/model/model_file.hpp"

namespace hotfire::test {
namespace {

using Full = model::Simplex<double>::Parameters;
using Small = example::Axis<double>::Parameters;

/// The scalar parameters of a plant that are of its parts, or of an effect that the example has.
template <class Parameters>
std::vector<double> values_of(const Parameters& parameters) {
  std::vector<double> values;
  model::visit_parameters(parameters, [&](const model::Key& key, const auto&, const auto& value) {
    if (!key.is_effect || key.section == model::GimbalFriction::name || key.section == model::SoftStiffness::name) {
      values.push_back(static_cast<double>(value));
    }
  });
  return values;
}

}  // namespace

TEST_GROUP(SmallTargetImage){};

TEST(SmallTargetImage, a_header_has_the_parameters_of_its_model_file_bit_for_bit) {
  const ModelFile file = load_model(HOTFIRE_EXAMPLE "/axis.toml");
  const std::vector<double> expected = values_of(std::get<Full>(file.parameters));
  const std::vector<double> compiled = values_of<Small>(example::kAxis<double>);
  LONGS_EQUAL(static_cast<long>(expected.size()), static_cast<long>(compiled.size()));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK_TRUE(expected[i] == compiled[i]);
  }
  CHECK_TRUE(example::kAxis<double>.effects.active[0] && example::kAxis<double>.effects.active[1]);
  LONGS_EQUAL(2, std::get<1>(example::kAxis<double>.effects.values).option);
}

TEST(SmallTargetImage, a_float_plant_has_the_nearest_floats_of_the_same_parameters) {
  const std::vector<double> in_double = values_of<Small>(example::kAxis<double>);
  const std::vector<double> in_float = values_of(example::kAxis<float>);
  for (std::size_t i = 0; i < in_double.size(); ++i) {
    CHECK_TRUE(in_float[i] == static_cast<double>(static_cast<float>(in_double[i])));
  }
}

TEST(SmallTargetImage, a_header_has_the_points_of_a_table) {
  using Mass = model::Direct<double>::Parameters;
  constexpr Mass kCompiled = model::parameters_of<Mass>(kTableImage);
  const ModelFile file = load_model(HOTFIRE_TABLE_MODEL);
  const auto tables_of = [](const Mass& parameters) {
    return std::get<model::UnlistedMotion<model::Site::mass_force>::Params<double>>(parameters.effects.values).table;
  };
  const auto expected = tables_of(std::get<Mass>(file.parameters));
  const auto compiled = tables_of(kCompiled);
  LONGS_EQUAL(3, compiled.points);
  CHECK_TRUE(expected.points == compiled.points && expected.x == compiled.x && expected.y == compiled.y);
}

}  // namespace hotfire::test
