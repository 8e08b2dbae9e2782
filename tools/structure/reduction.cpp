// SPDX-License-Identifier: Apache-2.0
#include "tools/structure/reduction.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "tools/files/text/error.hpp"
#include "tools/structure/port_response.hpp"

namespace hotfire {

namespace {

using Complex = std::complex<double>;

/// Frequencies of a band [Hz], dense where a mode resonates: half-power widths are split into eight.
std::vector<double> frequency_grid(const ModeSet& modes, const ReductionGoal& goal) {
  std::vector<double> grid;
  constexpr int kBackground = 400;
  for (int i = 0; i <= kBackground; ++i) {
    grid.push_back(goal.lowest * std::pow(goal.highest / goal.lowest, static_cast<double>(i) / kBackground));
  }
  for (int k = 0; k < modes.modes(); ++k) {
    const double width = 2.0 * std::max(modes.damping_ratio(k), 1e-4) * modes.frequency(k);
    for (int i = -24; i <= 24; ++i) {
      const double f = modes.frequency(k) + width * i / 8.0;
      if (f >= goal.lowest && f <= goal.highest) {
        grid.push_back(f);
      }
    }
  }
  std::sort(grid.begin(), grid.end());
  grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
  return grid;
}

/// Trapezoidal weights of a grid.
std::vector<double> weights_of(const std::vector<double>& grid) {
  std::vector<double> weights(grid.size(), 0.0);
  for (std::size_t i = 1; i < grid.size(); ++i) {
    weights[i - 1] += 0.5 * (grid[i] - grid[i - 1]);
    weights[i] += 0.5 * (grid[i] - grid[i - 1]);
  }
  return weights;
}

/// A mode's response per generalised force beyond its static one, 1 / (w_k^2 - w^2 + 2 i zeta w_k w) - 1 / w_k^2.
Complex dynamic_part(const ModeSet& modes, int k, double frequency) {
  const double own = 2.0 * std::numbers::pi * modes.frequency(k);
  return mode_response(modes, k, frequency) - 1.0 / (own * own);
}

/// The band's response of every attach point to its own force, and each mode's share of it.
class Band {
 public:
  Band(const ModeSet& full, const ReductionGoal& goal)
      : full_(full), grid_(frequency_grid(full, goal)), weights_(weights_of(grid_)), dynamic_(grid_.size(), full.modes()) {
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      for (int k = 0; k < full.modes(); ++k) {
        dynamic_(static_cast<Eigen::Index>(i), k) = dynamic_part(full, k, grid_[i]);
      }
    }
    const Eigen::MatrixXd at_rest = static_flexibility(full);
    const std::vector<bool> all(static_cast<std::size_t>(full.modes()), true);
    size_.reserve(static_cast<std::size_t>(attach_points()));
    for (int port = 0; port < attach_points(); ++port) {
      size_.push_back(rms(port, all, at_rest(port, port)));
    }
  }

  int attach_points() const { return 2 * full_.engines; }

  /// Largest share of a mode in the response of any attach point.
  double share(int k) const {
    std::vector<bool> alone(static_cast<std::size_t>(full_.modes()), false);
    alone[static_cast<std::size_t>(k)] = true;
    return largest_of(errors(alone));
  }

  /// What is missing in the response of each attach point without the dynamics of the modes that are `cut`.
  std::vector<double> errors(const std::vector<bool>& cut) const {
    std::vector<double> errors;
    errors.reserve(static_cast<std::size_t>(attach_points()));
    for (int port = 0; port < attach_points(); ++port) {
      // A port that nothing moves has no error.
      const double size = size_[static_cast<std::size_t>(port)];
      errors.push_back(size > 0.0 ? rms(port, cut, 0.0) / size : 0.0);
    }
    return errors;
  }

  static double largest_of(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }

 private:
  /// Root of the mean square over the band of `constant` and the dynamics of the modes that are `counted`.
  double rms(int port, const std::vector<bool>& counted, double constant) const {
    Eigen::VectorXcd response = Eigen::VectorXcd::Constant(dynamic_.rows(), constant);
    for (int k = 0; k < full_.modes(); ++k) {
      if (counted[static_cast<std::size_t>(k)]) {
        response += dynamic_.col(k) * (full_.shape(port, k) * full_.shape(port, k));
      }
    }
    double square = 0.0;
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      square += weights_[i] * std::norm(response(static_cast<Eigen::Index>(i)));
    }
    return std::sqrt(square / (grid_.back() - grid_.front()));
  }

  const ModeSet& full_;
  std::vector<double> grid_;
  std::vector<double> weights_;
  Eigen::MatrixXcd dynamic_;  ///< a row a frequency, a column a mode
  std::vector<double> size_;
};

/// Of the modes in flight those of the stage as a rigid body, and `kept` of those that bend it.
FlightModes flight_with(const FlightModes& full, const std::vector<int>& kept) {
  std::vector<Eigen::Index> columns;
  int bending = 0;
  for (Eigen::Index k = 0; k < full.frequency.size(); ++k) {
    const bool is_rigid = !(full.frequency(k) > 0.0);
    if (is_rigid || std::binary_search(kept.begin(), kept.end(), bending)) {
      columns.push_back(k);
    }
    bending += is_rigid ? 0 : 1;
  }
  return {full.frequency(columns), full.damping_ratio(columns), full.side(Eigen::all, columns),
          full.sensor(Eigen::all, columns), full.shape(Eigen::all, columns)};
}

ModeSet with_modes(const ModeSet& full, const std::vector<int>& kept) {
  ModeSet set;
  set.engines = full.engines;
  const auto count = static_cast<Eigen::Index>(kept.size());
  set.frequency.resize(count);
  set.damping_ratio.resize(count);
  set.shape.resize(full.ports(), count);
  set.residual = Eigen::MatrixXd::Zero(full.ports(), full.ports());
  set.string_shape.resize(full.string_shape.rows(), count);
  set.string_residual = Eigen::MatrixXd::Zero(full.string_shape.rows(), full.ports());
  for (Eigen::Index i = 0; i < count; ++i) {
    const int k = kept[static_cast<std::size_t>(i)];
    set.frequency(i) = full.frequency(k);
    set.damping_ratio(i) = full.damping_ratio(k);
    set.shape.col(i) = full.shape.col(k);
    set.string_shape.col(i) = full.string_shape.col(k);
  }
  set.flight = flight_with(full.flight, kept);
  return set;
}

}  // namespace

bool Reduction::reaches(const ReductionGoal& goal) const {
  return modes.modes() <= goal.most && *std::max_element(error.begin(), error.end()) <= goal.error;
}

namespace {

/// Motion at rest of what moves by `shape` under unit forces on the ports, beyond `residual`.
Eigen::MatrixXd at_rest(const ModeSet& modes, const Eigen::MatrixXd& shape, const Eigen::MatrixXd& residual) {
  Eigen::MatrixXd sum = residual;
  for (int k = 0; k < modes.modes(); ++k) {
    const double w = 2.0 * std::numbers::pi * modes.frequency(k);
    sum += shape.col(k) * modes.shape.col(k).transpose() / (w * w);
  }
  return sum;
}

}  // namespace

Eigen::MatrixXd static_flexibility(const ModeSet& modes) { return at_rest(modes, modes.shape, modes.residual); }

Eigen::MatrixXd static_string_motion(const ModeSet& modes) {
  return at_rest(modes, modes.string_shape, modes.string_residual);
}

Reduction reduce(const ModeSet& full, const ReductionGoal& goal) {
  if (!(goal.lowest > 0.0 && goal.highest > goal.lowest) || goal.most < 0 || !(goal.error > 0.0)) {
    throw UsageError("a reduction needs a band above 0 Hz, its lower end first, a number of modes and an error above 0");
  }
  const Band band(full, goal);
  std::vector<double> share(static_cast<std::size_t>(full.modes()));
  std::vector<int> ranked(share.size());
  std::iota(ranked.begin(), ranked.end(), 0);
  for (const int k : ranked) {
    share[static_cast<std::size_t>(k)] = band.share(k);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [&](int a, int b) { return share[static_cast<std::size_t>(a)] > share[static_cast<std::size_t>(b)]; });

  Reduction result;
  std::vector<bool> cut(share.size(), true);
  result.error = band.errors(cut);
  for (std::size_t i = 0;
       i < ranked.size() && static_cast<int>(i) < goal.most && Band::largest_of(result.error) > goal.error; ++i) {
    result.kept.push_back(ranked[i]);
    cut[static_cast<std::size_t>(ranked[i])] = false;
    result.error = band.errors(cut);
  }
  std::sort(result.kept.begin(), result.kept.end());
  result.modes = with_modes(full, result.kept);
  const Eigen::MatrixXd wanted = static_flexibility(full);
  const Eigen::MatrixXd missing = wanted - static_flexibility(result.modes);
  // Symmetric to the last bit, as a flexibility is.
  result.modes.residual = 0.5 * (missing + missing.transpose());
  result.modes.string_residual = static_string_motion(full) - static_string_motion(result.modes);
  result.static_error = (static_flexibility(result.modes) - wanted).cwiseAbs().maxCoeff() / wanted.cwiseAbs().maxCoeff();
  return result;
}

}  // namespace hotfire
