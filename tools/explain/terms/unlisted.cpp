// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/unlisted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/explain/policy/policy.hpp"
#include "tools/explain/terms/table_points.hpp"
#include "tools/explain/terms/visit_term.hpp"

namespace hotfire::explain {

namespace {

template <class E>
constexpr bool is_unlisted_effect() {
  return requires { E::is_unlisted; };
}

/// True for a term of the grammar over the rate of the motion that it is against.
bool is_over_own_rate(const Candidate& candidate) {
  if (candidate.choices.empty()) {
    return false;
  }
  const bool is_of_piston = candidate.site == model::site_name(model::Site::piston);
  const bool is_of_engine = candidate.site == model::site_name(model::Site::engine_torque);
  const auto rate = is_of_piston ? model::Argument::rate : model::Argument::angle_rate;
  return (is_of_piston || is_of_engine) && candidate.choices[0] == static_cast<int>(rate) && candidate.choices[1] == 0;
}

bool is_curve_over_own_rate(const Candidate& candidate) {
  return is_over_own_rate(candidate) && candidate.option == static_cast<int>(model::Memory::none);
}

/// What a force against a motion takes out of it, and what it feeds in.
struct Work {
  double in = 0.0;
  double out = 0.0;
  void add(double power) { (power < 0.0 ? in : out) += std::abs(power); }
  /// True beyond the scatter of an estimate.
  bool feeds() const { return in > policy().scatter * out; }
};

/// True for a power of its own rate that pushes with the motion, at the rates of the records or beyond: it goes on there.
bool power_feeds_energy(const ModelParameters& parameters, const Candidate& candidate) {
  bool feeds = false;
  visit_term(parameters, candidate, [&](const auto& values) {
    for (const double most : {1.0, model::kPowerLimit}) {
      Work work;
      for (int i = -10; i <= 10; ++i) {
        const double rate = 0.1 * i * most * values.width;
        model::MemoryState<double> state;
        work.add((values.gain * state.step(values.memory(), rate, 1.0) + values.direct * rate) * rate);
      }
      feeds = feeds || work.feeds();
    }
  });
  return feeds;
}

}  // namespace

bool is_power(const Candidate& candidate) {
  return !candidate.choices.empty() && model::is_power(static_cast<model::Memory>(candidate.option));
}

bool is_oscillator(const Candidate& candidate) {
  return !candidate.choices.empty() && candidate.option == static_cast<int>(model::Memory::oscillator);
}

bool forgets_constants(const Candidate& candidate) {
  const auto kind = static_cast<model::Memory>(candidate.option);
  return !candidate.choices.empty() && candidate.choices[2] == static_cast<int>(model::term::Order::curve_first) &&
         (kind == model::Memory::washout || kind == model::Memory::band_pass);
}

bool is_unlisted(const ModelParameters& plant, const Candidate& candidate) {
  bool result = false;
  visit_effects(plant, [&]<class E>(std::size_t index, const auto&) {
    result = result || (index == candidate.effect && is_unlisted_effect<E>());
  });
  return result;
}

std::vector<Candidate> unlisted_candidates(const ModelParameters& plant, const Dataset& data) {
  std::vector<Candidate> candidates;
  visit_effects(plant, [&]<class E>(std::size_t index, const auto&) {
    if constexpr (is_unlisted_effect<E>() && !requires { E::is_term; }) {
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

void activate_unlisted(ModelParameters& parameters, const Candidate& candidate, const Dataset& data, const Fitted& current) {
  activate(parameters, candidate);
  lay_table(parameters, candidate, data, current);
}

std::optional<FittedTable> table_of(const ModelParameters& parameters, const Candidate& candidate) {
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

bool feeds_energy(const ModelParameters& parameters, const Candidate& candidate) {
  if (is_power(candidate) && is_over_own_rate(candidate)) {
    return power_feeds_energy(parameters, candidate);
  }
  const auto table = table_of(parameters, candidate);
  if (!table || table->x.empty()) {
    return false;
  }
  const bool over_rate = table->x_name == "rate" || is_curve_over_own_rate(candidate);
  if (!over_rate && table->x_name.find("of_damping") == std::string::npos) {
    return false;
  }
  const auto closest = std::ranges::min_element(table->x, {}, [](double x) { return std::abs(x); });
  const double at_rest = over_rate ? table->y[static_cast<std::size_t>(closest - table->x.begin())] : 0.0;
  Work work;
  for (std::size_t i = 0; i < table->x.size(); ++i) {
    work.add((table->y[i] - at_rest) * (over_rate ? table->x[i] : 1.0));
  }
  return work.feeds();
}

}  // namespace hotfire::explain
