// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "tools/explain/fit/scales.hpp"
#include "tools/explain/inference/channel_check.hpp"
#include "tools/explain/inference/veto.hpp"
#include "tools/explain/policy/policy.hpp"
#include "tools/explain/refine/finalists.hpp"
#include "tools/explain/refine/held_start.hpp"
#include "tools/explain/refine/refiner.hpp"
#include "tools/explain/refine/watch.hpp"
#include "tools/explain/search/declared_effects.hpp"
#include "tools/explain/search/harmful_effects.hpp"
#include "tools/explain/search/name_beside_signal.hpp"
#include "tools/explain/search/rivals.hpp"
#include "tools/explain/search/round.hpp"
#include "tools/explain/search/unlisted_stage.hpp"
#include "tools/explain/words/reasons.hpp"
#include "tools/explain/words/refusals.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::explain {

namespace {

/// Rows no closer than this separate candidates [time constants of the servo]: 2 ms of the reference axis. The fastest that
/// an axis does in its sensors is tens of hertz.
constexpr double kRankingPeriod = 0.034;
/// A lightly damped mass measured to a thousandth shows what half as many steps shift its resonance by.
bool is_ranked_coarsely(const ModelFile& model) { return is_hydraulic_axis(model.parameters); }

/// The state of one search.
class Search {
 public:
  Search(const Dataset& data, const ModelFile& model, const SearchOptions& options)
      : data_(data),
        model_(model),
        options_(options),
        thin_(rows_for_ranks(data, model)),
        fine_(data, Resolution::fine, is_ranked_coarsely(model) ? Resolution::coarse : Resolution::fine),
        coarse_(thin_, is_ranked_coarsely(model) ? Resolution::coarse : Resolution::fine,
                is_ranked_coarsely(model) ? Resolution::rough : Resolution::fine),
        rough_(thin_, Resolution::rough),
        scales_(scales_of(model.parameters, data)),
        refiner_(data, is_ranked_coarsely(model) ? rough_ : coarse_, coarse_, fine_, scales_, options.threads,
                 options.watch),
        rivals_(refiner_, options.watch, result_),
        unlisted_(data, refiner_, coarse_, scales_, options, rivals_, result_) {}

  /// The declared model within its tolerances.
  const Assessed& calibrate() {
    Fitted start;
    start.base = model_.parameters;
    start.free = declared_parameters(start.base, model_.tolerance);
    start.u.assign(start.free.size(), 0.0);
    for (const FreeParameter& state : initial_states(data_, scales_, start.u)) {
      start.free.push_back(state);
    }
    start.temper.assign(data_.channels.size(), 1.0);
    result_.declared = assess(fine_, options_.threads, start);
    if (is_hydraulic_axis(start.base)) {
      refuse_impossible_channels(data_, result_.declared.prediction);
    }
    options_.watch.progress({Work::calibrating, "calibrating the declared parameters within their tolerances"});
    result_.calibrated = calibrated(start);
    if (!result_.calibrated.good()) {
      throw FileError(words::diverges_declared(model_.path.string()));
    }
    return result_.calibrated;
  }

  /// The first two rounds; `run` does the rest.
  const Assessed& run_first_rounds() {
    result_.explained = result_.calibrated;
    goes_on_ = options_.most_effects > 0 && add_round();
    of_first_round_ = unlisted_.found();
    goes_on_ = goes_on_ && options_.most_effects > 1 && add_round();
    // Where no single signal explains the records, no single term does: first the names are compared.
    if (!result_.kept.empty() && unlisted_.has_single_signal()) {
      unlisted_.replace_names_that_explain_little();
    }
    return result_.explained;
  }

  SearchResult run() {
    if (options_.most_effects > 0 && unlisted_.wants_another_start()) {
      start_from_name();
    }
    for (int count = 2; count < options_.most_effects && goes_on_; ++count) {
      goes_on_ = add_round();
      unlisted_.replace_names_that_explain_little();
    }
    if (!result_.kept.empty() && !options_.watch.interrupted()) {
      settle();
      rivals_.compare_again();
    }
    if (options_.most_effects > 0) {
      unlisted_.finish();
      if (take_out_harmful(data_, refiner_, options_.watch, result_)) {
        unlisted_.finish();
        take_out_harmful(data_, refiner_, options_.watch, result_);
      }
    }
    result_.not_supported =
        effects_without_support(data_, refiner_, result_.declared.model.base, result_.explained, options_.watch);
    result_.searched = options_.most_effects > 0;
    result_.interrupted = options_.watch.interrupted();
    return std::move(result_);
  }

 private:
  /// One round, and what it makes superfluous. Returns whether it added an effect.
  bool add_round() {
    const int round = result_.next_round();
    if (options_.watch.interrupted() || is_complete(data_, result_.explained) ||
        !add_effect(round, unlisted_.locate_explained())) {
      return false;
    }
    take_out_superfluous(round);
    return true;
  }

  /// Where two listed effects leave more than noise, more are missing or one that is not listed. What explains most alone
  /// may imitate all of them. The search starts again from the name without which an unknown signal costs most: with another
  /// listed effect, then with terms of unknown law beside it. Without such a name one term of unknown law is tried. What
  /// leaves only noise, or clearly less than the first rounds, is kept.
  void start_from_name() {
    options_.watch.progress({Work::locating, "comparing listed effects beside an unknown signal"});
    const auto name = name_that_saves_most(coarse_.data(), result_.calibrated.model, screened_beside_calibrated(),
                                           unlisted_.share_of_signal(), options_.threads, options_.watch);
    if (!name || options_.watch.interrupted()) {
      unlisted_.replace_names_that_explain_little();
      goes_on_ = !unlisted_.replace_name_beside_single_signal() && goes_on_;
      return;
    }
    UnlistedStage::Found names = unlisted_.found();
    bool was_settled = is_settled_;
    const std::vector<Kept>& first = of_first_round_.kept;
    const bool is_first = first.size() == 1 && first.front().trial.candidate.name == name->candidate.name;
    if (is_first) {
      unlisted_.restore(of_first_round_);
    } else {
      unlisted_.start_from(*name);
      UnlistedStage::Found alone = unlisted_.found();
      const bool has_second = add_round();
      if (is_complete(data_, result_.explained) || unlisted_.is_clearly_better(result_.explained, names.explained)) {
        names = unlisted_.found();
        was_settled = is_settled_;
        goes_on_ = has_second;
      }
      if (!is_complete(data_, result_.explained)) {
        unlisted_.restore(std::move(alone));
      }
    }
    if (is_complete(data_, result_.explained) || unlisted_.add_terms_to_names() ||
        unlisted_.is_clearly_better(result_.explained, names.explained)) {
      goes_on_ = false;
    } else {
      unlisted_.give_up_terms(std::move(names));
      is_settled_ = was_settled;
    }
    unlisted_.file_hypothesis();
  }

  /// All laws beside the calibrated model, screened: those of the first round, and the others.
  std::vector<Screened> screened_beside_calibrated() const {
    std::vector<Candidate> others = candidates_beside(result_.calibrated.model.base, data_);
    std::erase_if(others, [&](const Candidate& candidate) {
      return std::ranges::any_of(first_screened_, [&](const Screened& s) { return label(s.candidate) == label(candidate); });
    });
    std::vector<Screened> all = first_screened_;
    if (!others.empty()) {
      const Evaluator evaluator = refiner_.for_screening(result_.calibrated.model);
      const Screening screening(evaluator, result_.calibrated.model, scales_, options_.threads);
      std::vector<Screened> more = screening.run(others, "beside an unknown signal", options_.watch);
      std::ranges::move(more, std::back_inserter(all));
    }
    std::ranges::sort(all, {}, &Screened::criterion);
    return all;
  }

  /// One round, of the effects at the sites where one signal explains what is missing, or of all where none does. The linear
  /// flow that carries a signal is wrong about friction that sticks: where those sites have no effect and far more than
  /// noise is left, an effect elsewhere is kept if it explains everything. False if no candidate is kept.
  bool add_effect(int round, const Located& where) {
    const Assessed beside = without_compensation(result_.explained);
    std::vector<std::string> found;
    for (const Kept& kept : result_.kept) {
      found.push_back(kept.trial.candidate.site);
    }
    std::vector<Candidate> candidates = candidates_beside(beside.model.base, data_);
    std::erase_if(candidates, [&](const Candidate& c) { return goes_in_and_out(c); });
    const auto refuted = std::stable_partition(candidates.begin(), candidates.end(), [&](const Candidate& candidate) {
      return !where.refutes(candidate.site, found);
    });
    const std::vector<Candidate> elsewhere(refuted, candidates.end());
    candidates.erase(refuted, candidates.end());
    const auto why =
        compensates(data_, result_.explained) ? std::optional(words::Reason::more_than_compensation) : std::nullopt;
    return add_one_of(candidates, round, beside, why) ||
           (excess_over_noise(data_, beside) > policy().near_noise &&
            add_one_of(elsewhere, round, beside, words::Reason::more_than_signal));
  }

  /// One round of some candidates. `unless_complete`: as of Round::run.
  bool add_one_of(const std::vector<Candidate>& candidates, int round, const Assessed& beside,
                  std::optional<words::Reason> unless_complete) {
    if (candidates.empty() || options_.watch.interrupted()) {
      return false;
    }
    const Evaluator evaluator = refiner_.for_screening(beside.model);
    const Screening screening(evaluator, beside.model, scales_, options_.threads);
    auto screened = screening.run(candidates, fmt::format("round {}", round), options_.watch);
    if (result_.kept.empty()) {
      first_screened_.insert(first_screened_.end(), screened.begin(), screened.end());
    }
    Round fits(round, data_, refiner_, beside, std::move(screened), options_.watch);
    RoundResult best = fits.run(unless_complete);
    result_.trials.insert(result_.trials.end(), best.trials.begin(), best.trials.end());
    if (!best.kept) {
      return false;
    }
    rivals_.set_aside();
    result_.kept.push_back(std::move(*best.kept));
    result_.explained = std::move(best.model);
    result_.rival = std::move(best.rival);
    is_settled_ = best.settled;
    polish_earlier(round);
    return true;
  }

  /// A model, with its declared values if they compensate: beside values that do, a missing effect explains nothing.
  Assessed without_compensation(const Assessed& model) const {
    return compensates(data_, model) ? assess(fine_, options_.threads, with_declared_values(model.model)) : model;
  }

  /// True for an effect that was taken out twice: adding it again would go round in a circle.
  bool goes_in_and_out(const Candidate& candidate) const {
    return std::ranges::count_if(result_.trials, [&](const Trial& trial) {
             return trial.decision == "taken out" && trial.candidate.effect == candidate.effect;
           }) >= 2;
  }

  /// The declared model within its tolerances: fast records are dear, so the way there is made on thinned ones.
  Assessed calibrated(const Fitted& declared) const {
    if (fine_.fit_rows() == coarse_.fit_rows()) {
      return refiner_.settled(declared);
    }
    const Assessed near = refiner_.ranked(declared, kRanking);
    return refiner_.settled(near.good() ? near.model : declared);
  }

  /// What was found under fine steps, and over ripples: a model may reach the noise in a ripple of its error beside the one
  /// where nothing is left. The records in hand hardly show it, but a motion beyond them would.
  void settle() {
    options_.watch.progress({Work::settling, "fitting what was found with fine steps and over ripples"});
    if (!is_settled_) {
      take(refiner_.settled(result_.explained.model));
    }
    const int round = result_.trials.back().round;
    for (Kept& kept : result_.kept) {
      Candidate law = kept.trial.candidate;
      Assessed simple = refiner_.by_simplest_law(result_.explained, law);
      if (label(law) != label(kept.trial.candidate)) {
        give_law(result_, kept.trial.candidate, {law, std::move(simple)}, round, words::LawChange::simpler);
      }
    }
    // Of effects that explain most of the error, a ripple may be as high as what they leave.
    const double height =
        std::max(policy().near_noise, policy().little_explained * excess_over_noise(data_, result_.calibrated));
    Assessed beyond = refiner_.over_ripples(result_.explained, height);
    if (excess_over_noise(data_, beyond.prediction) < excess_over_noise(data_, result_.explained.prediction)) {
      take(refiner_.settled(beyond.model));
    }
  }

  /// Another fit of what was found, if it could be simulated.
  void take(Assessed model) {
    if (model.good()) {
      result_.explained = std::move(model);
    }
  }

  /// What an effect looked like while another was missing may be a local minimum now.
  void polish_earlier(int round) {
    for (std::size_t i = 0; i + 1 < result_.kept.size(); ++i) {
      Assessed again = refiner_.from_other_starts(round, result_.explained, result_.kept[i].trial.candidate);
      if (Goodness::combined(again.goodness.fitted) < Goodness::combined(result_.explained.goodness.fitted)) {
        take(refiner_.settled(again.model));
      }
      take_richer_law(round, result_.kept[i].trial.candidate);
    }
  }

  /// Gives an effect that was kept before a law with more parameters, if that is clearly better now.
  void take_richer_law(int round, Candidate& candidate) {
    for (OfLaw& richer : refiner_.of_richer_laws(round, result_.explained, candidate)) {
      Trial trial;
      compare(trial, richer.model, result_.explained, richer.model.goodness.fitted);
      if (is_supported(trial)) {
        richer.model = refiner_.settled(richer.model.model);
        give_law(result_, candidate, std::move(richer), round, words::LawChange::richer);
      }
    }
  }

  /// Takes out every effect without which the model is as good, or reaches the noise, where the search would have ended:
  /// earlier ones that the last has replaced, and the last if all it did was to lead the others, or the calibration, out of
  /// a local minimum.
  void take_out_superfluous(int round) {
    const std::size_t newest = result_.kept.size() - 1;
    for (std::size_t i = newest + 1; i-- > 0;) {
      Trial trial{
          round,
          result_.kept[i].trial.candidate,
          false,
          0.0,
          1.0,
          0.0,
          "taken out",
          std::string(words::text(i == newest ? words::Reason::superfluous_newest : words::Reason::superfluous_earlier))};
      options_.watch.progress({Work::deciding, fmt::format("round {}: is {} still needed", round, label(trial.candidate))});
      const Stopwatch stopwatch;
      Assessed rest = refiner_.without(result_.explained.model, trial.candidate);
      if (result_.kept.size() == 1) {
        rest = better_of(std::move(rest), result_.calibrated);  // an earlier round may have led it out of a local minimum
      }
      if (rest.good()) {
        compare(trial, rest, result_.explained, rest.goodness.fitted);
      }
      trial.seconds = stopwatch.seconds();
      const bool may_go = rest.good() && (is_as_good(trial) || is_complete(data_, rest));
      if (Assessed settled = may_go ? refiner_.settled(rest.model) : Assessed{}; settled.good()) {
        rest = std::move(settled);
      }
      if (may_go && !is_more_credible(data_, result_.explained, rest)) {
        result_.trials.push_back(trial);
        if (i == newest) {
          result_.rival.reset();
        }
        result_.kept.erase(result_.kept.begin() + static_cast<std::ptrdiff_t>(i));
        result_.explained = std::move(rest);
        if (result_.kept.empty()) {
          result_.calibrated = result_.explained;
          unlisted_.forget();
        }
      }
    }
  }

  const Dataset& data_;
  const ModelFile& model_;
  const SearchOptions& options_;
  const Dataset thin_;
  Evaluator fine_;
  Evaluator coarse_;
  Evaluator rough_;
  Scales scales_;
  Refiner refiner_;
  SearchResult result_;
  std::vector<Screened> first_screened_;  ///< of the first round
  bool is_settled_ = true;                ///< what was found was fitted with fine steps
  UnlistedStage::Found of_first_round_;
  bool goes_on_ = false;  ///< the first two rounds have left a way on
  Rivals rivals_;
  UnlistedStage unlisted_;
};

}  // namespace

Dataset rows_for_ranks(const Dataset& data, const ModelFile& model) {
  return is_ranked_coarsely(model)
             ? thinned(data, kRankingPeriod * servo_time(std::get<SimplexParameters>(model.parameters)))
             : data;
}

SearchResult search(Dataset& data, const ModelFile& model, const SearchOptions& options) {
  // A missing effect may hide how a record starts, and remember it. Each restart takes more rows out at a start.
  while (true) {
    Search attempt(data, model, options);
    if (forget_moving_starts(model.parameters, attempt.calibrate().prediction, data)) {
      continue;
    }
    const Assessed& found = attempt.run_first_rounds();
    if (!forget_moving_starts(model.parameters, found.prediction, data) &&
        !forget_held_starts(found.model, options.threads, data)) {
      return attempt.run();
    }
  }
}

}  // namespace hotfire::explain
