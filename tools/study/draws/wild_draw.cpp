// SPDX-License-Identifier: Apache-2.0
#include "tools/study/draws/wild_draw.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace hotfire::study {
namespace {

using Shape = WildCurve::Shape;
using Kind = WildMemory::Kind;
using Argument = WildArgument;

/// Pure numbers over which curves are drawn: signals stay within +-2 in 99 of 100 rows.
constexpr double kReach = 2.0;
/// Of a curve's rms that a straight line may take; beyond, it is a gain, which is declared or listed. 0.95 leaves 0.31 of
/// the rms, and lets a hard saturation (0.87) and a power of 2.6 (0.94) pass.
constexpr double kMostStraight = 0.95;
constexpr int kGrid = 81;

template <class T>
const T& one_of(Random& random, std::span<const T> choices) {
  const auto at = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(choices.size())));
  return choices[std::min(at, choices.size() - 1)];
}

template <class T, std::size_t N>
const T& one_of(Random& random, const std::array<T, N>& choices) {
  return one_of(random, std::span<const T>(choices));
}

bool happens(Random& random, double probability) { return random.uniform(0.0, 1.0) < probability; }

/// What a site meets itself.
std::span<const Argument> own_arguments(WildSite site) {
  static constexpr std::array kCommand{Argument::command, Argument::error};
  static constexpr std::array kValveCommand{Argument::valve_command, Argument::error, Argument::spool};
  static constexpr std::array kValve{Argument::spool, Argument::flow, Argument::pressure};
  static constexpr std::array kOil{Argument::pressure, Argument::flow, Argument::spool, Argument::rate};
  static constexpr std::array kPiston{Argument::rate, Argument::position, Argument::pressure};
  static constexpr std::array kSpring{Argument::deflection, Argument::position, Argument::angle_rate};
  static constexpr std::array kEngine{Argument::angle, Argument::angle_rate, Argument::deflection};
  static constexpr std::array kPistonSensor{Argument::position, Argument::rate};
  static constexpr std::array kEngineSensor{Argument::angle, Argument::angle_rate};
  switch (site) {
    case WildSite::command:
      return kCommand;
    case WildSite::valve_command:
      return kValveCommand;
    case WildSite::valve:
      return kValve;
    case WildSite::flow:
    case WildSite::pressure:
      return kOil;
    case WildSite::piston:
      return kPiston;
    case WildSite::load_spring:
      return kSpring;
    case WildSite::engine_torque:
      return kEngine;
    case WildSite::piston_sensor:
      return kPistonSensor;
    case WildSite::engine_sensor:
      return kEngineSensor;
  }
  return {};
}

/// The signal that a site transmits, if it does.
std::optional<Argument> transmitted(WildSite site) {
  switch (site) {
    case WildSite::command:
      return Argument::command;
    case WildSite::valve_command:
      return Argument::valve_command;
    case WildSite::valve:
      return Argument::spool;
    case WildSite::load_spring:
      return Argument::deflection;
    case WildSite::piston_sensor:
      return Argument::position;
    case WildSite::engine_sensor:
      return Argument::angle;
    default:
      return std::nullopt;
  }
}

Argument any_argument(Random& random) {
  return static_cast<Argument>(std::min(static_cast<std::size_t>(random.uniform(0.0, kWildArguments)), kWildArguments - 1));
}

/// What a term of usual size is, in the site's unit.
double unit_of(WildSite site, const ReferenceAxis& axis, const WildScales& scales) {
  switch (site) {
    case WildSite::command:
      return scales.of(Argument::command);
    case WildSite::valve_command:
    case WildSite::valve:
      return scales.of(Argument::spool);
    case WildSite::flow:
      return scales.of(Argument::flow);
    case WildSite::pressure:
      return 4.0 * axis.bulk_modulus / axis.volume * scales.of(Argument::flow);
    case WildSite::piston:
      return axis.area * scales.of(Argument::pressure);
    case WildSite::load_spring:
      return scales.of(Argument::deflection);
    case WildSite::engine_torque:
      return axis.arm * axis.area * scales.of(Argument::pressure);
    case WildSite::piston_sensor:
      return scales.of(Argument::position);
    case WildSite::engine_sensor:
      return scales.of(Argument::angle);
  }
  return 0.0;
}

/// Largest size within reach, and the part of the rms that a line through zero takes.
struct CurveSize {
  double largest = 0.0;
  double straight = 0.0;
};

CurveSize size_of(const WildCurve& curve) {
  CurveSize size;
  double product = 0.0;
  double square = 0.0;
  double line = 0.0;
  for (int i = 0; i < kGrid; ++i) {
    const double s = kReach * (2.0 * i / (kGrid - 1.0) - 1.0);
    const double y = curve(s);
    size.largest = std::max(size.largest, std::abs(y));
    product += s * y;
    square += y * y;
    line += s * s;
  }
  size.straight = square > 0.0 ? std::abs(product) / std::sqrt(square * line) : 1.0;
  return size;
}

WildCurve draw_shape(Random& random) {
  WildCurve curve;
  constexpr std::array kShapes{Shape::waves,      Shape::waves,      Shape::waves,     Shape::bumps,     Shape::odd_power,
                               Shape::even_power, Shape::saturation, Shape::dead_zone, Shape::one_sided, Shape::ripple};
  curve.shape = one_of(random, kShapes);
  switch (curve.shape) {
    case Shape::waves: {
      const int parity = static_cast<int>(random.uniform(0.0, 3.0));
      for (int k = 1; k <= 3; ++k) {
        const double odd = parity == 1 ? 0.0 : random.normal() / k;
        const double even = parity == 0 ? 0.0 : random.normal() / k;
        curve.parts.push_back({odd, even, k * random.uniform(0.5, 1.3)});
      }
      break;
    }
    case Shape::bumps:
      for (int k = 0; k < 3; ++k) {
        curve.parts.push_back({random.normal(), random.uniform(-1.5, 1.5), random.log_uniform(0.15, 0.7)});
      }
      break;
    case Shape::odd_power:
    case Shape::even_power:
      curve.parts.push_back({random.uniform(1.4, 2.6), 0.0, 0.0});
      break;
    case Shape::saturation:
      curve.parts.push_back({random.log_uniform(0.1, 0.5), 0.0, 0.0});
      break;
    case Shape::dead_zone:
      curve.parts.push_back({random.uniform(0.3, 1.0), 0.0, 0.0});
      break;
    case Shape::one_sided:
      curve.parts.push_back({random.log_uniform(3.0, 20.0), random.uniform(-0.5, 1.0), 0.0});
      break;
    case Shape::ripple:
      curve.parts.push_back({random.log_uniform(4.0, 15.0), random.uniform(0.0, 2.0 * std::numbers::pi), 0.0});
      break;
    case Shape::line:
    case Shape::stairs:
      break;
  }
  return curve;
}

/// A curve that is one within reach and far from a line.
WildCurve draw_curve(Random& random) {
  for (;;) {
    WildCurve curve = draw_shape(random);
    const CurveSize size = size_of(curve);
    if (size.largest > 0.0 && size.straight <= kMostStraight) {
      curve.height = random.sign() / size.largest;
      return curve;
    }
  }
}

WildMemory draw_memory(Random& random, Kind kind) {
  WildMemory memory;
  memory.kind = kind;
  switch (kind) {
    case Kind::none:
      break;
    case Kind::delay:
      memory.time = random.log_uniform(8e-3, 6e-2);
      break;
    case Kind::first_order:
    case Kind::washout:
      memory.time = random.log_uniform(5e-3, 0.5);
      break;
    case Kind::second_order:
    case Kind::band_pass:
      memory.frequency = random.log_uniform(2.0, 20.0);
      // Below 0.2 a resonance of the deflection is the listed structural mode.
      memory.damping = random.log_uniform(0.25, 0.9);
      break;
    case Kind::plays:
    case Kind::stops: {
      const int count = static_cast<int>(random.uniform(1.0, 1.0 + WildMemory::kMostStates));
      double sum = 0.0;
      for (int i = 0; i < count; ++i) {
        memory.plays.push_back({random.log_uniform(0.03, 0.6), random.uniform(0.3, 1.0)});
        sum += memory.plays.back()[1];
      }
      for (auto& play : memory.plays) {
        play[1] /= sum;
      }
      break;
    }
    case Kind::rate_limit:
      memory.limit = random.log_uniform(1.0, 15.0);
      break;
    case Kind::hold:
      memory.rows = static_cast<int>(random.log_uniform(4.0, 40.0));
      break;
    case Kind::leaky_integral:
      memory.time = random.log_uniform(1.0, 10.0);
      break;
    case Kind::swing:
      memory.frequency = random.log_uniform(1.5, 15.0);
      memory.damping = random.sign() * random.uniform(0.1, 0.6);
      break;
  }
  return memory;
}

WildLaw draw_addition(Random& random, WildSite site) {
  WildLaw law;
  law.site = site;
  law.argument = happens(random, 0.7) ? one_of(random, own_arguments(site)) : any_argument(random);
  if (happens(random, 0.25)) {
    law.factor = any_argument(random);
  }
  if (happens(random, 0.6)) {
    constexpr std::array kKinds{Kind::delay,      Kind::first_order, Kind::washout,        Kind::second_order,
                                Kind::band_pass,  Kind::plays,       Kind::stops,          Kind::stops,
                                Kind::rate_limit, Kind::hold,        Kind::leaky_integral, Kind::swing};
    law.memory = draw_memory(random, one_of(random, kKinds));
  }
  const bool straight = law.memory.kind == Kind::swing || (law.memory.kind != Kind::none && happens(random, 0.4)) ||
                        (law.factor && happens(random, 0.4));
  if (!straight) {
    law.curve = draw_curve(random);
    law.curve_first = happens(random, 0.5);
  }
  return law;
}

WildLaw draw_replacement(Random& random, WildSite site) {
  WildLaw law;
  law.site = site;
  law.argument = *transmitted(site);
  law.replaces = true;
  constexpr std::array kKinds{Kind::delay,      Kind::first_order, Kind::second_order, Kind::plays,
                              Kind::rate_limit, Kind::hold,        Kind::none,         Kind::none};
  law.memory = draw_memory(random, one_of(random, kKinds));
  if (law.memory.kind == Kind::none) {
    constexpr std::array kShapes{Shape::stairs, Shape::saturation, Shape::dead_zone};
    law.curve.shape = one_of(random, kShapes);
    law.curve.parts = {{random.log_uniform(0.1, 0.6), 0.0, 0.0}};
    if (law.curve.shape == Shape::saturation) {
      law.curve.parts[0][0] = 1.0;
    }
  }
  return law;
}

}  // namespace

WildScales::WildScales(const QuantityRows& rows) {
  const auto scale_of = [&](const auto& value) {
    std::vector<double> sizes;
    sizes.reserve(rows.size());
    for (const WildQuantities& row : rows) {
      sizes.push_back(std::abs(value(row)));
    }
    const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(sizes.size()));
    std::nth_element(sizes.begin(), at, sizes.end());
    return *at / kReach;
  };
  for (std::size_t a = 0; a < kWildArguments; ++a) {
    single_[a] = scale_of([&](const WildQuantities& row) { return row[a]; });
    for (std::size_t b = 0; b < kWildArguments; ++b) {
      products_[a * kWildArguments + b] = scale_of([&](const WildQuantities& row) { return row[a] * row[b]; });
    }
  }
}

double WildScales::of(WildArgument argument, std::optional<WildArgument> factor) const {
  const auto a = static_cast<std::size_t>(argument);
  return factor ? products_[a * kWildArguments + static_cast<std::size_t>(*factor)] : single_[a];
}

WildLaw draw_wild_law(Random& random, const ReferenceAxis& axis, const WildScales& scales) {
  const auto site =
      static_cast<WildSite>(std::min(static_cast<std::size_t>(random.uniform(0.0, kWildSites)), kWildSites - 1));
  for (;;) {
    const bool replaces = transmitted(site).has_value() && happens(random, 0.4);
    WildLaw law = replaces ? draw_replacement(random, site) : draw_addition(random, site);
    if (is_known_effect(law)) {
      continue;
    }
    law.scale = scales.of(law.argument, law.factor);
    law.amplitude = replaces ? law.scale : random.log_uniform(0.03, 0.3) * unit_of(site, axis, scales);
    return law;
  }
}

WildLaw resized(const WildLaw& law, double factor) {
  WildLaw other = law;
  if (!law.replaces) {
    other.amplitude *= factor;
    return other;
  }
  // Of what replaces, a larger constant is farther from what it replaces, but for those of a limit.
  other.memory.time *= factor;
  other.memory.frequency /= factor;
  other.memory.limit /= factor;
  // Two rows is the least that a delay remembers, and that is no hold of every row.
  constexpr double kShortestDelay = 4e-3;
  if (law.memory.kind == Kind::delay) {
    other.memory.time = std::max(other.memory.time, kShortestDelay);
  }
  other.memory.rows = std::max(2, static_cast<int>(std::lround(law.memory.rows * factor)));
  for (auto& play : other.memory.plays) {
    play[0] *= factor;
  }
  if (!law.curve.parts.empty()) {
    other.curve.parts[0][0] *= law.curve.shape == Shape::saturation ? 1.0 / factor : factor;
  }
  return other;
}

}  // namespace hotfire::study
