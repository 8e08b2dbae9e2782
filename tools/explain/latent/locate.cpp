// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/locate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/declaration/sites.hpp"
#include "tools/explain/data/measured_load.hpp"
#include "tools/explain/fit/parallel.hpp"
#include "tools/explain/policy/policy.hpp"

namespace hotfire::explain {

namespace {

/// Rows at most: of two minutes at 250 Hz. Gains are a thousand times what decides between places.
constexpr double kMostRows = 3.2e4;
/// Rows at most where models are compared by what a signal beside them costs: that is thousands.
constexpr double kMostRowsCompared = 4e3;

std::string site(model::Site at) { return std::string(model::site_name(at)); }

std::vector<std::pair<LatentPlace, std::vector<std::string>>> places_of(const Dataset& data) {
  using enum model::Site;
  std::vector<std::pair<LatentPlace, std::vector<std::string>>> places{
      {{Port::torque_motor, 0}, {site(command), site(valve_command)}},
      {{Port::oil, 0}, {site(valve), site(flow), site(pressure)}},
      {{Port::piston, 0}, {site(piston)}},
      {{Port::spring, 0}, {site(load_spring), site(structure)}}};
  if (!is_measured_load(data, site(engine_torque))) {
    places.push_back({{Port::engine, 0}, {site(engine_torque)}});
  }
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    if (data.used[c]) {
      places.push_back({{std::nullopt, c}, {site(sensor) + "." + data.channels[c]}});
    }
  }
  return places;
}

}  // namespace

bool Place::has(const std::string& site) const { return std::ranges::find(sites, site) != sites.end(); }

bool Located::allows(const std::string& site) const {
  return places.empty() ||
         std::ranges::any_of(places, [&](const Place& place) { return place.is_likely && place.has(site); });
}

bool Located::refutes(const std::string& site, const std::vector<std::string>& found) const {
  const bool may_be_rest_of_a_law = std::ranges::any_of(found, [&](const std::string& own) { return allows(own); });
  return is_single && !may_be_rest_of_a_law &&
         std::ranges::none_of(places, [&](const Place& place) { return place.is_possible && place.has(site); });
}

bool Located::may_act_at(const std::string& site) const {
  return !places.empty() && (places.front().has(site) || (is_single && allows(site)));
}

std::vector<std::string> Located::likely_sites() const {
  std::vector<std::string> sites;
  for (const Place& place : places) {
    if (place.is_likely) {
      sites.insert(sites.end(), place.sites.begin(), place.sites.end());
    }
  }
  return sites;
}

Located Located::opened() const {
  Located open = *this;
  for (Place& place : open.places) {
    place.is_likely = place.is_possible;
  }
  return open;
}

Located Located::only_best() const {
  Located best = *this;
  for (std::size_t i = 0; i < best.places.size(); ++i) {
    best.places[i].is_likely = i == 0;
  }
  return best;
}

Located Located::beyond(const Located& other) const {
  Located rest = *this;
  for (std::size_t i = 0; i < rest.places.size(); ++i) {
    rest.places[i].is_likely = places[i].is_likely && !other.places[i].is_likely;
  }
  return rest;
}

Located locate(const Dataset& data, const Fitted& around, unsigned threads) {
  const Dataset thin = thinned_to_rows(data, kMostRows);
  Located located;
  const LatentProblem problem = latent_problem(data, thin, around, Resolution::coarse, threads);
  if (problem.flows.empty()) {
    return located;
  }
  const auto wanted = places_of(problem.data);
  const double without = likelihood_without(problem);
  std::vector<std::pair<Place, LatentInput>> tried(wanted.size());
  parallel_for(wanted.size(), threads, [&](std::size_t i) {
    tried[i].second = most_likely_input(problem, wanted[i].first);
    const LatentInput& input = tried[i].second;
    Place& place = tried[i].first;
    place.sites = wanted[i].second;
    place.gain = input.log_likelihood - without;
    place.where = wanted[i].first;
    place.prior = input.prior;
  });
  const double best = std::ranges::max(tried, {}, [](const auto& t) { return t.first.gain; }).first.gain;
  if (best < policy().least_gain) {
    return located;
  }
  const auto close_to_best = [&](double share) {
    parallel_for(wanted.size(), threads, [&](std::size_t i) {
      auto& [place, input] = tried[i];
      if (place.gain >= best - std::max(policy().tied_gain, share * best) && place.leaves.empty()) {
        smooth(problem, wanted[i].first, input);
        place.leaves = input.leaves;
      }
    });
  };
  close_to_best(policy().scatter);
  // The likelihood compares places by how well their prior fits as well. A place that leaves clearly more than another one
  // close to it owes its gain to that.
  const auto most_left = [](const auto& t) { return t.first.leaves.empty() ? HUGE_VAL : std::ranges::max(t.first.leaves); };
  const auto& first = std::ranges::max(tried, {}, [](const auto& t) { return t.first.gain; });
  const auto& least = std::ranges::min(tried, {}, most_left);
  const Place& chosen = (most_left(first) <= policy().tied_leaves * std::max(1.0, most_left(least)) ? first : least).first;
  const std::vector<double> leaves = chosen.leaves;
  const double tied_from = chosen.gain - std::max(policy().tied_gain, policy().tied_share * chosen.gain);
  located.is_single = std::ranges::all_of(leaves, [](double left) { return left < policy().left_by_single; });
  close_to_best(located.is_single ? 1.0 : policy().open_share);
  for (auto& [place, input] : tried) {
    place.is_possible = !place.leaves.empty() &&
                        (!located.is_single || std::ranges::equal(place.leaves, leaves, [](double one, double other) {
                          return one <= policy().tied_leaves * std::max(1.0, other);
                        }));
    place.is_likely = place.is_possible && (!located.is_single || place.gain >= tied_from);
  }
  std::ranges::stable_sort(tried, std::ranges::greater{},
                           [](const auto& t) { return std::pair(t.first.is_likely, t.first.gain); });
  for (auto& [place, input] : tried) {
    located.places.push_back(std::move(place));
  }
  return located;
}

SignalCost cost_of_signal(const Dataset& data, const Fitted& around, const std::vector<LatentPrior>& near,
                          unsigned threads) {
  const Dataset thin = thinned_to_rows(data, kMostRowsCompared);
  const LatentProblem problem = latent_problem(data, thin, around, Resolution::rough, threads);
  SignalCost signal;
  if (problem.flows.empty()) {
    return signal;
  }
  double values = 0.0;
  for (const Eigen::MatrixXd& left : problem.left) {
    values += static_cast<double>(left.array().isFinite().count());
  }
  const auto places = places_of(problem.data);
  std::vector<LatentInput> inputs(places.size());
  parallel_for(places.size(), threads, [&](std::size_t i) {
    inputs[i] =
        near.empty() ? most_likely_input(problem, places[i].first) : input_downhill(problem, places[i].first, near[i]);
  });
  const auto best = std::ranges::max_element(inputs, {}, &LatentInput::log_likelihood);
  if (!near.empty()) {
    refine(problem, places[static_cast<std::size_t>(best - inputs.begin())].first, *best);
  }
  signal.cost = -0.5 * values * (1.0 + std::log(2.0 * std::numbers::pi)) - best->log_likelihood;
  for (const LatentInput& input : inputs) {
    signal.priors.push_back(input.prior);
  }
  return signal;
}

}  // namespace hotfire::explain
