// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace hotfire::loop {

using Complex = std::complex<double>;
inline constexpr double kTurn = 2.0 * std::numbers::pi;  ///< [rad]

/// A second-order section of a sampled filter: y(k) = b0 x(k) + b1 x(k-1) + b2 x(k-2) - a1 y(k-1) - a2 y(k-2).
struct Section {
  std::array<double, 3> b{1.0, 0.0, 0.0};
  std::array<double, 2> a{0.0, 0.0};
};

/// A point of a measured controller: from attitude to command.
struct MeasuredPoint {
  double frequency = 0.0;  ///< [Hz]
  double log_gain = 0.0;   ///< natural logarithm of command over attitude
  double phase = 0.0;      ///< [rad], continued
};

/// A flight-control law about one axis of the vehicle. At every sample
///   command = - filters(gain attitude + rate_gain attitude_rate + integral_gain integral of attitude),
/// which acts `delay` later and is held for a period. Each filter is an analogue one by the bilinear rule, its own frequency
/// kept.
struct Controller {
  std::filesystem::path path;
  std::string name;
  std::string axis;            ///< "pitch" or "yaw": of all engines
  double period = 0.02;        ///< between samples [s]
  double delay = 0.0;          ///< from a sample to its command [s]
  std::string delay_at{};      ///< where its file says so, for a message
  double gain = 0.0;           ///< [rad/rad]
  double rate_gain = 0.0;      ///< [s]
  double integral_gain = 0.0;  ///< [1/s]
  std::vector<Section> sections{};
  std::vector<MeasuredPoint> measured{};  ///< in place of gains and filters; ascending

  bool is_measured() const { return !measured.empty(); }

  /// Minus the command for attitude and rate of these phasors at a frequency [Hz]; without hold and delay. Of a measured
  /// controller between its points, logarithm of gain and phase linear in the logarithm of the frequency, and beyond its
  /// points those of the nearest.
  Complex response(double frequency, Complex attitude, Complex rate) const;

  /// The law from sample to sample, of a controller that is not measured: w+ = a w + b y, command = -(c w + d y) with
  /// y = (attitude, rate).
  struct Law {
    Eigen::MatrixXd a;
    Eigen::MatrixXd b;
    Eigen::RowVectorXd c;
    Eigen::RowVector2d d;
  };
  Law law() const;
};

/// Reads and checks the file of a controller (docs/analysis/loop.md). Throws FileError naming file, line, key, value and
/// what is allowed.
Controller load_controller(const std::filesystem::path& path);

}  // namespace hotfire::loop
