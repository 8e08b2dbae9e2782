// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>
#include <ceres/jet.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "model/keys.hpp"
#include "tests/model/support/plants.hpp"

namespace hotfire::test {
namespace {

using Dual = ceres::Jet<double, 4>;

constexpr double kDuration = 0.6;
constexpr double kGradientSample = 1e-3;

struct SimplexIn {
  template <class S>
  using Plant = model::Simplex<S>;
};
struct DirectIn {
  template <class S>
  using Plant = model::Direct<S>;
};
struct MotorIn {
  template <class S>
  using Plant = model::Electromechanical<S>;
};

/// The reference plant in the scalar S with one law active at 3 % above its typical values; none if `E` is void. At the
/// typical values themselves a delay is a whole number of steps, where its interpolation has a corner.
template <class Family, class E, class S>
auto planted(int option) {
  using Plant = typename Family::template Plant<S>;
  if constexpr (std::is_void_v<E>) {
    return reference_parameters<Plant>();
  } else {
    auto parameters = parameters_around<Plant, E>();
    auto values = typical<E, S>(option);
    for (const auto& field : ParamsOf<E, S>::fields()) {
      values.*field.member *= S(1.03);
    }
    activate<E, Plant>(parameters, values);
    return parameters;
  }
}

/// Calls `f(name, value)` for each parameter that can be fitted: of the effect `law`, or of every declared part if it is
/// empty. What follows takes laws by their name: compiled once for each law, this file takes minutes.
template <class S, class Parameters>
void visit_fitted(Parameters& parameters, std::string_view law, int option,
                  const std::function<void(const std::string&, S&)>& f) {
  model::visit_parameters(parameters, [&](const model::Key& key, const auto& field, S& value) {
    if (law.empty() ? !key.is_effect : key.is_effect && key.section == law && used_by(field, option)) {
      f(std::string(key.section).append(".").append(field.name), value);
    }
  });
}

/// The parameters of a plant in double and in dual numbers, and which of them are fitted.
template <class Family>
struct Case {
  typename Family::template Plant<double>::Parameters plain;
  typename Family::template Plant<Dual>::Parameters dual;
  std::string_view law;
  int option;
};

/// The record with parameter number `which` changed by the factor 1 + `change`.
template <class Family>
auto record_with(const Case<Family>& of, int which, double change) {
  auto parameters = of.plain;
  int index = 0;
  visit_fitted<double>(parameters, of.law, of.option, [&](const std::string&, double& value) {
    if (index++ == which) {
      value *= 1.0 + change;
    }
  });
  return record<typename Family::template Plant<double>>(parameters, kDuration, kGradientSample, 2);
}

/// Compares the derivative in slot `slot` of a dual record with the central difference over parameter number `which`.
template <class Family, class Rows>
void check_column(const Case<Family>& of, const Rows& rows, int slot, int which, const std::string& name, double value) {
  constexpr double change = 1e-4;
  const auto up = record_with(of, which, change);
  const auto down = record_with(of, which, -change);
  for (std::size_t channel = 0; channel < rows[0].size(); ++channel) {
    double error = 0.0;
    double size = 0.0;
    double signal = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double difference = (up[i][channel] - down[i][channel]) / (2.0 * change);
      const double exact = rows[i][channel].v[slot] * value;
      error += (difference - exact) * (difference - exact);
      size += difference * difference;
      signal += rows[i][channel].a * rows[i][channel].a;
    }
    // The central difference itself errs by change^2 = 1e-8 of the curvature, and by the rounding of the run, 1e-12 of the
    // signal over 2e-4: 1e-4 of a column whose elasticity is 1e-4.
    if (!(std::sqrt(error) <= 1e-4 * std::sqrt(size) + 1e-8 * std::sqrt(signal))) {
      FAIL((name + " of option " + std::to_string(of.option) + " in channel " + std::to_string(channel) + ": off by " +
            std::to_string(std::sqrt(error / size)))
               .c_str());
    }
  }
}

template <class Family>
void check_columns(const Case<Family>& of) {
  auto plain_parameters = of.plain;
  std::vector<std::string> names;
  std::vector<double> values;
  visit_fitted<double>(plain_parameters, of.law, of.option, [&](const std::string& name, double& value) {
    names.push_back(name);
    values.push_back(value);
  });
  for (int first = 0; first < static_cast<int>(names.size()); first += 4) {
    auto parameters = of.dual;
    int index = 0;
    visit_fitted<Dual>(parameters, of.law, of.option, [&](const std::string&, Dual& value) {
      if (index >= first && index < first + 4) {
        value.v[index - first] = 1.0;
      }
      ++index;
    });
    const auto rows = record<typename Family::template Plant<Dual>>(parameters, kDuration, kGradientSample, 2);
    for (int slot = 0; slot < 4 && first + slot < static_cast<int>(names.size()); ++slot) {
      const int which = first + slot;
      const auto at = static_cast<std::size_t>(which);
      check_column(of, rows, slot, which, names[at], values[at]);
    }
  }
}

/// The law E, or all declared parts if E is void.
template <class Family, class E>
void check_gradients(int option) {
  std::string_view law;
  if constexpr (!std::is_void_v<E>) {
    law = E::name;
  }
  check_columns<Family>({planted<Family, E, double>(option), planted<Family, E, Dual>(option), law, option});
}

}  // namespace

TEST_GROUP(Gradient){};

TEST(Gradient, IsExactForEveryDeclaredParameter) {
  check_gradients<SimplexIn, void>(0);
  check_gradients<DirectIn, void>(0);
  check_gradients<MotorIn, void>(0);
}

TEST(Gradient, IsExactForEveryFieldOfEveryEffect) {
  for_each_law([]<class E>(int option) {
    if (jumps<E>(option)) {
      return;
    }
    if constexpr (index_in<E>(model::SimplexEffects{}) < model::SimplexEffects::size) {
      check_gradients<SimplexIn, E>(option);
    } else if constexpr (index_in<E>(model::DirectEffects{}) < model::DirectEffects::size) {
      check_gradients<DirectIn, E>(option);
    } else {
      check_gradients<MotorIn, E>(option);
    }
  });
}

}  // namespace hotfire::test
