// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire::study {

/// A rig of another size: what a metre, a second and a pascal of the first one are on it. Angles are angles.
struct Similarity {
  double length = 1.0;
  double time = 1.0;
  double pressure = 1.0;
};

/// A hundredth of the size, ten times the speed, half the pressure: no scale is the product of the others by chance.
inline constexpr Similarity kSmallAndFast{0.01, 0.1, 0.5};

/// What a quantity of a unit is multiplied by: products, quotients and powers of m, s, kg, N, Pa, Hz, rad and 1, as the
/// model's keys write them ("m^3/s/Pa", "N.m.s/rad"). Throws std::invalid_argument for any other.
double factor_of(std::string_view unit, const Similarity& similarity);

/// The same model of one axis, its noise too, in the other size; tolerances are relative. Its values may lie outside the
/// bounds of a model file. Throws std::invalid_argument for a key of which the unit is not known, and that is not zero.
ModelFile similar(ModelFile model, const Similarity& similarity);

/// The record that the other rig makes.
Record similar(Record record, const Similarity& similarity);

}  // namespace hotfire::study
