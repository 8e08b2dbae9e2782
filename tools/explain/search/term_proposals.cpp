// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/term_proposals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <span>

#include "tools/explain/latent/oscillation_search.hpp"
#include "tools/explain/policy/policy.hpp"
#include "tools/explain/refine/watch.hpp"
#include "tools/explain/terms/assessed.hpp"
#include "tools/explain/terms/visit_term.hpp"

namespace hotfire::explain {

namespace {

/// Rows over all records that forms are regressed on: of two minutes at 200 Hz.
constexpr double kMostRows = 25e3;
/// The same where no single signal explains the records: what else is missing is worse than noise, and several places are
/// open. Half of the rows take half of the time.
constexpr double kMostRowsOfOpen = 12.5e3;
/// Forms of one place that are proposed.
constexpr std::size_t kFormsOfPlace = 9;
/// How far a parameter of a memory may go from where the regression puts it, as a factor.
constexpr double kReach = 100.0;
/// Shares of a proposed term that are simulated, until less of it leaves more.
constexpr std::array kSharesOfTerm{1.0, 0.5, 0.25, 0.12, 0.06, 0.03};
/// Forms of a place that are tried at the others.
constexpr std::ptrdiff_t kExchanged = 2;

/// The effect of the model that is a term at the form's site.
std::optional<Candidate> candidate_of(const Form& form) {
  std::optional<Candidate> candidate;
  const SimplexParameters neutral;
  model::visit_effects(neutral, [&]<class E>(std::size_t index, const auto&) {
    if constexpr (requires { E::is_term; }) {
      if (E::site == form.site && E::sensor_channel == form.channel) {
        std::string site(model::site_name(E::site));
        if (form.channel >= 0) {
          site += "." + std::string(model::Simplex<double>::channels[static_cast<std::size_t>(form.channel)]);
        }
        candidate = Candidate{
            index,
            static_cast<int>(form.memory.kind),
            std::string(E::name),
            in_words(form),
            std::move(site),
            {static_cast<int>(form.argument), form.factor ? 1 + static_cast<int>(*form.factor) : 0,
             static_cast<int>(form.curve_first ? model::term::Order::curve_first : model::term::Order::curve_last)}};
      }
    }
  });
  return candidate;
}

/// Puts a form's values into the term's parameters, with a share of its coefficients.
void set_values(ModelParameters& parameters, const Candidate& candidate, const ScoredForm& scored, double share) {
  const Form& form = scored.form;
  const Eigen::VectorXd coefficients = share * scored.score.coefficients;
  visit_term(parameters, candidate, [&](auto& values) {
    values.time = form.memory.time;
    values.frequency = form.memory.frequency;
    values.damping = form.memory.damping;
    values.width = form.memory.width;
    values.phase = form.memory.phase;
    values.exponent = form.memory.exponent;
    values.gain = form.points.empty() ? coefficients(0) : 0.0;
    values.direct = form.has_direct() ? coefficients(coefficients.size() - 1) : 0.0;
    if (form.is_oscillator()) {
      values.gain = std::hypot(coefficients(0), coefficients(1));
      values.phase = std::atan2(coefficients(1), coefficients(0));
    } else if (!form.values.empty()) {
      // A play, a stop or a slew of a curve as many times as high is as many times as wide.
      values.width *= std::abs(coefficients(0));
    }
    values.table.points = static_cast<int>(form.points.size());
    for (std::size_t i = 0; i < form.points.size(); ++i) {
      values.table.x[i] = form.points[i];
      values.table.y[i] = form.is_oscillator()   ? form.values[i]
                          : !form.values.empty() ? coefficients(0) * form.values[i]
                                                 : coefficients(static_cast<Eigen::Index>(i));
    }
  });
}

std::vector<double> values_of(const ModelParameters& parameters) {
  std::vector<double> values;
  visit_values(parameters, [&](const double& value) { values.push_back(value); });
  return values;
}

/// The coordinates of a term that a fit moves, each about the value that it has in `parameters`.
std::vector<FreeParameter> free_parameters(const ModelParameters& parameters, const Candidate& candidate, const Form& form,
                                           const Scales& scales) {
  std::vector<FreeParameter> free = effect_parameters(parameters, candidate, scales);
  std::erase_if(free, [&](const FreeParameter& p) {
    const bool is_unused_gain = p.address.field == "gain" && !form.points.empty() && !form.is_oscillator();
    // The curve of an oscillator moves its frequency everywhere.
    const bool is_of_curve = p.address.field == "frequency" && form.is_oscillator() && !form.points.empty();
    // A sampling instant has no derivative.
    const bool is_sampling =
        form.memory.kind == model::Memory::hold && (p.address.field == "time" || p.address.field == "phase");
    // The width of a power only scales its gain, so it stays fixed.
    const bool is_unit = form.is_power() && p.address.field == "width";
    return is_unused_gain || is_of_curve || is_sampling || is_unit;
  });
  const std::vector<double> values = values_of(parameters);
  double largest = 0.0;
  for (const FreeParameter& p : free) {
    largest = p.is_ordinate() ? std::max(largest, std::abs(values[p.index])) : largest;
  }
  for (FreeParameter& p : free) {
    const double value = values[p.index];
    if (p.is_ordinate()) {
      p.unit_size = largest > 0.0 ? largest : p.unit_size;
    } else if (p.scale == FreeParameter::Scale::logarithmic) {
      p.unit_size = value;
      p.lower = std::max(p.lower, value / kReach);
      p.upper = std::min(p.upper, value * kReach);
      p.prior_center = std::log(value);
    } else if (value != 0.0 && p.address.field != "phase") {
      p.unit_size = std::abs(value);
    }
  }
  return free;
}

/// The forms of one place, with the regression that found them.
struct FormsOfPlace {
  LatentPlace where;
  std::unique_ptr<FormRegression> regression;
  std::vector<ScoredForm> forms;
};

/// The forms that explain what is left as if it acted at one place. Quantities as simulated come first. Where their forms
/// explain too little, those of smoothed quantities are searched too.
FormsOfPlace forms_of_place(const LatentProblem& problem, const Place& place, unsigned threads) {
  FormsOfPlace found{place.where, {}, {}};
  LatentInput input = input_of(problem, place.where, place.prior);
  smooth(problem, place.where, input);
  for (const auto arguments : {FormRegression::Arguments::simulated, FormRegression::Arguments::smoothed}) {
    found.regression = std::make_unique<FormRegression>(problem, place.where, input, arguments);
    double least = found.regression->left_without();
    for (ScoredForm& form : search_forms(*found.regression, place.where, kFormsOfPlace, threads)) {
      least = std::min(least, form.score.left);
      found.forms.push_back(std::move(form));
    }
    if (found.regression->is_explained_by(least)) {
      break;
    }
    // A motion looks like an oscillation that it tunes itself: only what no other form explains is one.
    if (arguments == FormRegression::Arguments::smoothed) {
      std::vector<Form> oscillations = find_oscillations(*found.regression, place.where, threads);
      std::vector<FormScore> scores = found.regression->score(oscillations, threads);
      for (std::size_t i = 0; i < oscillations.size(); ++i) {
        found.forms.push_back({std::move(oscillations[i]), std::move(scores[i])});
      }
    }
  }
  std::ranges::stable_sort(found.forms, {}, [](const ScoredForm& s) { return s.score.criterion; });
  return found;
}

/// Gives every place the best forms of the others.
void exchange_best(std::vector<FormsOfPlace>& places, unsigned threads) {
  std::vector<std::vector<ScoredForm>> moved(places.size());
  for (std::size_t to = 0; to < places.size(); ++to) {
    for (std::size_t from = 0; from < places.size(); ++from) {
      if (from != to && places[from].where.port && places[to].where.port) {
        const auto& forms = places[from].forms;
        const std::vector<ScoredForm> best(forms.begin(), forms.begin() + std::min(kExchanged, std::ssize(forms)));
        std::ranges::move(moved_forms(*places[to].regression, places[to].where, best, places[to].forms, threads),
                          std::back_inserter(moved[to]));
      }
    }
  }
  for (std::size_t to = 0; to < places.size(); ++to) {
    std::ranges::move(moved[to], std::back_inserter(places[to].forms));
  }
}

}  // namespace

std::optional<Screened> start_of(const Fitted& around, const ScoredForm& proposed, const Scales& scales, double share) {
  const std::optional<Candidate> candidate = candidate_of(proposed.form);
  if (!candidate || is_active(around.base, candidate->effect) || !proposed.score.coefficients.allFinite()) {
    return std::nullopt;
  }
  Screened start;
  start.candidate = *candidate;
  start.fitted = around;
  activate(start.fitted.base, *candidate);
  // The units of its coordinates are those of the whole term, however little of it the fit starts with.
  set_values(start.fitted.base, *candidate, proposed, 1.0);
  const std::vector<FreeParameter> free = free_parameters(start.fitted.base, *candidate, proposed.form, scales);
  set_values(start.fitted.base, *candidate, proposed, share);
  const std::vector<double> values = values_of(start.fitted.base);
  for (const FreeParameter& p : free) {
    start.fitted.u.push_back(p.coordinate(std::clamp(values[p.index], p.lower, p.upper)));
    start.fitted.free.push_back(p);
  }
  Eigen::Index moved = 0;
  for (const std::size_t k : moved_beside(around)) {
    const auto [low, high] = around.free[k].range();
    start.fitted.u[k] = std::clamp(start.fitted.u[k] + share * proposed.score.move(moved++), low, high);
  }
  start.criterion = proposed.score.criterion;
  start.good = true;
  start.replaces = proposed.form.replaces;
  return start;
}

std::optional<Screened> best_start(const Evaluator& evaluator, const Fitted& around, const ScoredForm& proposed,
                                   const Scales& scales, double without, unsigned threads) {
  const Stopwatch stopwatch;
  // At other instants than its own, a sampled signal leaves more than nothing does.
  const bool is_whole = proposed.form.replaces && proposed.form.memory.kind == model::Memory::hold;
  std::optional<Screened> best;
  for (const double share : std::span(kSharesOfTerm).first(is_whole ? 1 : kSharesOfTerm.size())) {
    auto start = start_of(around, proposed, scales, share);
    if (!start) {
      break;
    }
    start->criterion = left_by(evaluator, start->fitted, threads);
    if (is_whole || start->criterion < (best ? best->criterion : without)) {
      best = std::move(start);
    } else if (best) {
      break;
    }
  }
  if (best) {
    best->seconds = stopwatch.seconds();
  }
  return best;
}

std::optional<Screened> without_memory(const Fitted& fitted, const Candidate& term, const Scales& scales) {
  Screened plain;
  plain.candidate = term;
  plain.candidate.option = static_cast<int>(model::Memory::none);
  plain.fitted = fitted;
  plain.fitted.base = fitted.parameters();
  double gain = 0.0;
  visit_term(plain.fitted.base, term, [&](auto& values) {
    if (values.option == plain.candidate.option || values.direct == 0.0) {
      return;
    }
    Form form;
    form.argument = static_cast<model::Argument>(values.argument);
    form.factor = values.factor > 0 ? std::optional(static_cast<model::Argument>(values.factor - 1)) : std::nullopt;
    plain.candidate.option_name = in_words(form);
    gain = values.gain + values.direct;
    values.gain = gain;
    values.direct = 0.0;
    values.table.points = 0;
  });
  if (gain == 0.0) {
    return std::nullopt;
  }
  activate(plain.fitted.base, plain.candidate);
  drop_parameters(plain.fitted, [&](const FreeParameter& p) { return p.is_of_effect(term.effect); });
  for (FreeParameter& parameter : effect_parameters(plain.fitted.base, plain.candidate, scales)) {
    parameter.unit_size = std::abs(gain);
    plain.fitted.u.push_back(parameter.coordinate(gain));
    plain.fitted.free.push_back(std::move(parameter));
  }
  return plain;
}

std::vector<ScoredForm> propose_terms(const Dataset& data, const Fitted& around, const Located& located, unsigned threads,
                                      const Watch& watch) {
  const Dataset thin = thinned_to_rows(data, located.is_single ? kMostRows : kMostRowsOfOpen);
  const LatentProblem problem = latent_problem(data, thin, around, Resolution::coarse, threads);
  if (problem.flows.empty()) {
    return {};
  }
  std::vector<FormsOfPlace> places;
  for (const Place& place : located.places) {
    if (place.is_likely && !watch.interrupted()) {
      watch.progress({Work::unlisted, fmt::format("regressing what is left on terms at {}", place.sites.front())});
      places.push_back(forms_of_place(problem, place, threads));
    }
  }
  if (places.empty()) {
    return {};
  }
  const double without = places.front().regression->left_without();
  if (!watch.interrupted()) {
    exchange_best(places, threads);
    for (FormsOfPlace& place : places) {
      std::ranges::move(replacing(place.forms), std::back_inserter(place.forms));
    }
  }
  std::vector<ScoredForm> forms;
  for (FormsOfPlace& place : places) {
    std::ranges::move(place.forms, std::back_inserter(forms));
  }
  std::ranges::stable_sort(forms, {}, [](const ScoredForm& s) { return s.score.criterion; });
  const double least = forms.empty() ? without : forms.front().score.left;
  std::erase_if(forms, [&](const ScoredForm& form) {
    return without - form.score.left < policy().little_explained * (without - least);
  });
  return forms;
}

}  // namespace hotfire::explain
