// SPDX-License-Identifier: Apache-2.0
#include "tools/loop/limit_cycle.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace hotfire::loop {

namespace {

/// The slopes of the logarithm of a loop by the logarithms of frequency and amplitude, by differences.
struct Slopes {
  Complex at;
  Complex by_frequency;
  Complex by_amplitude;
};

std::optional<Slopes> slopes_at(const DescribedLoop& loop, double frequency, double amplitude) {
  constexpr double kStep = 2e-3;  // far above the rest of a balance, far below what bends a describing function
  const auto at = loop(frequency, amplitude);
  const auto higher = loop(frequency * (1.0 + kStep), amplitude);
  const auto larger = loop(frequency, amplitude * (1.0 + kStep));
  if (!at || !higher || !larger) {
    return {};
  }
  return Slopes{*at, std::log(*higher / *at) / kStep, std::log(*larger / *at) / kStep};
}

/// From a start near it.
std::optional<LimitCycle> refined(const DescribedLoop& loop, double frequency, double amplitude) {
  constexpr int kMostRounds = 12;
  constexpr double kDone = 1e-4;     // relative, of the loop
  constexpr double kFurthest = 0.2;  // logarithm of frequency or amplitude, in one round
  for (int round = 0; round < kMostRounds; ++round) {
    const auto slopes = slopes_at(loop, frequency, amplitude);
    if (!slopes) {
      return {};
    }
    const Complex rest = std::log(-slopes->at);
    if (std::abs(rest) < kDone) {
      const double sense = (slopes->by_amplitude * std::conj(slopes->by_frequency)).imag();
      return LimitCycle{frequency, amplitude, sense < 0.0};
    }
    Eigen::Matrix2d matrix;
    matrix << slopes->by_frequency.real(), slopes->by_amplitude.real(), slopes->by_frequency.imag(),
        slopes->by_amplitude.imag();
    Eigen::Vector2d change = matrix.partialPivLu().solve(Eigen::Vector2d(-rest.real(), -rest.imag()));
    change *= std::min(1.0, kFurthest / std::max(change.lpNorm<Eigen::Infinity>(), 1e-300));
    frequency *= std::exp(change(0));
    amplitude *= std::exp(change(1));
  }
  return {};
}

/// Mean frequency between rising crossings of the mean; 0 with fewer than two whole cycles.
double frequency_of(std::span<const double> samples, double period) {
  double mean = 0.0;
  for (const double own : samples) {
    mean += own / static_cast<double>(samples.size());
  }
  const double size = std::accumulate(samples.begin(), samples.end(), 0.0,
                                      [&](double most, double own) { return std::max(most, std::abs(own - mean)); });
  // A crossing counts once the signal was well below the mean: noise of a slow passage is none.
  const double below = 0.2 * size;
  double first = 0.0;
  double last = 0.0;
  int count = 0;
  bool armed = false;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    armed = armed || samples[k - 1] < mean - below;
    if (armed && samples[k - 1] < mean && samples[k] >= mean) {
      last = static_cast<double>(k) - (samples[k] - mean) / (samples[k] - samples[k - 1]);
      first = count == 0 ? last : first;
      ++count;
      armed = false;
    }
  }
  return count < 3 ? 0.0 : (count - 1) / ((last - first) * period);
}

/// The size of the sine of a frequency in samples, beside their mean and their trend: least squares.
double fundamental_of(std::span<const double> samples, double period, double frequency) {
  const auto count = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd basis(count, 4);
  Eigen::VectorXd values(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double angle = kTurn * frequency * period * static_cast<double>(k);
    basis.row(k) << 1.0, static_cast<double>(k) / static_cast<double>(count), std::cos(angle), std::sin(angle);
    values(k) = samples[static_cast<std::size_t>(k)];
  }
  const Eigen::Vector4d fit = (basis.transpose() * basis).ldlt().solve(basis.transpose() * values);
  return std::hypot(fit(2), fit(3));
}

/// Half of the range of samples.
double half_range(std::span<const double> samples) {
  const auto [least, most] = std::minmax_element(samples.begin(), samples.end());
  return 0.5 * (*most - *least);
}

/// A frequency [Hz] and an amplitude [rad] where the search for a cycle starts.
struct Start {
  double frequency = 0.0;
  double amplitude = 0.0;
};

/// Where a gain margin of the same branch passes 0 dB between two amplitudes.
void add_crossings(const MarginsAt& smaller, const MarginsAt& larger, std::vector<Start>& starts) {
  constexpr double kSameBranch = 0.35;  // logarithm of the frequencies of two neighbouring amplitudes
  for (const GainMargin& own : larger.margins.gain) {
    for (const GainMargin& before : smaller.margins.gain) {
      const double apart = std::log(own.frequency / before.frequency);
      if (std::abs(apart) < kSameBranch && (before.decibels > 0.0) != (own.decibels > 0.0)) {
        const double share = before.decibels / (before.decibels - own.decibels);
        starts.push_back({before.frequency * std::exp(share * apart),
                          smaller.amplitude * std::pow(larger.amplitude / smaller.amplitude, share)});
      }
    }
  }
}

/// Margins where the search for a cycle starts: those near 0, and those that pass it.
std::vector<Start> starts_of(const std::vector<MarginsAt>& at) {
  constexpr double kNearDecibels = 3.0;
  constexpr double kNearDegrees = 20.0;
  std::vector<Start> starts;
  const MarginsAt* before = nullptr;
  for (const MarginsAt& own : at) {
    if (!(own.amplitude > 0.0)) {
      continue;
    }
    for (const PhaseMargin& margin : own.margins.phase) {
      if (std::abs(margin.degrees) < kNearDegrees) {
        starts.push_back({margin.frequency, own.amplitude});
      }
    }
    for (const GainMargin& margin : own.margins.gain) {
      if (std::abs(margin.decibels) < kNearDecibels) {
        starts.push_back({margin.frequency, own.amplitude});
      }
    }
    if (before != nullptr) {
      add_crossings(*before, own, starts);
    }
    before = &own;
  }
  return starts;
}

/// True if another start led to the same cycle.
bool is_among(const std::vector<LimitCycle>& cycles, const LimitCycle& cycle) {
  constexpr double kSame = 0.02;  // logarithm
  return std::any_of(cycles.begin(), cycles.end(), [&](const LimitCycle& own) {
    return std::abs(std::log(own.amplitude / cycle.amplitude)) < kSame &&
           std::abs(std::log(own.frequency / cycle.frequency)) < kSame;
  });
}

}  // namespace

std::vector<LimitCycle> predicted_limit_cycles(const DescribedLoop& loop, const std::vector<MarginsAt>& at) {
  constexpr double kBeyond = 2.0;  // factor by which a cycle may be beyond the amplitudes that are given
  std::vector<LimitCycle> cycles;
  for (const auto& [frequency, amplitude] : starts_of(at)) {
    const std::optional<LimitCycle> cycle = refined(loop, frequency, amplitude);
    if (cycle && cycle->amplitude < kBeyond * at.back().amplitude && !is_among(cycles, *cycle)) {
      cycles.push_back(*cycle);
    }
  }
  return cycles;
}

Oscillation oscillation_of(const std::vector<double>& samples, double period, double floor) {
  const std::size_t third = samples.size() / 3;
  const std::span<const double> all(samples);
  const std::span<const double> before = all.subspan(third, third);
  const std::span<const double> last = all.subspan(2 * third);
  constexpr double kSteady = 0.02;  // change of the size from one third to the next
  constexpr double kLeaving = 0.2;
  Oscillation found;
  const double size = half_range(last);
  const double growth = size / std::max(half_range(before), 1e-300) - 1.0;
  if (!std::isfinite(size)) {
    found.outcome = Outcome::grows;
    return found;
  }
  if (size < floor) {
    found.outcome = Outcome::decays;
    return found;
  }
  found.frequency = frequency_of(last, period);
  found.amplitude = found.frequency > 0.0 ? fundamental_of(last, period, found.frequency) : size;
  if (std::abs(growth) < kSteady && found.frequency > 0.0) {
    found.outcome = Outcome::oscillates;
  } else if (growth > kLeaving) {
    found.outcome = Outcome::grows;
  } else if (growth < -kLeaving) {
    found.outcome = Outcome::decays;
  }
  return found;
}

}  // namespace hotfire::loop
