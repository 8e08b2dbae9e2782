// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <string>
#include <vector>

#include "tools/explain/fit/fit.hpp"
#include "tools/explain/fit/goodness.hpp"
#include "tools/explain/refine/watch.hpp"
#include "tools/explain/terms/candidates.hpp"

namespace hotfire::explain {

/// A candidate added to the current model, fitted while all that was free before moves linearly.
struct Screened {
  Candidate candidate;
  Fitted fitted;
  /// BIC less that of the current model, whose own parameters were moved by the same linear fits; negative is better.
  double criterion = 0.0;
  double seconds = 0.0;
  bool good = false;      ///< false: no start could be simulated
  bool scanned = true;    ///< false: still waits for a law that it contains, to start from there
  double left = 1.0;      ///< rms error on the rows a fit sees, over that of the current model
  bool replaces = false;  ///< a term that replaces the signal of its site as a whole
};

/// Ranks candidates around one model. A candidate's own parameters are simulated with gradients; what was free before
/// (declared parameters, effects already kept) moves along its derivatives at the current model and within its priors. That
/// costs a tenth of a joint fit and leaves the ranking to the candidates' shapes, not to a wrong declared value.
///
/// Three stages: a scan of starts, short fits of all from their best starts, a full fit of the best names; the hopeless ones
/// stop there.
class Screening {
 public:
  Screening(const Evaluator& evaluator, const Fitted& current, const Scales& scales, unsigned threads);

  /// Screens candidates and returns those that could be simulated, best first.
  std::vector<Screened> run(const std::vector<Candidate>& candidates, const std::string& stage, const Watch& watch) const;

  /// Fits an effect once more, from the best of its usual starts and of each of its parameters set a factor of five up and
  /// down from `own`: the way out of a local minimum. Not good if none ends clearly below `own`. The current model is to
  /// hold the effect with these values fixed.
  Screened restart(const Candidate& candidate, const std::vector<double>& own, const Watch& watch) const;

 private:
  enum class Stage { scan, short_fit, full_fit };
  static constexpr std::size_t kStages = 3;

  struct Start {
    std::vector<double> u;  ///< all coordinates, the frozen ones moved linearly
    double cost = 0.0;
    Eigen::VectorXd residual;  ///< with the frozen ones where they are
  };

  /// The channel whose spectrum says where a frequency starts.
  std::size_t first_used() const { return evaluator_.data().used.front() ? 0 : 1; }
  Fitted with_candidate(const Candidate& candidate) const;
  std::vector<Start> scan(Fitted fitted, const std::vector<std::vector<double>>& points) const;
  /// Halves the step of a scan of one parameter about its best start, the first of `starts`. The error of a law that
  /// switches has ripples over its parameter, and a fit from a start far off ends in one.
  void narrow(const Fitted& fitted, std::vector<Start>& starts) const;
  /// The channel that shows a sinusoid: a sensor's own shows in that sensor alone.
  std::size_t channel_of_sinusoid(const Candidate& candidate) const {
    return candidate.name == model::UnlistedRipple::name ? static_cast<std::size_t>(candidate.option) : first_used();
  }
  /// Where the sinusoids of the candidates start, by channel.
  std::vector<std::vector<double>> sharpened_for(const std::vector<Candidate>& candidates) const;
  /// `sharpened`: where a sinusoid starts, by channel.
  Screened start(const Candidate& candidate, const std::vector<std::vector<double>>& sharpened) const;
  void start_from_siblings(std::vector<Screened>& screened, const std::vector<std::string>& names, const Watch& watch) const;
  /// Continues the fit of a candidate, as a stage does. `tangent`: of its `fitted`.
  void improve(Screened& screened, Stage stage, Tangent& tangent) const;
  /// The same, so often, or until it is interrupted.
  void improve(Screened& screened, Stage stage, int passes, const Watch& watch) const;
  /// Coordinates with the frozen ones where they are.
  std::vector<double> at_frozen(std::vector<double> u) const;
  double eliminated_cost(const Eigen::VectorXd& residual, Eigen::VectorXd& move) const;
  std::vector<ChannelFit> mean_squares(const Eigen::VectorXd& residual) const;

  const Evaluator& evaluator_;
  Fitted current_;  ///< tempered as this evaluator's rows are coloured
  const Scales& scales_;
  unsigned threads_;
  Frozen frozen_;
  Goodness goodness_;
  Prediction prediction_;            ///< of the current model
  std::vector<double> frequencies_;  ///< strongest in what is left
  Eigen::VectorXd weight_;           ///< of every residual, noise and temper
  Eigen::VectorXd prior_;            ///< information of each frozen parameter's prior
  Eigen::VectorXd prior_gradient_;
  Eigen::LLT<Eigen::MatrixXd> normal_;
  double cost_ = 0.0;  ///< of the current model, as `eliminated_cost` counts it
  /// BIC of the current model where its own parameters go in each stage without a candidate.
  std::array<double, kStages> unaided_{};
};

}  // namespace hotfire::explain
