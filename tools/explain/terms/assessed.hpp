// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/explain/fit/fit.hpp"
#include "tools/explain/fit/goodness.hpp"
#include "tools/explain/terms/candidates.hpp"

namespace hotfire::explain {

/// A fitted model with what it predicts and how well.
struct Assessed {
  Fitted model;
  Prediction prediction;
  Goodness goodness;
  Zeros zeros{};                     ///< of the records under this model
  std::vector<double> by_longer{};   ///< rms of what longer steps change, over the noise, by channel; empty: not known
  std::vector<double> step_error{};  ///< the same of half the step; empty: not what the model leaves

  bool good() const { return !prediction.empty(); }
};

/// How much is spent on a joint fit: `iterations` of the solver for each of up to `passes` tempers, until the cost changes
/// by less than `tolerance`.
struct Effort {
  int iterations = 0;
  int passes = 0;
  double tolerance = 0.0;
  Slopes slopes = Slopes::narrow;
};
inline constexpr Effort kGlance{5, 1, 1e-3};                      ///< which proposal is worth a fit
inline constexpr Effort kCheck{12, 1, 1e-4};                      ///< is an effect still needed
inline constexpr Effort kRanking{16, 3, 1e-4};                    ///< which finalist is best
inline constexpr Effort kOverRipples{16, 2, 1e-4, Slopes::wide};  ///< out of a minimum that is a ripple
inline constexpr Effort kFinal{30, 3, 1e-5};                      ///< what the report says
inline constexpr Effort kAllRows{16, 1, 1e-5};                    ///< a small move: to the rows that were held out

/// What a model leaves of the rows that a fit uses: Goodness::combined. Infinite if it could not be simulated.
double left_by(const Evaluator& evaluator, const Fitted& model, unsigned threads);

/// A model with what it predicts under fine steps.
Assessed assess(const Evaluator& fine, unsigned threads, const Fitted& fitted);

/// Joint fit of everything that is free on `evaluator`, tempered by its own residuals until the temper converges, assessed
/// under fine steps on every row, with what the steps of `evaluator` change. Not good() if the start or the end can't be
/// simulated.
Assessed refined(const Evaluator& evaluator, const Evaluator& fine, unsigned threads, Fitted fitted, const Effort& effort);

/// Share of what a model leaves of a channel that long steps may change.
inline constexpr double kLostToSteps = 0.5;
/// True if longer steps change a channel by more than that share of what a model leaves there beyond the noise: a fit under
/// such steps ended elsewhere.
bool leaves_what_steps_do(const Dataset& data, const Assessed& assessed);

/// Measures the step error of a model that leaves what longer steps do. `coarse` takes twice the step.
void measure_step_error(const Dataset& data, const Evaluator& coarse, unsigned threads, Assessed& assessed);

/// What a model leaves beyond the noise (goodness.hpp) and beyond the error of its own steps, in the channel where that is
/// largest. A slip starts at the end of a step, so the error is of first order: half the step changes half of it.
double excess_over_noise(const Dataset& data, const Assessed& assessed);

/// True if every channel's residual is noise but for a part that the sensor could not show.
bool reaches_noise(const Dataset& data, const Assessed& assessed);

/// The declared parameter that is furthest from its declaration: its key, and how many tolerances off. Zero and no key where
/// none is free.
struct Moved {
  std::string key;
  double tolerances = 0.0;
};
Moved farthest_from_declared(const Fitted& model);

/// True if no declared parameter had to go so far from its declaration that it compensates for something.
bool is_within_tolerances(const Fitted& model);

/// True if a model reaches the noise within its tolerances: there is nothing to search for.
bool is_complete(const Dataset& data, const Assessed& assessed);

/// True if a model reaches the noise beyond its tolerances only: such values of the declared parameters, and effects that
/// need them, imitate what is missing.
bool compensates(const Dataset& data, const Assessed& assessed);

/// True if a model is complete, another one compensates, and the posterior odds are for the model: BIC with the squared
/// distances of all parameters from their priors. Friction that never slips is a spring: it reaches the noise beside a
/// stiffness as declared, with more parameters than the stiffness that compensates, and far from its typical level.
bool is_more_credible(const Dataset& data, const Assessed& model, const Assessed& than);

/// Takes the free parameters of which `unwanted` is true out of a model.
template <class F>
void drop_parameters(Fitted& model, F&& unwanted) {
  for (std::size_t k = model.free.size(); k-- > 0;) {
    if (unwanted(model.free[k])) {
      model.free.erase(model.free.begin() + static_cast<std::ptrdiff_t>(k));
      model.u.erase(model.u.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }
}

/// A model without one of its effects, the other parameters where they are.
Fitted without_effect(const Fitted& model, const Candidate& candidate);

/// A model with its declared parameters as declared, the effects where they are: a calibration that had to compensate for a
/// missing effect is further from the truth than the declaration.
Fitted with_declared_values(Fitted model);

/// True if the declared parameters are further from their declaration than its tolerances, in the mean: a calibration of no
/// model that is right.
bool is_far_from_declared(const Fitted& model);

/// Whichever leaves less on the rows that a fit sees; the first if the second could not be simulated.
Assessed better_of(Assessed first, Assessed second);

/// BIC of one model less that of another, on given effective samples.
double criterion_change(const Assessed& with, const Assessed& without, const std::vector<ChannelFit>& effective);

/// Held-out error of one model over that of another, as `error_ratio` counts it.
double held_out_ratio(const Assessed& with, const Assessed& without);

/// True if a model leaves clearly more of the held-out rows than another, in any channel. One that is far off in both must
/// not hide the others.
bool leaves_clearly_more(const Assessed& one, const Assessed& other);

/// True if held-out rows show more than noise of what a model is missing.
bool held_out_rows_contain_more(const Assessed& model);

/// True if held-out rows confirm a model that explains more of the fitted ones. Held-out rows may contain nothing of what is
/// missing, such as a limit that only the fastest motion reaches. Such rows can only refute it.
/// Beside a calibration beyond its tolerances they have to confirm: that calibration may be what is wrong.
bool held_out_rows_agree(const Assessed& with, const Assessed& without);

}  // namespace hotfire::explain
