// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/unlisted_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "tools/explain/inference/veto.hpp"
#include "tools/explain/policy/policy.hpp"
#include "tools/explain/refine/finalists.hpp"
#include "tools/explain/refine/screening.hpp"
#include "tools/explain/terms/unlisted.hpp"
#include "tools/explain/words/conclusions.hpp"
#include "tools/explain/words/reasons.hpp"

namespace hotfire::explain {

namespace {

/// True if names are static laws of the opening that a term of unknown law is a curve over.
bool is_curve_of_the_same(const Candidate& term, const std::vector<Kept>& names) {
  const auto is_of_opening = [](const Candidate& candidate) {
    return candidate.site == model::site_name(model::Site::valve) ||
           candidate.site == model::site_name(model::Site::valve_command);
  };
  return !names.empty() && term.option_name == "value" && is_of_opening(term) &&
         std::ranges::all_of(names, [](const Kept& kept) {
           const std::string& name = kept.trial.candidate.name;
           return name == model::ValveDeadband::name || name == model::ValveAsymmetry::name ||
                  name == model::ValveBias::name;
         });
}

}  // namespace

void UnlistedStage::finish() {
  if (is_worth_a_table() && !options_.watch.interrupted()) {
    const Found names = found();
    // A term beside the name without which a signal costs most is there only where a term alone explains less.
    if (!has_unlisted()) {
      refuse_misplaced_names();
      look_instead();
      take_instead_if_better();
    }
    add_beside(Names::open);
    name_terms();
    return_to_names_if_better(names);
    if (of_names_ && wants_another_start()) {
      take_if_better(*std::exchange(of_names_, {}));
      file_hypothesis();
    }
    drop_light_names();
    drop_names_that_explain_little();
    rivals_.compare_again();
  }
  if (!options_.watch.interrupted() && !reaches_noise(data_, result_.explained)) {
    result_.located = locate_explained();
  }
}

/// A model at the noise whose parameters are far from their declared values is not what the records are of.
bool UnlistedStage::is_worth_a_table() const { return data_.knows_unlisted() && !is_complete(data_, result_.explained); }

/// True if an unknown signal at one place leaves less than what was found: no term of unknown law there leaves less than the
/// signal.
bool UnlistedStage::signal_leaves_less() {
  const double found = excess_over_noise(data_, result_.explained);
  const std::vector<Place>& places = located().places;
  return result_.kept.empty() || places.empty() || std::ranges::any_of(places, [&](const Place& place) {
           return place.is_likely && std::ranges::max(place.leaves) < 1.0 + found * found;
         });
}

/// True if a model leaves less than `share` of what the explained one leaves beyond noise. Noise itself cannot be explained:
/// near it the whole error hardly falls.
bool UnlistedStage::leaves_clearly_less(const Assessed& model, double share) const {
  const double left = excess_over_noise(data_, result_.explained);
  return left > policy().immaterial && excess_over_noise(data_, model) < share * left &&
         held_out_rows_agree(model, result_.explained);
}

/// True if a model leaves no more than the explained one beyond what chance decides, or nothing beyond noise.
bool UnlistedStage::leaves_as_little(const Assessed& model) const {
  return reaches_noise(data_, model) ||
         policy().hardly_less * excess_over_noise(data_, model) <= excess_over_noise(data_, result_.explained);
}

/// The share of what the listed effects leave that a term of unknown law has to stay below.
double UnlistedStage::advantage() const {
  return !result_.kept.empty() && left_by_listed() > policy().little_explained ? policy().held_out_less
                                                                               : policy().clearly_less;
}

Located UnlistedStage::locate_about(const Assessed& model) const {
  if (!is_hydraulic_axis(model.model.base)) {
    return {};
  }
  options_.watch.progress({Work::locating, "locating what is missing"});
  return locate(coarse_.data(), is_within_tolerances(model.model) ? model.model : with_declared_values(model.model),
                options_.threads);
}

const Located& UnlistedStage::located() {
  if (!located_) {
    located_ = locate_about(result_.calibrated);
  }
  return *located_;
}

const Located& UnlistedStage::locate_explained() {
  if (result_.kept.empty()) {
    return located();
  }
  // Two models with the same values of all that is free are the same.
  if (beside_values_ != result_.explained.model.u) {
    beside_explained_ = locate_about(result_.explained);
    beside_values_ = result_.explained.model.u;
  }
  return beside_explained_;
}

void UnlistedStage::restore(Found found) {
  result_.kept = std::move(found.kept);
  result_.explained = std::move(found.explained);
  result_.rival = std::move(found.rival);
  rivals_.restore(std::move(found.aside));
}

UnlistedTask UnlistedStage::task_beside(const Assessed& model, const Located& located) const {
  return {.data = data_,
          .refiner = refiner_,
          .beside = model,
          .calibrated = result_.calibrated.prediction,
          .located = located,
          .scales = scales_,
          .threads = options_.threads,
          .watch = options_.watch,
          .round = result_.next_round()};
}

/// Searches for a term of unknown law instead of the listed effects, where it may leave less: once, since it is beside the
/// calibrated model.
void UnlistedStage::look_instead() {
  if (!instead_ && signal_leaves_less()) {
    instead_ = search_unlisted(task_beside(result_.calibrated, located()));
    look_elsewhere();
    instead_->mark_tied_sites();
    instead_trials_ = result_.trials.size();
    result_.trials.insert(result_.trials.end(), instead_->trials.begin(), instead_->trials.end());
  }
}

/// True if a term of unknown law leaves clearly less than the listed effects do. Where these leave less than the noise, the
/// held-out error hardly falls, whatever is added: the evidence decides, and held-out data must agree.
bool UnlistedStage::is_better(const UnlistedSearch& found) const {
  const bool is_near_noise = excess_over_noise(data_, result_.explained) <= policy().visible;
  if (is_near_noise && result_.kept.empty() && found.best && is_supported(found.trials[*found.best])) {
    return true;
  }
  if (found.best && is_more_credible(data_, found.model, result_.explained)) {
    return true;
  }
  const bool is_same = found.best && is_curve_of_the_same(found.trials[*found.best].candidate, result_.kept);
  const double share = is_same ? policy().little_explained : advantage();
  return found.leaves_less_than(share * left_by_listed()) ||
         (found.has_evidence() && leaves_clearly_less(found.model, share));
}

/// A signal at a place may explain the records by its prior alone: what acts for moments only is at odds with that of its
/// own place. Where no law is found at the likely places, every place is searched whose signal leaves as little.
void UnlistedStage::look_elsewhere() {
  if (!located().is_single || is_better(*instead_) || !result_.kept.empty() || options_.watch.interrupted()) {
    return;
  }
  const Located open = located().opened();
  const Located rest = open.beyond(located());
  if (rest.likely_sites().empty()) {
    return;
  }
  instead_->add(search_unlisted(task_beside(result_.calibrated, rest)));
  if (!is_better(*instead_)) {
    located_ = open;
  }
}

/// A term of unknown law takes the place of the listed effects where it leaves clearly less on held-out data: listed effects
/// that imitate it would be wrong names.
void UnlistedStage::take_instead_if_better() {
  if (!instead_ || !is_better(*instead_)) {
    return;
  }
  if (const std::string harm = harm_of(data_, instead_->model.prediction, result_.calibrated.prediction); !harm.empty()) {
    result_.trials[instead_trials_ + *instead_->best].reason += "; " + words::refused(harm);
    return;
  }
  if (!result_.kept.empty()) {
    result_.trials[instead_trials_ + *instead_->best].reason += words::replaces_listed(left_by_listed());
  }
  result_.kept.clear();
  keep(*instead_, instead_trials_);
}

void UnlistedStage::keep(const UnlistedSearch& found, std::size_t first_trial) {
  rivals_.set_aside();
  Trial& best = result_.trials[first_trial + *found.best];
  best.decision = "kept";
  Kept kept{best, {}};
  for (std::size_t i = 0; i < found.trials.size(); ++i) {
    if (i != *found.best && found.trials[i].refined) {
      kept.alternatives.push_back(found.trials[i]);
    }
  }
  result_.kept.push_back(std::move(kept));
  result_.explained = found.model;
}

bool UnlistedStage::is_unlisted(const Kept& kept) const {
  return explain::is_unlisted(result_.explained.model.base, kept.trial.candidate);
}

bool UnlistedStage::has_unlisted() const {
  return std::ranges::any_of(result_.kept, [&](const Kept& kept) { return is_unlisted(kept); });
}

/// Index among the kept effects of the term of the grammar at whose site most of the rest may act: its law is not exact, and
/// a term at another site would imitate the rest of it. None where what was found explains less than half: that leaves
/// another effect, perhaps at the same site.
std::optional<std::size_t> UnlistedStage::term_of_rest(const Located& left) const {
  if (left_by_listed() > policy().little_explained) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < result_.kept.size(); ++i) {
    const Candidate& candidate = result_.kept[i].trial.candidate;
    if (is_unlisted(result_.kept[i]) && !candidate.choices.empty() && left.may_act_at(candidate.site)) {
      return i;
    }
  }
  return std::nullopt;
}

/// The sites of the terms of unknown law that were found: what one of them leaves refutes no other effect.
std::vector<std::string> UnlistedStage::sites_of_terms() const {
  std::vector<std::string> sites;
  for (const Kept& kept : result_.kept) {
    if (is_unlisted(kept)) {
      sites.push_back(kept.trial.candidate.site);
    }
  }
  return sites;
}

/// A round of listed effects beside a model.
RoundResult UnlistedStage::round_of(const std::vector<Candidate>& candidates, const Assessed& beside,
                                    const std::string& what) {
  if (candidates.empty()) {
    return {};
  }
  const Evaluator evaluator = refiner_.for_screening(beside.model);
  const Screening screening(evaluator, beside.model, scales_, options_.threads);
  Round round(result_.next_round(), data_, refiner_, beside, screening.run(candidates, what, options_.watch),
              options_.watch);
  RoundResult found = round.run();
  result_.trials.insert(result_.trials.end(), found.trials.begin(), found.trials.end());
  return found;
}

/// A listed effect beside what was found, where it leaves clearly less. Where most of the rest acts at the site of a term,
/// any listed effect may imitate the rest of that term: it has to leave only noise, or to explain clearly more together with
/// another law of the term: `term` is its index among the kept effects. Returns whether there is one.
bool UnlistedStage::add_listed_beside(const Located& left, std::optional<std::size_t> term) {
  std::vector<Candidate> candidates = candidates_beside(result_.explained.model.base, data_);
  std::erase_if(candidates, [&, sites = sites_of_terms()](const Candidate& c) { return left.refutes(c.site, sites); });
  const std::size_t first = result_.trials.size();
  RoundResult found = round_of(candidates, result_.explained, "beside a term");
  if (!found.kept) {
    return false;
  }
  const bool is_enough = term ? excess_over_noise(data_, found.model) < policy().immaterial
                              : leaves_clearly_less(found.model, policy().clearly_less);
  const std::string harm = harm_of(data_, found.model.prediction, result_.calibrated.prediction);
  if (!is_enough || !harm.empty()) {
    const bool is_revised = term && revise_term(*term, found, left);
    if (!is_revised) {
      refuse(std::span(result_.trials).subspan(first),
             !harm.empty() ? "; " + words::refused(harm)
                           : std::string(words::text(term ? words::Reason::rest_of_term : words::Reason::not_clearly_less)));
    }
    return is_revised;
  }
  rivals_.set_aside();
  result_.kept.push_back(std::move(*found.kept));
  result_.rival = std::move(found.rival);
  result_.explained = std::move(found.model);
  return true;
}

/// A term of unknown law beside a model that leaves clearly less than what was found. All that is tried is filed. `tables`:
/// as of a task.
std::optional<UnlistedSearch> UnlistedStage::better_term(const Assessed& beside, const Located& where, bool tables) {
  if (!beside.good() || options_.watch.interrupted()) {
    return std::nullopt;
  }
  UnlistedTask task = task_beside(beside, where);
  task.tables = tables;
  UnlistedSearch search = search_unlisted(task);
  search.mark_tied_sites();
  result_.trials.insert(result_.trials.end(), search.trials.begin(), search.trials.end());
  if (!search.has_evidence() || !leaves_clearly_less(search.model, policy().clearly_less) ||
      !harm_of(data_, search.model.prediction, result_.calibrated.prediction).empty()) {
    return std::nullopt;
  }
  return search;
}

/// The term whose rest is left is searched for once more beside the listed effect of a round: without that effect it had to
/// represent both. `term` is its index among the kept effects. Returns whether the two leave clearly less.
bool UnlistedStage::revise_term(std::size_t term, const RoundResult& listed, const Located& left) {
  if (options_.watch.interrupted()) {
    return false;
  }
  const Assessed rest = refiner_.without(listed.model.model, result_.kept[term].trial.candidate);
  const auto terms = std::ranges::count_if(result_.kept, [&](const Kept& kept) { return is_unlisted(kept); });
  const std::size_t first = result_.trials.size();
  const auto again = better_term(rest, left.only_best(), terms == 1);
  if (!again) {
    return false;
  }
  take_out(result_.kept[term].trial,
           words::is_revised(label(again->trials[*again->best].candidate), label(listed.kept->trial.candidate)));
  result_.kept[term] = *listed.kept;
  keep(*again, first);
  return true;
}

/// Files that an effect is taken out.
void UnlistedStage::take_out(Trial trial, std::string why) {
  trial.round = result_.trials.back().round;
  trial.decision = "taken out";
  trial.reason = std::move(why);
  result_.trials.push_back(std::move(trial));
}

UnlistedStage::Exhausted UnlistedStage::as_exhausted() const {
  Exhausted now{{}, excess_over_noise(data_, result_.explained)};
  std::ranges::transform(result_.kept, std::back_inserter(now.effects),
                         [](const Kept& kept) { return label(kept.trial.candidate); });
  return now;
}

/// True where rounds found nothing before beside the same effects: another fit of them leaves the same but for its scatter.
bool UnlistedStage::is_as_before(const std::optional<Exhausted>& before) const {
  const Exhausted now = as_exhausted();
  return before && before->effects == now.effects && std::abs(before->left - now.left) <= policy().scatter * now.left;
}

/// Terms of unknown law beside what was found, one after the other, as long as each leaves clearly less.
void UnlistedStage::add_beside(Names names) {
  while (is_hydraulic_axis(result_.explained.model.base) && !result_.kept.empty() &&
         static_cast<int>(result_.kept.size()) < options_.most_effects &&
         excess_over_noise(data_, result_.explained) > policy().immaterial && !options_.watch.interrupted()) {
    const Located& left = locate_explained();
    const std::optional<std::size_t> term = term_of_rest(left);
    const bool is_new = !is_as_before(exhausted_);
    if ((is_new && has_unlisted() && add_listed_beside(left, term)) || (names == Names::open && replace_misfit(left))) {
      continue;
    }
    const std::size_t first = result_.trials.size();
    const auto beside = term || !is_new ? std::nullopt : better_term(result_.explained, left, !has_unlisted());
    if (!beside) {
      exhausted_ = as_exhausted();
      return;
    }
    keep(*beside, first);
  }
}

}  // namespace hotfire::explain
