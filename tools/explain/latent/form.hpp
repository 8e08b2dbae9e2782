// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/effects/unlisted/term.hpp"
#include "tools/explain/latent/latent_input.hpp"

namespace hotfire::explain {

/// A term of the grammar (model/effects/unlisted/term.hpp) up to its linear coefficients: where it acts, and what it is a
/// law of.
struct Form {
  model::Site site = model::Site::command;
  int channel = -1;  ///< of a sensor's reading
  model::Argument argument = model::Argument::command;
  std::optional<model::Argument> factor{};
  model::MemoryParameters<double> memory{};
  bool curve_first = false;
  std::vector<double> points{};  ///< of the curve, or the widths of the stops; none: a gain
  bool replaces = false;         ///< the signal of its site as a whole: the memory's output for the signal itself
  /// Of a curve in front of a memory that is not linear: its values at its points, up to a common factor. Of an oscillator
  /// what the curve adds to its frequency [Hz].
  std::vector<double> values{};

  bool is_oscillator() const { return memory.kind == model::Memory::oscillator; }
  bool is_stops() const { return memory.kind == model::Memory::stops; }
  bool is_power() const { return model::is_power(memory.kind); }
  /// A linear memory that gives another output in front of a curve than behind it.
  bool is_filter() const {
    return memory.kind == model::Memory::lag || memory.kind == model::Memory::washout ||
           memory.kind == model::Memory::resonance || memory.kind == model::Memory::band_pass;
  }
  /// The argument itself is beside its memory, as the last regressor.
  bool has_direct() const { return memory.kind != model::Memory::none && !is_oscillator(); }
  /// Without points, and of stops with theirs, the curve is no function over its points.
  bool has_curve() const { return !points.empty() && !is_stops(); }
  /// What enters the memory for a value of the argument.
  double entering(double value) const;
  /// How many linear coefficients it has.
  Eigen::Index size() const;
};

/// "stops of spool", "curve of rate x load_pressure".
std::string in_words(const Form& form);

/// Quantities of the axis by row of an experiment, a column for each `model::Argument`: as simulated, with the deviations
/// that a smoother gives.
Eigen::MatrixXd quantities(const LatentProblem& problem, std::size_t experiment, const Eigen::MatrixXd& deviations);

/// True for a law of the record's time, alone or times another quantity.
inline bool is_of_time(const Form& form) {
  return form.argument == model::Argument::time || form.factor == model::Argument::time;
}

/// What the form is a law of, by row: its argument, times its factor.
Eigen::VectorXd argument_of(const Form& form, const Eigen::MatrixXd& quantities);

/// Output of the form's memory by row for what enters it; of stops that of the widest.
Eigen::VectorXd remembered(const Form& form, const Eigen::VectorXd& entering, double period);

/// Forms of one kind of memory that are run side by side: each step of a memory waits for the one before, and the processor
/// computes that of another memory meanwhile.
inline constexpr std::size_t kSideBySide = 4;

/// Outputs of `remembered` for forms of one kind of memory, not stops, that the same enters: a row a form.
Eigen::Matrix<double, kSideBySide, Eigen::Dynamic> remembered_side_by_side(std::span<const Form, kSideBySide> forms,
                                                                           const Eigen::VectorXd& entering, double period);

/// The form's regressors by row, a column a coefficient: what is added at its site for a coefficient of one.
Eigen::MatrixXd regressors(const Form& form, const Eigen::MatrixXd& quantities, double period);

/// Exponents of powers that a search tries.
inline constexpr double kLeastExponent = 1.3;
inline constexpr double kMostExponent = 4.0;

/// True for the signal that the form's site transmits: a law there may replace it. That of the oil's port is the opening of
/// the valve, by which its flow is as well.
bool is_replaced(const Form& form);

/// The form as a law that replaces the signal of its site by what the memory makes of it, without a curve. None where it is
/// a law of another quantity, or where the memory forgets a signal that rests.
std::optional<Form> in_place_of_signal(Form form);

/// The form with the parameter of its memory a factor up and down.
std::vector<Form> neighbours(const Form& form, double factor);

/// The hat functions of a curve at a value: a curve is linear between its points and constant beyond them.
template <class Row>
void add_hats(const std::vector<double>& points, double value, Row&& row) {
  const auto above = std::upper_bound(points.begin(), points.end(), value);
  if (above == points.begin()) {
    row(0) = 1.0;
  } else if (above == points.end()) {
    row(static_cast<Eigen::Index>(points.size()) - 1) = 1.0;
  } else {
    const Eigen::Index k = above - points.begin();
    const double share = (value - *(above - 1)) / (*above - *(above - 1));
    row(k - 1) = 1.0 - share;
    row(k) = share;
  }
}

}  // namespace hotfire::explain
