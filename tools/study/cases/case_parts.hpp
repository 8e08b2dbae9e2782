// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/study/cases/case.hpp"
#include "tools/study/cases/profiles.hpp"

namespace hotfire::study {

// What cases of one axis and of two are made of.

/// A thousandth of the sensor noise is far above it.
inline constexpr double kIntegratorTolerance = 1e-8;
/// Long against the slowest mode of the loop, 1/17 s, and the washout's 1/6.3 s.
inline constexpr double kSettling = 10.0;
/// Magnitudes of an effect that are drawn before it is given up.
inline constexpr int kDraws = 12;

bool measures_load_pressure(const CaseOrder& order);

/// An axis whose parameters lie within their declared tolerances, from the random stream `part` of the case.
ReferenceAxis scattered_axis(const CaseOrder& order, std::uint64_t part);

/// An axis as a model file, with tolerances and noise; `effects` is TOML. Of two axes it is both.
std::string model_toml(const ReferenceAxis& axis, const CaseOrder& order, const std::string& effects);

/// The reference reads a row at the end of its command: shifted, rows are read at the times of the commands.
std::vector<double> one_row_later(std::vector<double> commands);

double quantised(double value, const SensorGrade& grade);

/// A value as its sensor reads it.
double noisy(double value, const SensorGrade& grade, double factor, Random& random);

double rms_of_difference(const ReferenceRows& a, const ReferenceRows& b, std::size_t channel);

/// Adds a law drawn at random to a case, beside the effects that its plan has. It is the first of the case's draws that
/// alone makes 3 to 75 times the sensor noise in the loudest channel of the unseen record, that leaves the axis stable, and
/// whose motion a change by a thousandth does not change. Throws std::runtime_error if none of 40 does.
void add_wild_law(const CaseOrder& order, const Profile& unseen, StudyCase& made);

/// A case of two axes; otherwise as `make_case`.
StudyCase make_two_axis_case(const CaseOrder& order);

}  // namespace hotfire::study
