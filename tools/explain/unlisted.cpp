#include "tools/explain/unlisted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tools/explain/table_points.hpp"

namespace hotfire::explain {

namespace {

constexpr int kPhases = 6;

template <class E>
constexpr bool is_unlisted_effect() {
  return requires { E::is_unlisted; };
}

/// Squared residuals of every record at a point; infinite where it can't be simulated.
template <class Family>
std::vector<double> cost_by_record(const Evaluator<Family>& evaluator, const Fitted<Family>& model,
                                   const std::vector<double>& u) {
  const std::size_t records = evaluator.data().experiments.size();
  Prediction prediction;
  if (!evaluator.predict(model.base, model.free, u, 1, prediction)) {
    return std::vector<double>(records, std::numeric_limits<double>::infinity());
  }
  std::vector<double> cost(records, 0.0);
  const Eigen::VectorXd residual = evaluator.residuals(prediction);
  for (const Stretch& s : evaluator.stretches()) {
    cost[s.experiment] +=
        residual.segment(static_cast<Eigen::Index>(s.offset), static_cast<Eigen::Index>(s.last - s.first)).squaredNorm();
  }
  return cost;
}

/// A sinusoid's own coordinates at a frequency and a factor of its typical amplitude, each record's clock at the best of the
/// phases tried. Records do not depend on each other's clock: one simulation tries a phase on all of them.
template <class Family>
std::vector<double> at_best_phases(const Evaluator<Family>& evaluator, const Fitted<Family>& model, std::size_t own_first,
                                   double frequency, double factor) {
  const std::span<const FreeParameter> own = std::span(model.free).subspan(own_first);
  const std::size_t records = evaluator.data().experiments.size();
  std::vector<double> best(records, 0.0);
  std::vector<double> least(records, std::numeric_limits<double>::infinity());
  const auto point_at = [&](auto&& clock) {
    std::vector<double> point;
    for (const FreeParameter& parameter : own) {
      const double amplitude = factor * parameter.unit_size;
      const double value = parameter.is_initial_state() ? clock(static_cast<std::size_t>(parameter.experiment))
                           : parameter.unit == "Hz"     ? frequency
                                                        : amplitude;
      point.push_back(parameter.coordinate(value));
    }
    return point;
  };
  for (int phase = 0; phase < kPhases; ++phase) {
    const double clock = static_cast<double>(phase) / (kPhases * frequency);
    const std::vector<double> point = point_at([&](std::size_t) { return clock; });
    std::vector<double> u(model.u.begin(), model.u.begin() + static_cast<std::ptrdiff_t>(own_first));
    u.insert(u.end(), point.begin(), point.end());
    const std::vector<double> cost = cost_by_record(evaluator, model, u);
    for (std::size_t e = 0; e < records; ++e) {
      if (cost[e] < least[e]) {
        least[e] = cost[e];
        best[e] = clock;
      }
    }
  }
  return point_at([&](std::size_t e) { return best[e]; });
}

}  // namespace

template <class Family>
bool is_unlisted(const Candidate& candidate) {
  bool result = false;
  const PlainParameters<Family> neutral;
  model::visit_effects(neutral, [&]<class E>(std::size_t index, const auto&) {
    result = result || (index == candidate.effect && is_unlisted_effect<E>());
  });
  return result;
}

bool is_periodic(const Candidate& candidate) {
  return candidate.option_name == "periodic" || candidate.name == model::UnlistedRipple::name;
}

template <class Family>
std::vector<Candidate> unlisted_candidates(const Dataset& data) {
  std::vector<Candidate> candidates;
  const PlainParameters<Family> neutral;
  model::visit_effects(neutral, [&]<class E>(std::size_t index, const auto&) {
    if constexpr (is_unlisted_effect<E>()) {
      for (std::size_t option = 0; option < E::options.size(); ++option) {
        if (model::needs_other_axis<E>(static_cast<int>(option)) && !data.has_other_axis()) {
          continue;
        }
        Candidate candidate{index, static_cast<int>(option), std::string(E::name), std::string(E::options[option]),
                            std::string(model::site_name(E::site))};
        if constexpr (E::site == model::Site::sensor) {
          if (!data.used[option]) {
            continue;
          }
          candidate.site = fmt::format("{}.{}", candidate.site, candidate.option_name);
        }
        candidates.push_back(std::move(candidate));
      }
    }
  });
  return candidates;
}

template <class Family>
void activate_unlisted(PlainParameters<Family>& parameters, const Candidate& candidate, const Dataset& data,
                       const Fitted<Family>& current) {
  activate<Family>(parameters, candidate);
  lay_table(parameters, candidate, data, current);
}

template <class Family>
std::optional<FittedTable> table_of(const PlainParameters<Family>& parameters, const Candidate& candidate) {
  std::optional<FittedTable> result;
  visit_table(parameters, candidate, [&]<class>(const auto& field, const auto& table) {
    if (table.points > 0) {
      result = FittedTable{std::string(field.x_name),
                           std::string(field.x_unit),
                           std::string(field.y_name),
                           std::string(field.y_unit),
                           std::string(field.meaning),
                           {table.x.begin(), table.x.begin() + table.points},
                           {table.y.begin(), table.y.begin() + table.points}};
    }
  });
  return result;
}

std::vector<FreeParameter> clocks(const Dataset& data) {
  std::vector<FreeParameter> free;
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    FreeParameter parameter;
    parameter.key = fmt::format("{}.clock", data.experiments[e].name);
    parameter.unit = std::string("s");
    parameter.experiment = static_cast<int>(e);
    parameter.state = 2;
    parameter.lower = -1e9;
    parameter.upper = 1e9;
    free.push_back(std::move(parameter));
  }
  return free;
}

template <class Family>
std::vector<std::vector<double>> periodic_starts(const Evaluator<Family>& evaluator, const Fitted<Family>& with_candidate,
                                                 std::size_t own_first, const std::vector<double>& frequencies) {
  std::vector<std::vector<double>> starts;
  for (const double frequency : frequencies) {
    for (const double factor : {0.3, 1.0, 3.0}) {
      starts.push_back(at_best_phases(evaluator, with_candidate, own_first, frequency, factor));
    }
  }
  return starts;
}

#define HOTFIRE_INSTANTIATE(Family)                                                                                  \
  template bool is_unlisted<Family>(const Candidate&);                                                               \
  template std::optional<FittedTable> table_of<Family>(const PlainParameters<Family>&, const Candidate&);            \
  template std::vector<Candidate> unlisted_candidates<Family>(const Dataset&);                                       \
  template void activate_unlisted<Family>(PlainParameters<Family>&, const Candidate&, const Dataset&,                \
                                          const Fitted<Family>&);                                                    \
  template std::vector<std::vector<double>> periodic_starts<Family>(const Evaluator<Family>&, const Fitted<Family>&, \
                                                                    std::size_t, const std::vector<double>&);

HOTFIRE_INSTANTIATE(SimplexFamily)
HOTFIRE_INSTANTIATE(DirectFamily)
#undef HOTFIRE_INSTANTIATE

}  // namespace hotfire::explain
