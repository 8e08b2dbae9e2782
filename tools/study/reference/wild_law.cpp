// SPDX-License-Identifier: Apache-2.0
#include "tools/study/reference/wild_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hotfire::study {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

double within(double x, double limit) { return std::clamp(x, -limit, limit); }

/// ln(1 + e^x) without overflow.
double soft_plus(double x) { return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))); }

double stairs(double s, double quantum) {
  const double steps = s / quantum;
  const double below = std::floor(steps);
  // The riser is about the middle between two levels.
  const double risen = std::clamp((steps - below - 0.5) / WildCurve::kRiser + 0.5, 0.0, 1.0);
  return quantum * (below + risen * risen * (3.0 - 2.0 * risen));
}

double memory_output(const WildLaw& law, double input, double elapsed, const WildStates& y, const WildRows& rows) {
  const WildMemory& memory = law.memory;
  switch (memory.kind) {
    case WildMemory::Kind::none:
      return input;
    case WildMemory::Kind::delay:
      return rows.begun() ? rows.delayed(elapsed, memory.time) : input;
    case WildMemory::Kind::first_order:
    case WildMemory::Kind::second_order:
    case WildMemory::Kind::rate_limit:
    case WildMemory::Kind::leaky_integral:
      return y[0];
    case WildMemory::Kind::washout:
      return input - y[0];
    case WildMemory::Kind::band_pass:
      return 2.0 * memory.damping * y[1] / (kTurn * memory.frequency);
    case WildMemory::Kind::plays:
    case WildMemory::Kind::stops: {
      double sum = 0.0;
      for (std::size_t i = 0; i < memory.plays.size(); ++i) {
        sum += memory.plays[i][1] * (memory.kind == WildMemory::Kind::plays ? y[i] : input - y[i]);
      }
      return sum;
    }
    case WildMemory::Kind::hold:
      return rows.begun() ? rows.held() : input;
    case WildMemory::Kind::swing:
      return std::sin(y[0]);
  }
  return 0.0;
}

}  // namespace

double WildCurve::operator()(double s) const {
  double sum = 0.0;
  switch (shape) {
    case Shape::line:
      sum = s;
      break;
    case Shape::waves:
      for (const auto& [odd, even, frequency] : parts) {
        sum += odd * std::sin(frequency * s) + even * (1.0 - std::cos(frequency * s));
      }
      break;
    case Shape::bumps:
      for (const auto& [tall, at, width] : parts) {
        sum += tall * (std::exp(-(s - at) * (s - at) / (width * width)) - std::exp(-at * at / (width * width)));
      }
      break;
    case Shape::odd_power:
      sum = std::copysign(std::pow(std::abs(s), parts[0][0]), s);
      break;
    case Shape::even_power:
      sum = std::pow(std::abs(s), parts[0][0]);
      break;
    case Shape::saturation:
      sum = parts[0][0] * std::tanh(s / parts[0][0]);
      break;
    case Shape::dead_zone:
      sum = s - within(s, parts[0][0]);
      break;
    case Shape::one_sided:
      sum = (soft_plus(parts[0][0] * (s - parts[0][1])) - soft_plus(-parts[0][0] * parts[0][1])) / parts[0][0];
      break;
    case Shape::ripple:
      sum = std::sin(parts[0][0] * s + parts[0][1]) - std::sin(parts[0][1]);
      break;
    case Shape::stairs:
      sum = stairs(s, parts[0][0]);
      break;
  }
  return height * sum;
}

std::size_t WildMemory::states() const {
  switch (kind) {
    case Kind::none:
    case Kind::delay:
    case Kind::hold:
      return 0;
    case Kind::second_order:
    case Kind::band_pass:
      return 2;
    case Kind::plays:
    case Kind::stops:
      return plays.size();
    case Kind::first_order:
    case Kind::washout:
    case Kind::rate_limit:
    case Kind::leaky_integral:
    case Kind::swing:
      return 1;
  }
  return 0;
}

double WildLaw::signal(const WildQuantities& quantities) const {
  const double other = factor ? quantities[static_cast<std::size_t>(*factor)] : 1.0;
  return quantities[static_cast<std::size_t>(argument)] * other / scale;
}

void WildRows::begin_row(const WildLaw& law, double start, double input) {
  if (law.memory.kind == WildMemory::Kind::hold && inputs_.size() % static_cast<std::size_t>(law.memory.rows) == 0) {
    held_ = input;
  }
  inputs_.push_back(input);
  if (inputs_.size() > 1) {
    period_ = start / static_cast<double>(inputs_.size() - 1);
  }
}

double WildRows::delayed(double elapsed, double delay) const {
  if (elapsed <= delay || inputs_.size() < 3) {
    return inputs_.front();
  }
  const double at = (elapsed - delay) / period_;
  const auto row = static_cast<std::ptrdiff_t>(at);
  const auto value = [&](std::ptrdiff_t i) {
    return inputs_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, std::ssize(inputs_) - 1))];
  };
  const double x = at - static_cast<double>(row);
  const double a = value(row - 1);
  const double b = value(row);
  const double c = value(row + 1);
  const double d = value(row + 2);
  // Catmull and Rom 1974: cubic through b and c with the slopes of their neighbours.
  return b + 0.5 * x * (c - a + x * (2.0 * a - 5.0 * b + 4.0 * c - d + x * (3.0 * (b - c) + d - a)));
}

double memory_input(const WildLaw& law, double signal) { return law.curve_first ? law.curve(signal) : signal; }

WildStates memory_rates(const WildLaw& law, double input, const WildStates& y) {
  const WildMemory& memory = law.memory;
  WildStates rates{};
  switch (memory.kind) {
    case WildMemory::Kind::none:
    case WildMemory::Kind::delay:
    case WildMemory::Kind::hold:
      break;
    case WildMemory::Kind::first_order:
    case WildMemory::Kind::washout:
      rates[0] = (input - y[0]) / memory.time;
      break;
    case WildMemory::Kind::leaky_integral:
      rates[0] = input - y[0] / memory.time;
      break;
    case WildMemory::Kind::second_order:
    case WildMemory::Kind::band_pass: {
      const double natural = kTurn * memory.frequency;
      rates[0] = y[1];
      rates[1] = natural * natural * (input - y[0]) - 2.0 * memory.damping * natural * y[1];
      break;
    }
    case WildMemory::Kind::plays:
    case WildMemory::Kind::stops:
      for (std::size_t i = 0; i < memory.plays.size(); ++i) {
        const double apart = input - y[i];
        rates[i] = WildMemory::kFollows * (apart - within(apart, memory.plays[i][0]));
      }
      break;
    case WildMemory::Kind::rate_limit:
      rates[0] = within(WildMemory::kFollows * (input - y[0]), memory.limit);
      break;
    case WildMemory::Kind::swing:
      rates[0] = kTurn * memory.frequency * (1.0 + memory.damping * std::tanh(input));
      break;
  }
  return rates;
}

double wild_output(const WildLaw& law, double signal, double elapsed, const WildStates& y, const WildRows& rows) {
  const double remembered = memory_output(law, memory_input(law, signal), elapsed, y, rows);
  const double output = law.curve_first ? remembered : law.curve(remembered);
  return law.amplitude * (law.replaces ? output - signal : output);
}

}  // namespace hotfire::study
