// SPDX-License-Identifier: Apache-2.0
// Listed effects beside terms of unknown law: which are removed, which replace a term and which a term replaces.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "tools/explain/inference/veto.hpp"
#include "tools/explain/policy/policy.hpp"
#include "tools/explain/refine/finalists.hpp"
#include "tools/explain/refine/screening.hpp"
#include "tools/explain/search/unlisted_stage.hpp"
#include "tools/explain/words/conclusions.hpp"
#include "tools/explain/words/reasons.hpp"

namespace hotfire::explain {

namespace {

/// Names that together have to explain half of the error. The first of two effects of equal size explains 0.3 of it.
constexpr std::size_t kNames = 2;

}  // namespace

/// One term of unknown law takes the place of the listed effects where it leaves only noise. Returns whether it does.
bool UnlistedStage::take_instead_if_complete() {
  look_instead();
  if (!instead_ || !instead_->best || !is_complete(data_, instead_->model)) {
    return false;
  }
  take_instead_if_better();
  return is_complete(data_, result_.explained);
}

void UnlistedStage::replace_names_that_explain_little() {
  if (result_.kept.size() < kNames || left_by_listed() <= policy().little_explained || !is_worth_a_table() ||
      options_.watch.interrupted()) {
    return;
  }
  take_instead_if_complete();
}

bool UnlistedStage::replace_name_beside_single_signal() {
  if (!located().is_single) {
    return false;
  }
  return take_instead_if_complete();
}

void UnlistedStage::take_out_names(const std::string& why) {
  const int round = result_.next_round();
  for (const Kept& kept : result_.kept) {
    Trial trial{round, kept.trial.candidate, true, 0.0, 1.0, 0.0, "taken out", why};
    compare(trial, result_.calibrated, result_.explained, result_.calibrated.goodness.fitted);
    result_.trials.push_back(std::move(trial));
  }
  result_.kept.clear();
  result_.rival.reset();
  result_.explained = result_.calibrated;
}

/// One signal at a likely place explains all that is missing: names elsewhere imitate it.
void UnlistedStage::refuse_misplaced_names() {
  const bool misplaced = std::ranges::any_of(
      result_.kept, [&](const Kept& kept) { return located().is_single && !located().allows(kept.trial.candidate.site); });
  if (misplaced) {
    take_out_names(words::explained_by_signal(words::listed(located().likely_sites(), "or")));
  }
}

/// A listed effect in the place of a term of unknown law at its site, where it leaves as little: a law costs less than a
/// curve that does the same. A term alone was compared with the listed effects before. Of several, each was in the way of
/// the others' laws.
void UnlistedStage::name_terms() {
  if (is_as_before(unnamed_)) {
    return;
  }
  for (std::size_t i = 0; result_.kept.size() > 1 && i < result_.kept.size() && !options_.watch.interrupted(); ++i) {
    const Candidate term = result_.kept[i].trial.candidate;
    if (!is_unlisted(result_.kept[i])) {
      continue;
    }
    std::vector<Candidate> laws = candidates_beside(result_.explained.model.base, data_);
    std::erase_if(laws, [&](const Candidate& c) { return c.site != term.site; });
    if (laws.empty()) {
      continue;
    }
    const Assessed rest = refiner_.without(result_.explained.model, term);
    if (!rest.good()) {
      continue;
    }
    const std::size_t first = result_.trials.size();
    RoundResult found = round_of(laws, rest, fmt::format("a law in place of {}", label(term)));
    if (found.kept && leaves_as_little(found.model)) {
      take_out(result_.kept[i].trial, words::has_a_law(label(found.kept->trial.candidate)));
      result_.kept[i] = std::move(*found.kept);
      rivals_.set_aside();
      result_.rival = std::move(found.rival);
      Assessed settled = refiner_.settled(found.model.model);
      result_.explained = settled.good() ? std::move(settled) : std::move(found.model);
    } else {
      refuse(std::span(result_.trials).subspan(first), words::text(words::Reason::leaves_more));
    }
  }
  unnamed_ = as_exhausted();
}

/// A term of unknown law in the place of a listed effect where what is left acts at the effect's own site: its law imitates
/// another. The term has to leave clearly less. Returns whether there is one.
bool UnlistedStage::replace_misfit(const Located& left) {
  for (std::size_t i = 0; !left.places.empty() && i < result_.kept.size() && !options_.watch.interrupted(); ++i) {
    const Candidate name = result_.kept[i].trial.candidate;
    if (is_unlisted(result_.kept[i]) || !left.places.front().has(name.site)) {
      continue;
    }
    const Assessed rest = refiner_.without(result_.explained.model, name);
    const std::size_t first = result_.trials.size();
    if (const auto term = better_term(rest, left.only_best(), !has_unlisted())) {
      take_out(result_.kept[i].trial, words::imitates(label(term->trials[*term->best].candidate)));
      result_.kept.erase(result_.kept.begin() + static_cast<std::ptrdiff_t>(i));
      keep(*term, first);
      return true;
    }
  }
  return false;
}

bool UnlistedStage::wants_another_start() const {
  return is_worth_a_table() && is_hydraulic_axis(result_.explained.model.base) &&
         excess_over_noise(data_, result_.explained) > policy().visible && !options_.watch.interrupted();
}

/// The other hypothesis where names were given up: the same names with terms of unknown law beside them. A signal without a
/// law explains what a name does as well, and a law may need the name.
void UnlistedStage::return_to_names_if_better(const Found& names) {
  const auto is_kept = [&](const Kept& name) {
    return std::ranges::any_of(result_.kept,
                               [&](const Kept& kept) { return label(kept.trial.candidate) == label(name.trial.candidate); });
  };
  if (std::ranges::all_of(names.kept, is_kept) || !wants_another_start()) {
    return;
  }
  Found before = found();
  restore(names);
  add_beside(Names::given);
  name_terms();
  Found other = found();
  restore(std::move(before));
  if (other.kept.size() > names.kept.size()) {
    take_if_better(std::move(other));
  }
  file_hypothesis();
}

bool UnlistedStage::is_clearly_better(const Assessed& model, const Assessed& than) const {
  return excess_over_noise(data_, model) < policy().clearly_less * excess_over_noise(data_, than) &&
         held_out_rows_agree(model, than);
}

/// Keeps another hypothesis where it is clearly better than what was found.
void UnlistedStage::take_if_better(Found other) {
  if (is_clearly_better(other.explained, result_.explained)) {
    restore(std::move(other));
  }
}

double UnlistedStage::share_of_signal() { return located().is_single ? policy().clearly_less : 1.0 - policy().open_share; }

void UnlistedStage::start_from(const Screened& name) {
  Assessed fitted = refiner_.of_screened(name.fitted, result_.calibrated.model.u);
  if (!fitted.good()) {
    return;
  }
  Trial trial{result_.next_round(), name.candidate, true, 0.0, 1.0, name.seconds, "kept", ""};
  compare(trial, fitted, result_.calibrated, fitted.goodness.fitted);
  trial.reason = words::text(words::Reason::saves_signal);
  result_.trials.push_back(trial);
  restore({{Kept{std::move(trial), {}}}, std::move(fitted), std::nullopt, {}});
}

bool UnlistedStage::add_terms_to_names() {
  add_beside(Names::given);
  name_terms();
  drop_light_names();
  return is_complete(data_, result_.explained);
}

void UnlistedStage::give_up_terms(Found before) {
  if (has_unlisted()) {
    of_names_ = found();
  }
  restore(std::move(before));
}

void UnlistedStage::file_hypothesis() {
  const int round = result_.trials.back().round;
  const auto last_of = [&](const std::string& name) {
    const auto is_decided = [&](const Trial& trial) {
      return label(trial.candidate) == name && (trial.decision == "kept" || trial.decision == "taken out");
    };
    return std::find_if(result_.trials.rbegin(), result_.trials.rend(), is_decided);
  };
  for (Trial& trial : result_.trials) {
    const std::string name = label(trial.candidate);
    const bool is_kept =
        std::ranges::any_of(result_.kept, [&](const Kept& kept) { return label(kept.trial.candidate) == name; });
    if (trial.decision == "kept" && !is_kept && &*last_of(name) == &trial) {
      trial.decision = "dropped";
      trial.reason += words::text(words::Reason::other_hypothesis);
    }
  }
  for (const Kept& kept : result_.kept) {
    const auto last = last_of(label(kept.trial.candidate));
    if (last != result_.trials.rend() && last->decision == "taken out") {
      Trial again = kept.trial;
      again.round = round;
      result_.trials.push_back(std::move(again));
    }
  }
}

/// A name beside a term of unknown law is the term's if no channel has clearly more left without the name. The term may be
/// far from right in another channel.
void UnlistedStage::drop_light_names() {
  if (!has_unlisted()) {
    return;
  }
  for (std::size_t i = result_.kept.size(); i-- > 0;) {
    if (is_unlisted(result_.kept[i]) || options_.watch.interrupted()) {
      continue;
    }
    Trial trial{result_.next_round(),
                result_.kept[i].trial.candidate,
                true,
                0.0,
                1.0,
                0.0,
                "taken out",
                std::string(words::text(words::Reason::beside_unlisted))};
    Assessed rest = refiner_.without(result_.explained.model, trial.candidate);
    if (!rest.good()) {
      continue;
    }
    compare(trial, rest, result_.explained, rest.goodness.fitted);
    if (!leaves_clearly_more(rest, result_.explained)) {
      result_.trials.push_back(std::move(trial));
      result_.kept.erase(result_.kept.begin() + static_cast<std::ptrdiff_t>(i));
      Assessed settled = refiner_.settled(rest.model);
      result_.explained = settled.good() ? std::move(settled) : std::move(rest);
    }
  }
}

/// Names that leave most of the error, and far more than noise, are not what is missing: saying less is no error.
void UnlistedStage::drop_names_that_explain_little() {
  const bool names_alone = !result_.kept.empty() && !has_unlisted();
  if (names_alone && left_by_listed() > policy().little_explained &&
      excess_over_noise(data_, result_.explained) > policy().near_noise) {
    take_out_names(words::leaves_far_above_noise(left_by_listed()));
  }
}

}  // namespace hotfire::explain
