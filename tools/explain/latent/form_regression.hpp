// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tools/explain/latent/form.hpp"

namespace hotfire::explain {

/// How well a form explains what a model leaves.
struct FormScore {
  double criterion = 0.0;        ///< BIC with an unknown level of noise; less is better
  double left = 0.0;             ///< mean square over noise of what it leaves
  Eigen::VectorXd coefficients;  ///< in the site's unit for a unit of each regressor
  Eigen::VectorXd move;          ///< of the problem's parameters beside them
};

/// Single precision takes half of the time. It resolves what a form leaves to about a millionth of what is left without
/// any: enough for a screening, but of a large effect the right form leaves less.
enum class Precision { single, full };

/// Regression of what a model leaves on the responses of forms at one place: every regressor acts along the linear flow,
/// and its coefficient is that of least squares on the readings, where the noise is white. Declared parameters move beside
/// it within their tolerances, and so do the zeros of the records. A coefficient has the full input of its place as prior
/// deviation (`FlowScales`).
class FormRegression {
 public:
  /// Where the arguments of forms come from. What a smoother makes of the states contains the signal itself and may explain
  /// it without being its cause; what the model simulates is off by what the signal does.
  enum class Arguments { simulated, smoothed };

  /// The problem is to outlive the regression. `input`: of the place, its signal and states.
  FormRegression(const LatentProblem& problem, const LatentPlace& place, const LatentInput& input, Arguments arguments);

  const std::vector<Eigen::MatrixXd>& quantities() const { return quantities_; }
  const LatentProblem& problem() const { return problem_; }
  /// The smoothed signal by experiment, a value a row.
  const std::vector<Eigen::VectorXd>& signal() const { return signal_; }

  /// Scores of forms, in their order.
  std::vector<FormScore> score(std::span<const Form> forms, unsigned threads, Precision precision = Precision::full) const;

  /// What is left without any form, as `FormScore::left` counts it.
  double left_without() const { return left_without_; }
  /// True if a form that leaves `left` leaves no more than one signal at the place does, and little of what is beyond the
  /// noise without any form. Of a small effect alone, everything leaves little.
  bool is_explained_by(double left) const;

 private:
  /// From one row of a record to the next: the flow with the input of the place.
  template <class S>
  struct PlaceFlow {
    Eigen::Matrix<S, kFlowStates, kFlowStates> transition;
    Eigen::Matrix<S, kFlowStates, 1> response;
  };
  /// What every form is regressed on in a record.
  template <class S>
  struct Record {
    std::vector<PlaceFlow<S>> flow;  ///< from every row to the next; empty at a sensor
    /// By channel, a column a row of the record: how the problem's parameters move the reading, then what is left of it.
    std::vector<Eigen::Matrix<S, Eigen::Dynamic, Eigen::Dynamic>> others;
    std::vector<S> unit;  ///< by channel: of a reading over noise; nothing where a signal at a sensor is not read
  };

  template <class S>
  Record<S> record(std::size_t experiment) const;
  template <class S>
  void score_some(const std::vector<Record<S>>& records, std::span<const Form> forms, std::span<FormScore> scores) const;
  Eigen::MatrixXd added_by(const Form& form, std::size_t experiment) const;
  double to_port(const Form& form) const;

  const LatentProblem& problem_;
  LatentPlace place_;
  std::vector<Eigen::VectorXd> signal_;
  std::vector<Eigen::MatrixXd> quantities_;  ///< by experiment
  std::vector<Record<float>> single_;        ///< by experiment
  std::vector<Record<double>> full_;
  Eigen::MatrixXd nuisance_;  ///< normal matrix of the problem's parameters with their prior
  Eigen::VectorXd nuisance_right_;
  double square_ = 0.0;  ///< of what is left
  double count_ = 0.0;
  double left_without_ = 0.0;
};

}  // namespace hotfire::explain
