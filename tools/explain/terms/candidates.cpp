// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/terms/candidates.hpp"
#include "tools/explain/data/measured_load.hpp"

#include <algorithm>
#include <cmath>

namespace hotfire::explain {

namespace {

/// Least share of its declared value that a declared parameter may be moved to.
constexpr double kLeastOfDeclared = 1e-6;

/// Largest factor by which a start lies above or below a field's typical value.
constexpr double kStartSpan = 4.0;
/// ... and of the two further starts for a small effect.
constexpr double kWhisper = 16.0;
/// Starts of a law of one parameter, from one whisper to the other: a limit has no derivative above what it limits and
/// overshoots far below, and the valley between is narrower than a factor of two.
constexpr std::size_t kStartsOfOne = 12;

/// Standard deviation of the logarithm of an effect's parameter about its typical value before any data: a factor of ten.
/// Worth less than one effective sample; it keeps a parameter that the data do not determine from wandering off to a bound.
constexpr double kWeakPrior = 2.302585;

/// Standard deviation of a table's ordinate about zero before any data, in typical sizes: keeps a point that the records
/// never reach where its neighbours leave it.
constexpr double kOrdinatePrior = 100.0;

/// Calls `f(index, effect's values)` for one effect of the list.
template <IsModelParameters Parameters, class F>
void visit_effect(Parameters& parameters, std::size_t wanted, F&& f) {
  visit_effects(parameters, [&]<class E>(std::size_t index, auto& values) {
    if (index == wanted) {
      f.template operator()<E>(values);
    }
  });
}

/// Value of the van der Corput sequence in a base: the cover of [0, 1) behind a Halton sequence.
double van_der_corput(std::size_t n, std::size_t base) {
  double value = 0.0;
  double part = 1.0;
  while (n > 0) {
    part /= static_cast<double>(base);
    value += part * static_cast<double>(n % base);
    n /= base;
  }
  return value;
}

/// Adds the ordinates of the candidate's table, if it has one with points. `index` is that of the first table's first.
void append_ordinates(const ModelParameters& base, const Candidate& candidate, const Scales& scales, std::size_t index,
                      std::vector<FreeParameter>& free) {
  visit_effects(base, [&]<class E>(std::size_t effect, const auto& values) {
    using Values = std::remove_cvref_t<decltype(values)>;
    if constexpr (requires { Values::tables(); }) {
      for (const auto& field : Values::tables()) {
        const auto& table = values.*field.member;
        if (effect != candidate.effect || field.y_typical <= 0.0 || !model::is_used(field.options, candidate.option)) {
          continue;
        }
        for (int i = 0; i < table.points; ++i) {
          FreeParameter parameter = FreeParameter::at(index + static_cast<std::size_t>(i),
                                                      {{E::name, true, effect}, field.y_name, i}, field.y_unit);
          const double size = size_of_unit(field.y_unit, scales);
          parameter.unit_size = field.y_typical * size;
          parameter.lower = field.y_lower * size;
          parameter.upper = field.y_upper * size;
          parameter.prior_deviation = kOrdinatePrior;
          free.push_back(std::move(parameter));
        }
      }
      index += (values.*Values::tables().front().member).y.size();
    }
  });
}

/// Share of its typical value at which a parameter is neutral to any sensor.
constexpr double kNeutralShare = 1e-6;

/// True for a parameter that may be as little as nothing.
bool can_vanish(const FreeParameter& parameter) {
  return parameter.scale == FreeParameter::Scale::logarithmic && parameter.lower <= kNeutralShare * parameter.unit_size;
}

bool is_frequency(const FreeParameter& parameter) { return parameter.unit == "Hz"; }

/// Coordinate of a multiple of a parameter's typical value, within its bounds.
double clamped_coordinate(const FreeParameter& parameter, double factor) {
  return parameter.coordinate(std::clamp(parameter.unit_size * factor, parameter.lower, parameter.upper));
}

/// Coordinate of parameter k at point n of the cover, with frequencies at `frequency`. The first point is the typical value
/// itself; ordinates start at zero.
double start_coordinate(const FreeParameter& parameter, std::size_t k, std::size_t n, double frequency) {
  constexpr std::array<std::size_t, 8> kPrimes{2, 3, 5, 7, 11, 13, 17, 19};
  const double place = n == 0 ? 0.5 : van_der_corput(n, kPrimes[k % kPrimes.size()]);
  const double factor = std::pow(kStartSpan, 2.0 * place - 1.0);
  if (is_frequency(parameter)) {
    return parameter.coordinate(std::clamp(frequency, parameter.lower, parameter.upper));
  }
  if (parameter.is_ordinate()) {
    return parameter.coordinate(n == 0 ? 0.0 : parameter.unit_size * factor);
  }
  if (parameter.scale == FreeParameter::Scale::linear) {
    return n % 2 == 0 ? factor : -factor;
  }
  return clamped_coordinate(parameter, factor);
}

/// Frequencies where a mode may be that shows at these: in the closed loop it shows a little beside its own.
std::vector<double> about(const std::vector<double>& frequencies) {
  std::vector<double> tried;
  for (const double frequency : frequencies) {
    for (const double ratio : {0.8, 0.9, 0.96, 1.0, 1.04, 1.1, 1.2}) {
      tried.push_back(frequency * ratio);
    }
  }
  return tried;
}

std::vector<std::vector<double>> starts_of_one(const FreeParameter& parameter) {
  std::vector<std::vector<double>> starts;
  for (std::size_t n = 0; n < kStartsOfOne; ++n) {
    const double place = static_cast<double>(n) / (kStartsOfOne - 1);
    starts.push_back({clamped_coordinate(parameter, std::pow(kWhisper, 2.0 * place - 1.0))});
  }
  return starts;
}

/// Appends starts that are small: an effect far below its typical size shows from there, where from elsewhere it only
/// overshoots. Of some effects the small ones have large values (a rate limit), and of some each parameter that can vanish
/// adds its own part (friction in two directions).
void append_small_starts(const std::vector<FreeParameter>& own, std::vector<std::vector<double>>& starts) {
  const std::vector<double> typical = starts.front();
  if (std::ranges::count_if(own, can_vanish) > 1) {
    starts.push_back(typical);
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (can_vanish(own[k])) {
        starts.back()[k] = clamped_coordinate(own[k], 1.0 / kWhisper);
      }
    }
  }
  for (const double factor : {1.0 / kWhisper, kWhisper}) {
    starts.push_back(typical);
    const FreeParameter& size = own.front();
    starts.back().front() = size.scale == FreeParameter::Scale::linear ? (factor < 1.0 ? factor : -1.0 / factor)
                                                                       : clamped_coordinate(size, factor);
  }
}

/// True if the plant has the place where an effect acts.
bool has_place(const ModelParameters& plant, model::Site site) {
  return std::visit(
      [&](const auto& own) {
        if constexpr (requires { own.missing_place(site); }) {
          return own.missing_place(site).empty();
        } else {
          return true;
        }
      },
      plant);
}

}  // namespace

std::vector<Candidate> all_candidates(const ModelParameters& plant, const Dataset& data) {
  std::vector<Candidate> candidates;
  visit_effects(plant, [&]<class E>(std::size_t index, const auto& values) {
    if constexpr (requires { E::is_unlisted; }) {
      return;
    }
    if (!data.knows(E::name)) {
      return;
    }
    const int variants = std::max<int>(1, static_cast<int>(E::options.size()));
    for (int option = 0; option < variants; ++option) {
      if ((model::needs_other_axis<E>(option) && !data.has_other_axis()) || !has_place(plant, E::site)) {
        continue;
      }
      Candidate candidate{index, option, std::string(E::name), "", std::string(model::site_name(E::site))};
      if constexpr (E::options.size() > 0) {
        candidate.option_name = E::options[static_cast<std::size_t>(option)];
      }
      if constexpr (E::site == model::Site::sensor) {
        if (!data.used[static_cast<std::size_t>(option)]) {
          continue;
        }
        candidate.site += "." + candidate.option_name;
      }
      const auto fields = std::remove_cvref_t<decltype(values)>::fields();
      const bool any =
          std::any_of(fields.begin(), fields.end(), [&](const auto& f) { return model::is_used(f.options, option); });
      if (any) {
        candidates.push_back(std::move(candidate));
      }
    }
  });
  return candidates;
}

std::vector<Candidate> laws_of(const ModelParameters& plant, const Dataset& data, const Candidate& candidate) {
  std::vector<Candidate> laws = all_candidates(plant, data);
  std::erase_if(laws, [&](const Candidate& law) { return law.effect != candidate.effect || law.site != candidate.site; });
  return laws;
}

std::vector<Candidate> candidates_beside(const ModelParameters& plant, const Dataset& data) {
  std::vector<Candidate> candidates = all_candidates(plant, data);
  std::erase_if(candidates, [&](const Candidate& c) {
    return is_active(plant, c.effect) || !has_what_it_carries(plant, c) || is_measured_load(data, c.site);
  });
  return candidates;
}

bool has_what_it_carries(const ModelParameters& parameters, const Candidate& candidate) {
  std::string_view carried;
  visit_effect(parameters, candidate.effect, [&]<class E>(const auto&) {
    if constexpr (requires { E::carries; }) {
      carried = E::carries;
    }
  });
  bool active = carried.empty();
  visit_effects(parameters, [&]<class E>(std::size_t index, const auto&) {
    active = active || (E::name == carried && is_active(parameters, index));
  });
  return active;
}

bool has_law(const ModelParameters& parameters, const Candidate& candidate) {
  bool has = is_active(parameters, candidate.effect);
  visit_effect(parameters, candidate.effect, [&]<class E>(const auto& values) {
    if constexpr (E::options.size() > 0) {
      has = has && values.option == candidate.option;
    }
  });
  return has;
}

std::vector<FreeParameter> declared_parameters(const ModelParameters& base, const std::map<std::string, double>& tolerance) {
  std::vector<FreeParameter> free;
  std::size_t index = 0;
  visit_parameters(base, [&](const model::Key& key, const auto& field, const double& value) {
    const Address address{key, field.name};
    const auto found = tolerance.find(address.key());
    const bool is_declared = !key.is_effect || is_active(base, key.effect_index);
    if (is_declared && found != tolerance.end() && value != 0.0) {
      FreeParameter parameter = FreeParameter::at(index, address, field.unit);
      parameter.scale = FreeParameter::Scale::tolerance;
      parameter.declared = value;
      parameter.tolerance = found->second;
      parameter.prior_deviation = 1.0;
      // Moved by factors, it keeps its sign.
      parameter.lower = value > 0.0 ? std::max(field.lower, kLeastOfDeclared * value) : field.lower;
      parameter.upper = value < 0.0 ? std::min(field.upper, kLeastOfDeclared * value) : field.upper;
      free.push_back(std::move(parameter));
    }
    ++index;
  });
  return free;
}

std::vector<FreeParameter> effect_parameters(const ModelParameters& base, const Candidate& candidate, const Scales& scales) {
  std::vector<FreeParameter> free;
  std::size_t index = 0;
  visit_parameters(base, [&](const model::Key& key, const auto& field, const double&) {
    if (key.is_effect && key.effect_index == candidate.effect && model::is_searched(field, candidate.option)) {
      FreeParameter parameter = FreeParameter::at(index, {key, field.name}, field.unit);
      const double size = size_of_unit(field.unit, scales);
      parameter.unit_size = field.typical * size;
      parameter.lower = field.lower * size;
      parameter.upper = field.upper * size;
      if (model::searched_in_logarithms(field)) {
        parameter.scale = FreeParameter::Scale::logarithmic;
        // A logarithm needs a floor.
        parameter.lower = std::max(parameter.lower, kNeutralShare * parameter.unit_size);
        parameter.prior_center = std::log(parameter.unit_size);
        parameter.prior_deviation = kWeakPrior;
      }
      free.push_back(std::move(parameter));
    }
    ++index;
  });
  append_ordinates(base, candidate, scales, index, free);
  return free;
}

std::vector<FreeParameter> initial_states(const Dataset& data, const Scales& scales, std::vector<double>& u) {
  std::vector<FreeParameter> free;
  for (std::size_t e = 0; e < data.experiments.size(); ++e) {
    const StartState& start = data.experiments[e].start_state;
    if (!start.moves()) {
      continue;
    }
    const auto add = [&](InitialState state, const char* name, const char* unit, double value, double error) {
      FreeParameter parameter;
      parameter.key = data.experiments[e].name + name;
      parameter.unit = unit;
      parameter.unit_size = size_of_unit(unit, scales);
      parameter.experiment = static_cast<int>(e);
      parameter.state = state;
      parameter.lower = -1e3 * parameter.unit_size;
      parameter.upper = 1e3 * parameter.unit_size;
      parameter.prior_center = parameter.coordinate(value);
      parameter.prior_deviation = error / parameter.unit_size;
      u.push_back(parameter.prior_center);
      free.push_back(std::move(parameter));
    };
    if (start.position_error > 0.0) {
      add(InitialState::position, ".initial_position", "position", start.position, start.position_error);
    }
    add(InitialState::velocity, ".initial_velocity", "position/time", start.velocity, start.velocity_error);
  }
  return free;
}

std::vector<std::vector<double>> start_points(const std::vector<FreeParameter>& own,
                                              const std::vector<double>& frequencies) {
  if (own.size() == 1 && own.front().scale == FreeParameter::Scale::logarithmic && !is_frequency(own.front())) {
    return starts_of_one(own.front());
  }
  const bool has_frequency = std::any_of(own.begin(), own.end(), is_frequency);
  const std::vector<double> tried = has_frequency ? about(frequencies) : std::vector{1.0};
  const bool all_ordinates = std::all_of(own.begin(), own.end(), [](const FreeParameter& p) { return p.is_ordinate(); });
  const std::size_t covers = all_ordinates ? 1 : has_frequency ? 2 : (own.size() == 1 ? 6 : 10);
  std::vector<std::vector<double>> starts;
  for (const double frequency : tried) {
    for (std::size_t n = 0; n < covers; ++n) {
      starts.emplace_back();
      for (std::size_t k = 0; k < own.size(); ++k) {
        starts.back().push_back(start_coordinate(own[k], k, n, frequency));
      }
    }
  }
  if (!has_frequency && !all_ordinates && !own.empty()) {
    append_small_starts(own, starts);
  }
  return starts;
}

void activate(ModelParameters& parameters, const Candidate& candidate) {
  visit_effect(parameters, candidate.effect, [&]<class E>(auto& values) {
    values.option = candidate.option;
    if constexpr (requires { values.choices(); }) {
      for (std::size_t i = 0; i < candidate.choices.size(); ++i) {
        values.*values.choices()[i].member = candidate.choices[i];
      }
    }
  });
  set_active(parameters, candidate.effect, true);
}

}  // namespace hotfire::explain
