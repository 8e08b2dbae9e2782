// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/result/found_effects.hpp"

#include <map>
#include <string>
#include <string_view>

#include "tools/explain/result/curve.hpp"
#include "tools/explain/result/verdict.hpp"
#include "tools/explain/terms/unlisted.hpp"

namespace hotfire::explain {

namespace {

using Meanings = std::map<Address, std::string_view>;

/// Meanings of the fields of a plant's parameters.
Meanings meanings(const ModelParameters& plant) {
  Meanings result;
  visit_parameters(plant, [&](const model::Key& key, const auto& field, const double&) {
    result[{key, field.name}] = field.meaning;
  });
  return result;
}

/// A table's ordinate means what its table does.
std::string meaning_of(const Meanings& meanings, const Address& address) {
  return address.is_ordinate() ? "point " + std::to_string(address.point) + " of the table"
                               : std::string(meanings.at(address));
}

double percent_taken_off(double ratio) { return 100.0 * (1.0 - ratio); }

std::vector<EffectParameter> parameters_of(const Candidate& candidate, const Fitted& model,
                                           const std::vector<Estimate>& estimated, const Meanings& meaning) {
  std::vector<EffectParameter> parameters;
  for (std::size_t k = 0; k < estimated.size(); ++k) {
    const FreeParameter& free = model.free[k];
    if (free.is_of_effect(candidate.effect)) {
      parameters.push_back({free.address.name(), free.unit, meaning_of(meaning, free.address), estimated[k].value,
                            estimated[k].interval, estimated[k].from_profile});
    }
  }
  return parameters;
}

std::vector<Alternative> alternatives_of(const Kept& kept) {
  std::vector<Alternative> alternatives;
  for (const Trial& other : kept.alternatives) {
    if (other.refined && other.delta_criterion < 0.0) {
      alternatives.push_back({other.candidate.name, other.candidate.option_name,
                              other.delta_criterion - kept.trial.delta_criterion, percent_taken_off(other.held_out_ratio)});
    }
  }
  return alternatives;
}

/// A term of unknown law: what it looks like and what it is not.
void describe_unlisted(const ModelParameters& parameters, const SearchResult& found, const Kept& kept, FoundEffect& effect) {
  const Candidate& candidate = kept.trial.candidate;
  effect.name = "unlisted";
  effect.sites = sites_of(kept);
  effect.is_not = what_it_is_not(found);
  const auto found_table = table_of(parameters, candidate);
  if (!found_table) {
    effect.looks_like = law_in_words(candidate) + width_in_words(parameters, candidate);
    return;
  }
  const FittedTable table = with_own_axes(*found_table, candidate);
  effect.looks_like = in_words(table);
  // Beside an axis there is room for a few words.
  const std::string& y_label = candidate.choices.empty() ? table.meaning : table.y_name;
  effect.curve = Curve{{table.x_name, table.x_unit, y_label, table.y_unit}, {{"as found", table.x, table.y}}};
}

}  // namespace

std::vector<Estimate> estimates_of(const SearchResult& found) {
  const Fitted& model = found.explained.model;
  std::vector<Estimate> estimated = estimates(model.free, model.u, model.normal);
  for (std::size_t k = 0; k < estimated.size(); ++k) {
    if (const auto profile = found.profiles.find(model.free[k].address); profile != found.profiles.end()) {
      estimated[k].interval = profile->second;
      estimated[k].from_profile = true;
    }
  }
  return estimated;
}

std::vector<FoundEffect> found_effects(const Dataset& data, const SearchResult& found,
                                       const std::vector<Estimate>& estimated) {
  const Fitted& model = found.explained.model;
  const auto parameters = model.parameters();
  const Reach reach = reach_of(data, parameters);
  const auto meaning = meanings(model.base);
  std::vector<FoundEffect> effects;
  for (const Kept& kept : found.kept) {
    const Candidate& candidate = kept.trial.candidate;
    FoundEffect& effect = effects.emplace_back();
    effect.name = effect.key = candidate.name;
    effect.site = candidate.site;
    effect.law = candidate.option_name;
    effect.parameters = parameters_of(candidate, model, estimated, meaning);
    effect.held_out_drop = percent_taken_off(kept.trial.held_out_ratio);
    effect.delta_criterion = kept.trial.delta_criterion;
    effect.alternatives = alternatives_of(kept);
    if (is_unlisted(model.base, candidate)) {
      describe_unlisted(parameters, found, kept, effect);
    } else {
      effect.curve = curve_of(parameters, candidate.effect, reach);
    }
  }
  return effects;
}

}  // namespace hotfire::explain
