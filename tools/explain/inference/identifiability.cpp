// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/inference/identifiability.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "tools/explain/inference/uncertainty.hpp"
#include "tools/explain/words/conclusions.hpp"

namespace hotfire::explain {

namespace {

/// A quantity is identified where its factors are not if its deviation is below this share of each factor's.
constexpr double kBetterThanFactors = 0.5;
/// A declared parameter is identified by the data if it is known to less than this share of its tolerance.
constexpr double kDetermined = 0.9;
/// Correlation from which two parameters are not separated: either is known to a third of its deviation if the other is
/// given.
constexpr double kAlike = 0.95;

/// A quantity of the plant that the data may identify better than its factors.
struct Combination {
  std::string name;
  std::function<double(const ModelParameters&)> value;
};

/// A quantity of one kind of plant, of parameters that hold this kind.
template <class Parameters>
Combination combination_of(words::Combination name, double (*value)(const Parameters&)) {
  return {words::name_of(name), [value](const ModelParameters& p) { return value(std::get<Parameters>(p)); }};
}

std::vector<Combination> combinations(const ModelParameters& plant) {
  using Axis = SimplexParameters;
  using Mass = DirectParameters;
  using enum words::Combination;
  if (std::holds_alternative<Mass>(plant)) {
    return {combination_of<Mass>(natural_frequency, [](const Mass& p) { return p.mass.stiffness / p.mass.inertia; }),
            combination_of<Mass>(mass_damping, [](const Mass& p) { return p.mass.damping / p.mass.inertia; })};
  }
  if (!is_hydraulic_axis(plant)) {
    return {};
  }
  return {combination_of<Axis>(notch,
                               [](const Axis& p) {
                                 // The step does not matter to what is asked of the plant.
                                 constexpr double kStep = 1e-3;
                                 return model::Simplex<double>(p, kStep).stiffness() * p.actuator.moment_arm *
                                        p.actuator.moment_arm / p.engine.inertia;
                               }),
          combination_of<Axis>(
              loop_gain,
              [](const Axis& p) { return p.servovalve.rated_flow * p.servovalve.position_gain / p.actuator.piston_area; }),
          combination_of<Axis>(oil_stiffness,
                               [](const Axis& p) {
                                 return p.actuator.bulk_modulus * p.actuator.piston_area * p.actuator.piston_area /
                                        p.actuator.trapped_volume;
                               }),
          combination_of<Axis>(engine_damping, [](const Axis& p) { return p.engine.viscous_damping / p.engine.inertia; })};
}

class Identifiability {
 public:
  explicit Identifiability(const Fitted& fitted) : fitted_(fitted), covariance_(covariance_of(fitted.normal)) {
    for (std::size_t k = 0; k < fitted.free.size(); ++k) {
      const FreeParameter& parameter = fitted.free[k];
      if (!parameter.is_ordinate() && !parameter.is_initial_state() && parameter.value(fitted.u[k]) != 0.0) {
        considered_.push_back(k);
      }
    }
  }

  std::vector<std::string> sentences() {
    std::vector<std::string> all;
    for (const Combination& combination : combinations(fitted_.base)) {
      say_combination(combination, all);
    }
    say_groups(all);
    say_undetermined(all);
    return all;
  }

 private:
  const FreeParameter& parameter(std::size_t k) const { return fitted_.free[k]; }

  double covariance(std::size_t a, std::size_t b) const {
    return covariance_(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
  }

  /// Relative change of a parameter by a unit of its coordinate.
  double relative_slope(std::size_t k) const { return parameter(k).slope(fitted_.u[k]) / parameter(k).value(fitted_.u[k]); }

  double relative_deviation(std::size_t k) const {
    return std::abs(relative_slope(k)) * std::sqrt(std::max(0.0, covariance(k, k)));
  }

  void say_combination(const Combination& combination, std::vector<std::string>& all) {
    const auto logarithm = [&](std::size_t k, double move) {
      std::vector<double> u = fitted_.u;
      u[k] += move;
      return std::log(std::abs(combination.value(with_values(fitted_.base, fitted_.free, u))));
    };
    constexpr double kMove = 1e-4;
    std::vector<std::size_t> factors;
    std::vector<double> slopes;
    for (const std::size_t k : considered_) {
      const double slope = (logarithm(k, kMove) - logarithm(k, -kMove)) / (2.0 * kMove);
      if (std::isfinite(slope) && slope != 0.0) {
        factors.push_back(k);
        slopes.push_back(slope);
      }
    }
    double variance = 0.0;
    for (std::size_t i = 0; i < factors.size(); ++i) {
      for (std::size_t j = 0; j < factors.size(); ++j) {
        variance += slopes[i] * slopes[j] * covariance(factors[i], factors[j]);
      }
    }
    const double deviation = std::sqrt(std::max(0.0, variance));
    const bool better = std::all_of(factors.begin(), factors.end(),
                                    [&](std::size_t k) { return deviation < kBetterThanFactors * relative_deviation(k); });
    if (factors.size() < 2 || !better) {
      return;
    }
    std::vector<std::string> each;
    for (const std::size_t k : factors) {
      each.push_back(words::factor(parameter(k).key, relative_deviation(k)));
      said_.insert(k);
    }
    all.push_back(words::combination_identified(combination.name, deviation, each));
  }

  double correlation(std::size_t a, std::size_t b) const {
    return covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
  }

  /// The parameters that are not separated from one of the others in the group, directly or by way of each other.
  std::vector<std::size_t> group_about(std::size_t first, std::set<std::size_t>& left) const {
    std::vector<std::size_t> group{first};
    left.erase(first);
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (auto other = left.begin(); other != left.end();) {
        if (std::abs(correlation(group[i], *other)) > kAlike) {
          group.push_back(*other);
          other = left.erase(other);
        } else {
          ++other;
        }
      }
    }
    return group;
  }

  void say_groups(std::vector<std::string>& all) {
    std::set<std::size_t> left(considered_.begin(), considered_.end());
    while (!left.empty()) {
      std::vector<std::size_t> group = group_about(*left.begin(), left);
      const bool said = std::all_of(group.begin(), group.end(), [&](std::size_t k) { return said_.contains(k); });
      if (group.size() < 2 || said) {
        continue;
      }
      std::sort(group.begin(), group.end());
      const std::size_t first = group.front();
      std::vector<std::string> others;
      for (const std::size_t k : group) {
        // Along the ridge, by a percent of the first.
        const double rate = covariance(first, k) / covariance(first, first) * relative_slope(k) / relative_slope(first);
        if (k != first) {
          others.push_back(words::moves_along(parameter(k).key, rate));
        }
      }
      said_.insert(group.begin(), group.end());
      all.push_back(words::hardly_separated(parameter(first).key, others, relative_deviation(first)));
    }
  }

  void say_undetermined(std::vector<std::string>& all) const {
    std::vector<std::string> undetermined;
    for (const std::size_t k : considered_) {
      // A coordinate of a declared parameter is in its tolerances.
      if (parameter(k).is_declared() && !said_.contains(k) && std::sqrt(covariance(k, k)) > kDetermined) {
        undetermined.push_back(parameter(k).key);
      }
    }
    if (!undetermined.empty()) {
      all.push_back(words::not_determined(undetermined));
    }
  }

  const Fitted& fitted_;
  Eigen::MatrixXd covariance_;
  std::vector<std::size_t> considered_;
  std::set<std::size_t> said_;  ///< parameters that a sentence has named
};

}  // namespace

std::vector<std::string> not_separated(const Fitted& fitted) {
  if (fitted.free.empty() || fitted.normal.rows() != static_cast<Eigen::Index>(fitted.free.size())) {
    return {};
  }
  return Identifiability(fitted).sentences();
}

}  // namespace hotfire::explain
