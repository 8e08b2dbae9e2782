// SPDX-License-Identifier: Apache-2.0
#include "tools/study/cases/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/study/cases/case_parts.hpp"
#include "tools/study/cases/recording.hpp"

namespace hotfire::study {
namespace {

/// A declared parameter whose value is known within a tolerance.
struct Scattered {
  const char* section;
  const char* key;
  double ReferenceAxis::*member;
  double tolerance;
};
constexpr std::array kScattered{
    Scattered{"servovalve", "natural_frequency", &ReferenceAxis::valve_frequency, 0.05},
    Scattered{"servovalve", "position_gain", &ReferenceAxis::position_gain, 0.03},
    Scattered{"servovalve", "pressure_feedback_gain", &ReferenceAxis::pressure_gain, 0.1},
    Scattered{"actuator", "bulk_modulus", &ReferenceAxis::bulk_modulus, 0.1},
    Scattered{"actuator", "leakage", &ReferenceAxis::leakage, 0.3},
    Scattered{"actuator", "piston_damping", &ReferenceAxis::piston_damping, 0.3},
    Scattered{"structure", "stiffness", &ReferenceAxis::load_stiffness, 0.05},
    Scattered{"engine", "inertia", &ReferenceAxis::inertia, 0.02},
    Scattered{"engine", "viscous_damping", &ReferenceAxis::damping, 0.3},
    Scattered{"engine", "duct_stiffness", &ReferenceAxis::duct_stiffness, 0.05},
};

/// What is exact.
struct Exact {
  const char* section;
  const char* key;
  double ReferenceAxis::*member;
};
constexpr std::array kExact{
    Exact{"servovalve", "rated_flow", &ReferenceAxis::rated_flow},
    Exact{"servovalve", "damping_ratio", &ReferenceAxis::valve_damping},
    Exact{"servovalve", "pressure_feedback_corner", &ReferenceAxis::pressure_corner},
    Exact{"actuator", "piston_area", &ReferenceAxis::area},
    Exact{"actuator", "supply_pressure", &ReferenceAxis::supply},
    Exact{"actuator", "trapped_volume", &ReferenceAxis::volume},
    Exact{"actuator", "piston_mass", &ReferenceAxis::piston_mass},
    Exact{"actuator", "stiffness", &ReferenceAxis::actuator_stiffness},
    Exact{"actuator", "moment_arm", &ReferenceAxis::arm},
};

}  // namespace

bool measures_load_pressure(const CaseOrder& order) { return order.seed % 3 == 0; }

ReferenceAxis scattered_axis(const CaseOrder& order, std::uint64_t part) {
  ReferenceAxis axis;
  Random scatter(order.name, order.seed, part);
  for (const Scattered& entry : kScattered) {
    axis.*entry.member *= 1.0 + order.scatter_factor * entry.tolerance * scatter.normal_within(1.0);
  }
  return axis;
}

std::string model_toml(const ReferenceAxis& axis, const CaseOrder& order, const std::string& effects) {
  std::string text = fmt::format("schema = 1\nname = \"{} TVC actuator, as its engineer declares it\"\ntopology = \"{}\"\n",
                                 order.two_axes ? "two-axis" : "single-axis", order.two_axes ? "taos" : "simplex");
  for (const char* section : {"servovalve", "actuator", "structure", "engine"}) {
    text += fmt::format("\n[{}]\n", section);
    const auto add = [&](const auto& entries) {
      for (const auto& entry : entries) {
        if (std::string(entry.section) == section) {
          text += fmt::format("{} = {}\n", entry.key, axis.*entry.member);
        }
      }
    };
    add(kExact);
    add(kScattered);
  }
  text += "\n[sensors]\n";
  for (std::size_t c = 0; c < (measures_load_pressure(order) ? 3 : 2); ++c) {
    text += fmt::format("{}_noise = {}\n", kSensorGrades[c].channel, kSensorGrades[c].noise * order.noise_factor);
  }
  text += "\n" + effects + "# relative one-sigma tolerance of a declared value; a value without one is exact\n[tolerance]\n";
  for (const Scattered& entry : kScattered) {
    text += fmt::format("{}.{} = {}\n", entry.section, entry.key, entry.tolerance);
  }
  return text;
}

std::vector<double> one_row_later(std::vector<double> commands) {
  std::rotate(commands.rbegin(), commands.rbegin() + 1, commands.rend());
  commands.front() = 0.0;
  return commands;
}

double quantised(double value, const SensorGrade& grade) {
  return grade.quantum > 0.0 ? grade.quantum * std::round(value / grade.quantum) : value;
}

double noisy(double value, const SensorGrade& grade, double factor, Random& random) {
  return quantised(value + grade.noise * factor * random.normal(), grade);
}

double rms_of_difference(const ReferenceRows& a, const ReferenceRows& b, std::size_t channel) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i][channel] - b[i][channel]) * (a[i][channel] - b[i][channel]);
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

namespace {

/// Rms of the difference in sensor noise.
std::map<std::string, double> difference(const ReferenceRows& a, const ReferenceRows& b, double noise_factor) {
  std::map<std::string, double> sizes;
  for (std::size_t c = 0; c < 2; ++c) {
    sizes[kSensorGrades[c].channel] = rms_of_difference(a, b, c) / (kSensorGrades[c].noise * noise_factor);
  }
  return sizes;
}

/// An effect under the names that the model has for its parameters.
std::string effect_toml(const StudiedEffect& effect, const Plan& alone) {
  std::string text = fmt::format("[effects.{}]\n", effect.name);
  if (!alone.law.empty()) {
    text += fmt::format("{} = \"{}\"\n", effect.site == "sensor" ? "channel" : "law", alone.law);
  }
  for (const auto& [name, value] : alone.values) {
    text += fmt::format("{} = {}\n", name, value);
  }
  return text + "\n";
}

/// A null bias belongs to the valve: it is in every record, also in the unseen one.
void add_null_bias(const Condition& condition, ReferenceAxis& plain, Plan& plan) {
  if (condition.null_bias != 0.0) {
    plain.unlisted.null_offset = condition.null_bias;
    plan.true_effects = fmt::format("[effects.valve_bias]\nbias = {}\n\n", condition.null_bias);
  }
}

/// Adds an effect to the case's plan, with the first of the drawn magnitudes that shows as it should.
void add_effect(const StudiedEffect& effect, const CaseOrder& order, const ReferenceAxis& plain, const Profile& unseen,
                const ReferenceRows& plain_rows, StudyCase& made) {
  for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
    const auto stream = [&] { return Random(std::string(effect.name) + "/" + order.name, order.seed, 100 + draw); };
    Plan alone;
    alone.axis = alone.without = plain;
    Random random = stream();
    effect.plan(alone, random, order.seed);
    const ReferenceRows with = run(alone.axis, unseen);
    const ReferenceRows without = alone.declared_effects.empty() ? plain_rows : run(alone.without, unseen);
    const auto size = difference(with, without, order.noise_factor);
    const double largest = std::max(size.at("piston"), size.at("engine"));
    if (largest >= kSmallestEffect && largest <= kLargestEffect) {
      Random again = stream();
      Plan together = made.plan;
      together.values.clear();
      effect.plan(together, again, order.seed);
      for (const auto& [name, value] : together.values) {
        made.plan.values[std::string(effect.name) + "." + name] = value;
      }
      together.values = made.plan.values;
      together.true_effects += effect_toml(effect, alone);
      together.in_model_terms = together.in_model_terms && is_listed(effect);
      together.law = made.plan.law + (made.plan.law.empty() || alone.law.empty() ? "" : " ") + alone.law;
      made.plan = together;
      return;
    }
  }
  throw std::runtime_error(fmt::format("{} with seed {}: no magnitude of {} drawn shows at {} to {} times the sensor noise",
                                       order.name, order.seed, effect.name, kSmallestEffect, kLargestEffect));
}

}  // namespace

StudyCase make_case(const CaseOrder& order) {
  if (order.two_axes) {
    return make_two_axis_case(order);
  }
  StudyCase made;
  made.order = order;
  ReferenceAxis plain = scattered_axis(order, 1);
  add_null_bias(condition_of(order.condition), plain, made.plan);
  made.plan.axis = made.plan.without = plain;

  const Profile unseen = unseen_profile(Random(order.name, order.seed, 2));
  const ReferenceRows plain_rows = run(plain, unseen);
  for (const std::string& name : order.effects) {
    if (name == kWild) {
      add_wild_law(order, unseen, made);
    } else {
      add_effect(studied_effect(name), order, plain, unseen, plain_rows, made);
    }
  }

  const ReferenceRows truth = order.effects.empty() ? plain_rows : run(made.plan.axis, unseen);
  made.unseen = unseen_record(order, unseen, truth);
  made.effect_size = difference(truth, made.plan.declared_effects.empty() ? plain_rows : run(made.plan.without, unseen),
                                order.noise_factor);
  const Condition& condition = condition_of(order.condition);
  Given given = recorded(order, made.plan.axis, conditioned_profiles(condition, order.name, order.seed));
  made.given = std::move(given.records);
  made.exclusions = std::move(given.exclusions);
  made.declared = model_toml({}, order, made.plan.declared_effects);
  if (made.plan.in_model_terms) {
    made.truth = model_toml(made.plan.axis, order, made.plan.declared_effects + made.plan.true_effects);
  }
  return made;
}

}  // namespace hotfire::study
