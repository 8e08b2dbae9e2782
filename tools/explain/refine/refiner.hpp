// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tools/explain/policy/policy.hpp"
#include "tools/explain/refine/screening.hpp"
#include "tools/explain/terms/assessed.hpp"

namespace hotfire::explain {

/// A model with an effect by one of its laws.
struct OfLaw {
  Candidate candidate;
  Assessed model;
};

/// Joint fits of everything that is free, as a search needs them.
class Refiner {
 public:
  /// `rough` is for screening and `coarse` for ranks, both on the same rows and the same one where steps must not be rough,
  /// `fine` for what the report says. All are to outlive the refiner.
  Refiner(const Dataset& data, const Evaluator& rough, const Evaluator& coarse, const Evaluator& fine, const Scales& scales,
          unsigned threads, const Watch& watch)
      : data_(data), rough_(rough), coarse_(coarse), fine_(fine), scales_(scales), threads_(threads), watch_(watch) {}

  /// What candidates beside a model are screened on: rough steps, shifted to what coarse ones predict of that model, where
  /// the shift is small against what the model leaves.
  Evaluator for_screening(const Fitted& current) const { return rough_about(current).value_or(coarse_); }

  /// A model that is fitted already, and the share of what it leaves that the first pass of a fit from elsewhere has to stay
  /// below.
  struct ToBeat {
    const Fitted& model;
    double share = 1.0;
  };
  /// Fitted as its rank needs it, the way to near the end under rough steps where they serve. Not good() if the first pass
  /// does not come near to what is to be beaten.
  Assessed ranked(const Fitted& fitted, const Effort& effort, const std::optional<ToBeat>& known = std::nullopt) const;
  /// A screened candidate, ranked. Screening moves what was free before along its derivatives from `frozen`, which may carry
  /// it too far: where another place on that way, or a table that is nothing yet, leaves less than half as much, the fit
  /// starts at the least of them.
  Assessed of_screened(const Fitted& screened, std::span<const double> frozen, const Effort& effort = kRanking) const {
    return ranked(start_of_screened(coarse_, screened, frozen), effort);
  }
  /// A screened held term with everything else, the instants of its samples and all else in turn: under long steps it
  /// samples once a step.
  Assessed of_held(const Screened& screened, std::span<const double> frozen, const Effort& effort) const;
  /// A proposal after a short fit on `evaluator` of everything that is free, if that leaves less.
  Screened shortly(const Evaluator& evaluator, Screened proposal, std::span<const double> frozen) const;
  /// A held term at one period of its samples.
  struct OfPeriod {
    Screened proposed;   ///< at the instants that were proposed; of a signal that is replaced at the best ones
    double least = 0.0;  ///< that it leaves at the best of the instants that are compared
  };
  /// A held term at each period nearby, with the coefficients that were proposed: what leaves least first. No fit moves
  /// samples, since they have no derivative. The periods are whole rows, because the logger of a sampled signal is in step
  /// with it. Coefficients of a regression are too small rather than wrong, and suit samples that are later: instants nearby
  /// are compared. Of a signal that is replaced as a whole, all instants are compared and the best is taken.
  std::vector<OfPeriod> over_periods(const Evaluator& evaluator, const Screened& held) const;
  /// A held term by the period and the phase of its samples that leave least: the best few periods are compared, with their
  /// phases, after a short fit of each. `periods`: one at least.
  Screened with_samples(const Evaluator& evaluator, std::vector<OfPeriod> periods, std::span<const double> frozen) const;
  /// A held term by its own samples or those of another, whichever leaves less after a short fit.
  Screened with_samples_of(const Evaluator& evaluator, const Screened& other, Screened held,
                           std::span<const double> frozen) const;
  /// Fitted under fine steps, as the report says it.
  Assessed settled(const Fitted& fitted, const Effort& effort = kFinal) const {
    return with_step_error(refined(fine_, fine_, threads_, fitted, effort));
  }

  /// A model that leaves something, but less beyond the noise than the ripples of its error are high, may sit in one: it is
  /// fitted along differences that are wider than a ripple, and then along narrow derivatives, from where those ended. The
  /// best of all. `height`: of the ripples, over the noise.
  Assessed over_ripples(Assessed fitted, double height = policy().near_noise) const;
  /// Fitted again with the declared parameters at their declared values, the effects where they are. The better of both.
  Assessed from_declared_values(Assessed fitted) const;
  /// From the declared values, and from other values of this effect, until one reaches the noise. The best of all.
  Assessed from_other_starts(int round, Assessed winner, const Candidate& candidate) const;

  /// An effect by each of its laws that have more parameters, from the typical values of those beside what the model was
  /// calibrated to with the simpler law. Screening ranks the laws beside a calibration without the effect, from which the
  /// one that is right may look no better than one that it contains. Those that are better; none if nothing is missing in
  /// the model.
  std::vector<OfLaw> of_richer_laws(int round, const Assessed& winner, const Candidate& candidate) const;

  /// Where the data leave a parameter of the winner's law open, or do not separate it from an end of its range, a law
  /// without that parameter, started from the winner's values, takes its place if the BIC is no worse. Sets `candidate` to
  /// the law that stays.
  Assessed by_simplest_law(Assessed winner, Candidate& candidate) const;

  /// Without an effect, the others fitted again from where they are; over the ripples too, if that ends near the noise.
  Assessed without(const Fitted& model, const Candidate& candidate) const;

  /// With another effect, or law, in the place of one: `other` as it is in `tied`, all else where it is, fitted together as
  /// the report says it.
  Assessed in_place_of(const Fitted& model, const Candidate& candidate, const Candidate& other, const Fitted& tied) const;

 private:
  Fitted start_of_screened(const Evaluator& evaluator, const Fitted& screened, std::span<const double> frozen) const;
  std::optional<Evaluator> rough_about(const Fitted& model) const;
  Assessed with_step_error(Assessed assessed) const;
  bool is_done(const Assessed& winner) const;
  Screened with_samples_at(const Evaluator& evaluator, Screened held, double rows, double passed) const;
  Screened at_best_instant(const Evaluator& evaluator, const Screened& held, int off) const;
  Assessed from_other_values(const Assessed& winner, const Candidate& candidate) const;

  const Dataset& data_;
  const Evaluator& rough_;
  const Evaluator& coarse_;
  const Evaluator& fine_;
  const Scales& scales_;
  unsigned threads_;
  const Watch& watch_;
};

}  // namespace hotfire::explain
