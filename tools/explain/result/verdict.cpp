// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/result/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tools/explain/policy/policy.hpp"
#include "tools/explain/terms/table_points.hpp"
#include "tools/explain/terms/unlisted.hpp"
#include "tools/explain/words/conclusions.hpp"

namespace hotfire::explain {

namespace {

/// "gimbal friction (lugre) at engine_torque".
std::string phrase(const Candidate& candidate) {
  return fmt::format("{}{} at {}", words::spoken(candidate.name),
                     candidate.option_name.empty() ? "" : " (" + candidate.option_name + ")", candidate.site);
}

/// Which candidate was best when the search ended, in a sentence: by a joint fit if there was one.
std::string promising(const std::vector<Trial>& trials) {
  const auto best = std::min_element(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) {
    return a.refined == b.refined ? a.delta_criterion < b.delta_criterion : a.refined;
  });
  if (best == trials.end() || best->delta_criterion > -policy().strong_evidence) {
    return "";
  }
  return " " + (best->refined ? words::best_so_far(phrase(best->candidate), best->held_out_ratio)
                              : words::best_in_screening(phrase(best->candidate)));
}

/// The trial with the least held-out error of those fitted jointly that `is_meant`; null if there is none.
template <class F>
const Trial* closest_of(const std::vector<Trial>& trials, F&& is_meant) {
  const Trial* closest = nullptr;
  for (const Trial& trial : trials) {
    if (trial.refined && is_meant(trial) && (closest == nullptr || trial.held_out_ratio < closest->held_out_ratio)) {
      closest = &trial;
    }
  }
  return closest;
}

bool is_unlisted(const SearchResult& found, const Candidate& candidate) {
  return is_unlisted(found.explained.model.base, candidate);
}

/// The first term of unknown law that was kept; null if there is none.
const Kept* first_unlisted(const SearchResult& found) {
  const auto kept = std::ranges::find_if(found.kept, [&](const Kept& k) { return is_unlisted(found, k.trial.candidate); });
  return kept == found.kept.end() ? nullptr : &*kept;
}

/// "a term at SITE that depends on ...", "gimbal friction at engine_torque": everything that was kept.
std::vector<std::string> terms_in_words(const SearchResult& found) {
  std::vector<std::string> terms;
  for (const Kept& kept : found.kept) {
    const Candidate& candidate = kept.trial.candidate;
    terms.push_back(is_unlisted(found, candidate)
                        ? fmt::format("a term at {} {}", words::listed(sites_of(kept), "or"), dependence_in_words(candidate))
                        : phrase(candidate));
  }
  return terms;
}

/// Where what is missing acts, as far as the records say.
std::string place_in_words(const Located& located) {
  const std::vector<std::string> sites = located.likely_sites();
  return located.is_single ? words::one_place(words::listed(sites, "or")) : words::several_places(sites);
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  constexpr std::array<std::string_view, 5> kNames{"undecided", "unlisted-effect", "partly-explained", "explained",
                                                   "nothing-missing"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

bool is_fault_of_record(const Candidate& candidate) {
  return candidate.name == model::SensorScale::name || candidate.name == model::SensorDelay::name ||
         candidate.name == model::CommandScale::name;
}

bool is_of_record_time(const Candidate& candidate) {
  if (!candidate.choices.empty()) {
    constexpr auto kTime = static_cast<int>(model::Argument::time);
    return !is_oscillator(candidate) && (candidate.choices[0] == kTime || candidate.choices[1] == 1 + kTime);
  }
  return candidate.name.starts_with("unlisted_") &&
         (candidate.option_name == "time" || candidate.option_name.ends_with("_along_time") ||
          candidate.name == model::UnlistedDrift::name);
}

bool has_mean_over_time(const ModelParameters& parameters, const Candidate& candidate) {
  bool has = false;
  const bool is_product = !candidate.choices.empty() && candidate.choices[1] != 0;
  visit_table(parameters, candidate, [&]<class>(const auto&, const auto& table) { has = !is_product && table.points > 0; });
  return has;
}

Verdict verdict_of(const Dataset& data, const SearchResult& found) {
  if (first_unlisted(found) != nullptr) {
    return Verdict::unlisted_effect;
  }
  if (reaches_noise(data, found.explained)) {
    return found.kept.empty() ? Verdict::nothing_missing : Verdict::explained;
  }
  if (!found.kept.empty()) {
    return Verdict::partly_explained;
  }
  return found.interrupted || !found.searched ? Verdict::undecided : Verdict::unlisted_effect;
}

std::string sentence_of(Verdict verdict, const SearchResult& found, bool noise_is_known) {
  const words::HeldOutError error{Goodness::combined(found.declared.goodness.held_out),
                                  Goodness::combined(found.explained.goodness.held_out), noise_is_known};
  if (verdict == Verdict::nothing_missing && !is_within_tolerances(found.explained.model)) {
    const Moved farthest = farthest_from_declared(found.explained.model);
    return words::wrong_declaration(error.model, farthest.key, farthest.tolerances);
  }
  if (verdict == Verdict::nothing_missing) {
    return words::nothing_missing(error.model);
  }
  if (verdict == Verdict::unlisted_effect && !found.kept.empty()) {
    return words::unlisted_term(terms_in_words(found), error);
  }
  if (verdict == Verdict::unlisted_effect) {
    return words::unlisted_unexplained(error) + (found.located.places.empty() ? "" : " " + place_in_words(found.located));
  }
  if (verdict == Verdict::undecided) {
    return words::undecided(found.searched, error) + promising(found.trials);
  }
  std::vector<std::string> missing;
  std::vector<std::string> faults;
  for (const Kept& kept : found.kept) {
    (is_fault_of_record(kept.trial.candidate) ? faults : missing).push_back(phrase(kept.trial.candidate));
  }
  std::string text;
  if (!missing.empty()) {
    text += words::missing_effects(missing) + " ";
  }
  if (!faults.empty()) {
    text += words::faults_of_records(faults) + " ";
  }
  const words::Rest rest = verdict != Verdict::explained        ? words::Rest::unexplained
                           : found.explained.step_error.empty() ? words::Rest::of_sensors
                                                                : words::Rest::of_sensors_and_steps;
  return text + words::error_falls(found.kept.size() == 1, error, rest);
}

std::string what_it_is_not(const SearchResult& found) {
  const Trial& kept = first_unlisted(found)->trial;
  // Both in percent of what the calibrated model leaves: only the first round is judged against that as terms of unknown
  // law are.
  const Trial* listed = closest_of(found.trials, [&](const Trial& t) {
    return t.round == 1 && t.decision != "taken out" && !is_unlisted(found, t.candidate);
  });
  // Another term is judged against the same model in the same round.
  const Trial* other = closest_of(found.trials, [&](const Trial& t) {
    return t.round == kept.round && is_unlisted(found, t.candidate) && label(t.candidate) != label(kept.candidate);
  });
  std::string text = listed == nullptr
                         ? words::no_listed_finalist()
                         : words::is_not_listed(phrase(listed->candidate), listed->held_out_ratio, kept.held_out_ratio);
  if (other != nullptr) {
    text += " " + words::is_not_other(phrase(other->candidate), other->held_out_ratio);
  }
  return text;
}

}  // namespace hotfire::explain
