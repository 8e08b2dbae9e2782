// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/search/term_proposals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/explain/latent/form_search.hpp"
#include "tools/explain/latent/oscillation_search.hpp"
#include "tools/explain/policy/policy.hpp"

namespace hotfire::explain {

namespace {

/// Rows over all records that forms are regressed on: of two minutes at 200 Hz.
constexpr double kMostRows = 25e3;
/// Forms of one place that are proposed.
constexpr std::size_t kFormsOfPlace = 6;
/// How far a parameter of a memory may go from where the regression puts it, as a factor.
constexpr double kReach = 100.0;

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

/// Puts a form's values into the term's parameters.
void set_values(ModelParameters& parameters, const Candidate& candidate, const ScoredForm& scored) {
  const Form& form = scored.form;
  const Eigen::VectorXd& coefficients = scored.score.coefficients;
  visit_effects(parameters, [&]<class E>(std::size_t index, auto& values) {
    if constexpr (requires { E::is_term; }) {
      if (index != candidate.effect) {
        return;
      }
      values.time = form.memory.time;
      values.frequency = form.memory.frequency;
      values.damping = form.memory.damping;
      values.width = form.memory.width;
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
    }
  });
}

/// The coordinates of a term that a fit moves, each about the value that it has in `parameters`.
std::vector<FreeParameter> free_parameters(const ModelParameters& parameters, const Candidate& candidate, const Form& form,
                                           const Scales& scales) {
  std::vector<FreeParameter> free = effect_parameters(parameters, candidate, scales);
  std::erase_if(free, [&](const FreeParameter& p) {
    const bool is_unused_gain = p.address.field == "gain" && !form.points.empty() && !form.is_oscillator();
    // The curve of an oscillator moves its frequency everywhere.
    const bool is_of_curve = p.address.field == "frequency" && form.is_oscillator() && !form.points.empty();
    // A sampling period has no derivative.
    return is_unused_gain || is_of_curve || (form.memory.kind == model::Memory::hold && p.address.field == "time");
  });
  std::vector<double> values;
  visit_values(parameters, [&](const double& value) { values.push_back(value); });
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

std::optional<Screened> start_of(const Fitted& around, const ScoredForm& scored, const Scales& scales) {
  const std::optional<Candidate> candidate = candidate_of(scored.form);
  if (!candidate || is_active(around.base, candidate->effect) || !scored.score.coefficients.allFinite()) {
    return std::nullopt;
  }
  Screened start;
  start.candidate = *candidate;
  start.fitted = around;
  activate(start.fitted.base, *candidate);
  set_values(start.fitted.base, *candidate, scored);
  Eigen::Index declared = 0;
  for (std::size_t k = 0; k < around.free.size(); ++k) {
    if (around.free[k].is_declared()) {
      start.fitted.u[k] += scored.score.move(declared++);
    }
  }
  std::vector<double> values;
  visit_values(start.fitted.base, [&](const double& value) { values.push_back(value); });
  for (const FreeParameter& p : free_parameters(start.fitted.base, *candidate, scored.form, scales)) {
    start.fitted.u.push_back(p.coordinate(std::clamp(values[p.index], p.lower, p.upper)));
    start.fitted.free.push_back(p);
  }
  start.criterion = scored.score.criterion;
  start.good = true;
  return start;
}

}  // namespace

std::vector<Screened> propose_terms(const Dataset& data, const Fitted& around, const Located& located, const Scales& scales,
                                    unsigned threads, const Watch& watch) {
  const Dataset thin = thinned_to_rows(data, kMostRows);
  std::vector<Screened> proposals;
  const LatentProblem problem = latent_problem(thin, around, threads);
  if (problem.flows.empty()) {
    return proposals;
  }
  std::vector<ScoredForm> forms;
  double without = 0.0;
  for (const Place& place : located.places) {
    if (!place.is_likely || watch.interrupted()) {
      continue;
    }
    watch.progress({Work::unlisted, fmt::format("regressing what is left on terms at {}", place.sites.front())});
    LatentInput input;
    input.prior = place.prior;
    input.move = place.move;
    smooth(problem, place.where, input);
    for (const auto arguments : {FormRegression::Arguments::simulated, FormRegression::Arguments::smoothed}) {
      const FormRegression regression(problem, place.where, input, arguments);
      without = regression.left_without();
      double least = without;
      for (ScoredForm& form : search_forms(regression, place.where, kFormsOfPlace, threads)) {
        least = std::min(least, form.score.left);
        forms.push_back(std::move(form));
      }
      if (least < policy().left_by_single) {
        break;
      }
      // A motion looks like an oscillation that it tunes itself: only what no other form explains is one.
      if (arguments == FormRegression::Arguments::smoothed) {
        if (auto oscillation = find_oscillation(regression, place.where, threads)) {
          FormScore score = regression.score({&*oscillation, 1}, threads).front();
          forms.push_back({std::move(*oscillation), std::move(score)});
        }
      }
    }
  }
  std::ranges::stable_sort(forms, {}, [](const ScoredForm& s) { return s.score.criterion; });
  for (const ScoredForm& form : forms) {
    if (without - form.score.left < policy().little_explained * (without - forms.front().score.left)) {
      continue;
    }
    if (auto start = start_of(around, form, scales)) {
      proposals.push_back(std::move(*start));
    }
  }
  return proposals;
}

}  // namespace hotfire::explain
