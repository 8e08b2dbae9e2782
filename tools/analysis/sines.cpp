// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/sines.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace hotfire::analysis {

namespace {

/// One period of a command between two upward crossings of zero.
struct Cycle {
  double start = 0.0;  ///< [rows]
  double length = 0.0;
  double amplitude = 0.0;
};

std::vector<Cycle> cycles_of(std::span<const double> command) {
  std::vector<double> crossings;
  for (std::size_t k = 1; k < command.size(); ++k) {
    if (command[k - 1] < 0.0 && command[k] >= 0.0) {
      crossings.push_back(static_cast<double>(k - 1) + command[k - 1] / (command[k - 1] - command[k]));
    } else if (command[k - 1] == 0.0 && command[k] > 0.0 &&
               (crossings.empty() || crossings.back() + 1.5 < static_cast<double>(k))) {
      crossings.push_back(static_cast<double>(k - 1));
    }
  }
  std::vector<Cycle> cycles;
  for (std::size_t c = 0; c + 1 < crossings.size(); ++c) {
    const auto from = static_cast<std::ptrdiff_t>(crossings[c]);
    const auto to = std::min(static_cast<std::ptrdiff_t>(crossings[c + 1]) + 1, static_cast<std::ptrdiff_t>(command.size()));
    const auto [least, most] = std::minmax_element(command.begin() + from, command.begin() + to);
    cycles.push_back({crossings[c], crossings[c + 1] - crossings[c], 0.5 * (*most - *least)});
  }
  return cycles;
}

bool alike(const Cycle& a, const Cycle& b) {
  // A crossing between two dwells, where the slope changes, is known to a third of a row.
  return std::abs(a.length - b.length) < 0.004 * a.length + 0.35 && std::abs(a.amplitude - b.amplitude) < 0.02 * a.amplitude;
}

constexpr std::size_t kFewestCycles = 3;

/// Where the frequency changes within cycles that are alike one by one: a quarter of a percent is a fraction of a row a
/// cycle, but adds up over a dwell. The two straight lines through the crossings before and after it must fit them far
/// better than one does. `last` if it does not change.
std::size_t change_within(const std::vector<Cycle>& cycles, std::size_t first, std::size_t last) {
  constexpr double kBetter = 4.0;     // more than a split gains of noise on the crossings
  constexpr double kResolved = 0.05;  // rows rms by which one line must miss: crossings are known no better
  // The first crossing is that of a change of slope.
  const std::size_t count = last - first - 1;
  if (last < first + 2 + 2 * kFewestCycles) {
    return last;
  }
  const double start = cycles[first + 1].start;
  const double length = (cycles[last - 1].start - start) / static_cast<double>(count - 1);
  using Sums = Eigen::Array<double, 6, 1>;  // of 1, k, y, k k, k y, y y
  std::vector<Sums> sums{Sums::Zero()};
  for (std::size_t k = 0; k < count; ++k) {
    const auto x = static_cast<double>(k);
    const double y = cycles[first + 1 + k].start - start - x * length;
    sums.emplace_back(sums.back() + Sums{{1.0, x, y, x * x, x * y, y * y}});
  }
  const auto misfit = [&sums](std::size_t from, std::size_t to) {
    const Sums s = sums[to] - sums[from];
    const double across = s(4) - s(1) * s(2) / s(0);
    return std::max(0.0, s(5) - s(2) * s(2) / s(0) - across * across / (s(3) - s(1) * s(1) / s(0)));
  };
  const double whole = misfit(0, count);
  std::size_t change = last;
  double best = whole / kBetter;
  for (std::size_t k = kFewestCycles; k + kFewestCycles <= count; ++k) {
    const double split = misfit(0, k) + misfit(k, count);
    if (split < best) {
      best = split;
      change = first + 1 + k;
    }
  }
  return whole > static_cast<double>(count) * kResolved * kResolved ? change : last;
}

}  // namespace

std::vector<Dwell> find_dwells(std::span<const double> command, double period) {
  const std::vector<Cycle> cycles = cycles_of(command);
  std::vector<Dwell> dwells;
  for (std::size_t c = 0; c < cycles.size();) {
    std::size_t end = c + 1;
    while (end < cycles.size() && alike(cycles[c], cycles[end])) {
      ++end;
    }
    for (std::size_t change = change_within(cycles, c, end); change < end; change = change_within(cycles, c, end)) {
      end = change;
    }
    if (end - c >= kFewestCycles) {
      // By the crossings inside the dwell alone.
      const double length = (cycles[end - 1].start - cycles[c + 1].start) / static_cast<double>(end - c - 2);
      // The last period of a record has no crossing at its end.
      const double last = cycles[end - 1].start + cycles[end - 1].length;
      const bool one_more = end == cycles.size() && last + 0.97 * length < static_cast<double>(command.size());
      const double periods = static_cast<double>(end - c) + (one_more ? 1.0 : 0.0);
      Dwell dwell;
      dwell.first = static_cast<std::size_t>(std::ceil(cycles[c].start));
      dwell.frequency = 1.0 / (length * period);
      dwell.rows = std::min(static_cast<std::size_t>(periods * length), command.size() - dwell.first);
      dwell.amplitude = cycles[c + 1].amplitude;
      dwells.push_back(dwell);
    }
    c = end;
  }
  return dwells;
}

Fundamental fit_sine(std::span<const double> signal, std::size_t first, std::size_t rows, double frequency, double period) {
  Eigen::MatrixXd basis(static_cast<Eigen::Index>(rows), 4);
  Eigen::VectorXd values(static_cast<Eigen::Index>(rows));
  for (Eigen::Index k = 0; k < basis.rows(); ++k) {
    const double time = static_cast<double>(first + static_cast<std::size_t>(k)) * period;
    const double angle = 2.0 * std::numbers::pi * frequency * time;
    basis.row(k) << 1.0, static_cast<double>(k) / static_cast<double>(rows) - 0.5, std::cos(angle), std::sin(angle);
    values(k) = signal[first + static_cast<std::size_t>(k)];
  }
  const Eigen::Matrix4d normal = basis.transpose() * basis;
  const Eigen::Vector4d fitted = normal.ldlt().solve(basis.transpose() * values);
  const Eigen::VectorXd moving = values - basis.leftCols<2>() * fitted.head<2>();
  const double power = moving.squaredNorm();
  const double left = (values - basis * fitted).squaredNorm();
  return {{fitted(2), -fitted(3)}, power > 0.0 ? std::max(0.0, 1.0 - left / power) : 0.0};
}

std::vector<AmplitudeResponse> sine_responses(std::span<const double> command, std::span<const double> output, double period,
                                              const std::vector<Dwell>& dwells) {
  std::vector<AmplitudeResponse> responses;
  for (const Dwell& dwell : dwells) {
    const double length = 1.0 / (dwell.frequency * period);
    const auto periods = static_cast<int>(static_cast<double>(dwell.rows) / length + 0.01);
    const int used = std::max(1, periods / 2);
    const auto rows = static_cast<std::size_t>(used * length);
    const std::size_t first = dwell.first + dwell.rows - rows;
    const Fundamental asked = fit_sine(command, first, rows, dwell.frequency, period);
    const Fundamental given = fit_sine(output, first, rows, dwell.frequency, period);
    auto own = std::find_if(responses.begin(), responses.end(), [&](const AmplitudeResponse& response) {
      return std::abs(response.amplitude - dwell.amplitude) < 0.02 * dwell.amplitude;
    });
    if (own == responses.end()) {
      own = responses.insert(responses.end(), {dwell.amplitude, {}});
    }
    own->response.push_back({dwell.frequency, given.amplitude / asked.amplitude, given.explained});
  }
  std::sort(responses.begin(), responses.end(), [](const auto& a, const auto& b) { return a.amplitude < b.amplitude; });
  for (AmplitudeResponse& own : responses) {
    std::sort(own.response.begin(), own.response.end(),
              [](const ResponsePoint& a, const ResponsePoint& b) { return a.frequency < b.frequency; });
  }
  return responses;
}

}  // namespace hotfire::analysis
