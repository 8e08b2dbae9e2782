// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/explain/experiment/next_experiment.hpp"
#include "tools/explain/refine/refiner.hpp"
#include "tools/explain/terms/trial.hpp"
#include "tools/explain/words/reasons.hpp"

namespace hotfire::explain {

/// What one round of a search came to.
struct RoundResult {
  std::vector<Trial> trials;   ///< of every candidate that was screened
  std::optional<Kept> kept;    ///< the best, if it is supported
  Assessed model;              ///< with it
  bool settled = false;        ///< `model` was fitted under fine steps
  std::optional<Rival> rival;  ///< of the best
};

/// The best effect of a round is not kept, for a reason that follows its held-out error.
void refuse(std::span<Trial> of_round, std::string_view why);

/// One round of a search: of the candidates screened beside a current model the best are fitted jointly with everything
/// else, and the best of those is kept if it lowers the BIC and the held-out error clearly.
class Round {
 public:
  /// `current` and what the refiner refers to are to outlive the round.
  Round(int number, const Dataset& data, const Refiner& refiner, const Assessed& current, std::vector<Screened> screened,
        const Watch& watch);

  /// Runs the round. If it was interrupted it keeps none, and its trials say how far it came. `unless_complete`: why an
  /// effect that leaves more than noise is not kept; none: it is.
  RoundResult run(std::optional<words::Reason> unless_complete = std::nullopt);

 private:
  bool clears_up(const Assessed& with) const;
  bool is_worth_a_name(const Trial& trial, const Assessed& with) const;
  bool is_decided_against(std::size_t wanted) const;
  bool is_near_noise(std::size_t finalist) const;
  void fit_finalists();
  void leave_local_minima();
  void add_richer_laws();
  void rank();
  Assessed winner();
  RoundResult undecided();
  std::optional<Rival> rival_of(const Kept& kept) const;
  void report_progress(const std::string& what, std::size_t finalist, double share) const;

  int number_;
  const Dataset& data_;
  const Refiner& refiner_;
  const Assessed& current_;
  std::vector<Screened> screened_;
  const Watch& watch_;
  std::vector<Trial> trials_;        ///< one for each screened
  std::vector<Assessed> finalists_;  ///< one for each screened; not good() if it was not fitted jointly
  std::vector<std::size_t> order_;   ///< those that are to be, or were
  std::optional<std::size_t> best_;  ///< by the BIC, of those that were
};

}  // namespace hotfire::explain
