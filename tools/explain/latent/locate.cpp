// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/locate.hpp"

#include <algorithm>
#include <utility>

#include "model/declaration/sites.hpp"
#include "tools/explain/data/measured_load.hpp"
#include "tools/explain/fit/parallel.hpp"

namespace hotfire::explain {

namespace {

/// Least gain of a signal in log likelihood: of 40 sets of records without any missing effect none gains 10.
constexpr double kLeastGain = 50.0;
/// Places are tied where their gains differ by less than this [log likelihood], or by this share of the best gain: a
/// signal's prior and the linear flow are wrong by as much.
constexpr double kTiedGain = 150.0;
constexpr double kTiedShare = 0.01;
/// ... and where what they leave is no more than this factor of what the best leaves, channel by channel.
constexpr double kTiedLeaves = 1.25;
/// Where no single signal explains the records, places of this share of the best gain stay open.
constexpr double kOpenShare = 0.1;
/// Rows at most: of ten minutes at the rate at which candidates are ranked, as much again for long records.
constexpr double kMostRows = 2e5;
/// Mean square over noise of what a signal leaves where it is not alone.
constexpr double kLeftBySingle = 1.9;

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

bool Located::allows(const std::string& site) const {
  return places.empty() || std::ranges::any_of(places, [&](const Place& place) {
           return place.is_likely && std::ranges::find(place.sites, site) != place.sites.end();
         });
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

Located locate(const Dataset& data, const Fitted<SimplexFamily>& around, unsigned threads) {
  double rows = 0.0;
  double seconds = 0.0;
  for (const Experiment& experiment : data.experiments) {
    rows += static_cast<double>(experiment.rows());
    seconds += static_cast<double>(experiment.rows()) * experiment.period;
  }
  const Dataset thin = rows > kMostRows ? thinned(data, seconds / kMostRows) : data;
  Located located;
  const LatentProblem problem = latent_problem(thin, around, threads);
  if (problem.flows.empty()) {
    return located;
  }
  const auto wanted = places_of(problem.data);
  const double without = likelihood_without(problem);
  std::vector<std::pair<Place, LatentInput>> tried(wanted.size());
  parallel_for(wanted.size(), threads, [&](std::size_t i) {
    tried[i].second = most_likely_input(problem, wanted[i].first);
    const LatentInput& input = tried[i].second;
    tried[i].first = {wanted[i].second, input.log_likelihood - without, {}, false, wanted[i].first, input.deviation,
                      input.move};
  });
  const double best = std::ranges::max(tried, {}, [](const auto& t) { return t.first.gain; }).first.gain;
  if (best < kLeastGain) {
    return located;
  }
  const auto close_to_best = [&](double share) {
    parallel_for(wanted.size(), threads, [&](std::size_t i) {
      auto& [place, input] = tried[i];
      if (place.gain >= best - std::max(kTiedGain, share * best) && place.leaves.empty()) {
        smooth(problem, wanted[i].first, input);
        place.leaves = input.leaves;
      }
    });
  };
  close_to_best(kTiedShare);
  const Place& first = std::ranges::max(tried, {}, [](const auto& t) { return t.first.gain; }).first;
  located.is_single = std::ranges::all_of(first.leaves, [](double leaves) { return leaves < kLeftBySingle; });
  if (!located.is_single) {
    close_to_best(kOpenShare);
  }
  for (auto& [place, input] : tried) {
    place.is_likely = !place.leaves.empty() &&
                      (!located.is_single || std::ranges::equal(place.leaves, first.leaves, [](double one, double least) {
                        return one <= kTiedLeaves * std::max(1.0, least);
                      }));
  }
  std::ranges::stable_sort(tried, std::ranges::greater{}, [](const auto& t) { return t.first.gain; });
  for (auto& [place, input] : tried) {
    located.places.push_back(std::move(place));
  }
  return located;
}

}  // namespace hotfire::explain
