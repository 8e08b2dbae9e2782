// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/linear/harmonic_balance.hpp"

namespace hotfire::linear {

/// A plant in periodic motion at one frequency under given commands, as a function of the signals at its ports: the linear
/// parts move under the signals, and the laws make signals of that motion. The signals are one vector: for every port its
/// mean, and real and imaginary part of every harmonic.
class PeriodicMotion {
 public:
  /// `system` must live as long. `commands` are fundamentals [rad], `harmonics` is how many of each signal count.
  PeriodicMotion(const HarmonicBalance& system, double frequency, int harmonics, const std::vector<Complex>& commands);

  int harmonics() const { return harmonics_; }
  Eigen::Index parts() const { return parts_; }  ///< of a port's signal
  Eigen::Index ports() const { return static_cast<Eigen::Index>(system_.parts().ports().size()); }
  int kind_of(Eigen::Index port) const { return system_.parts().ports()[static_cast<std::size_t>(port)][1]; }

  Eigen::VectorXd signals_of(const std::vector<PortWaves>& ports) const;

  /// What the laws make of the motion under these signals.
  Eigen::VectorXd respond(const Eigen::VectorXd& signals) const { return signals_of(ports_under(motion(signals))); }

  /// The motion under these signals, with its outputs.
  Balance balance(const Eigen::VectorXd& signals) const;

  /// The slopes of `respond(signals) - signals` by the parts `unknowns` of the signals, both in units of `scale`. By
  /// differences: of each axis by its own motion with all axes moved at once, times those of the motion by the signals; or
  /// by each unknown where those are fewer. An axis follows angle and slip of the other axis of its engine too: there the
  /// two are moved one after the other.
  Eigen::MatrixXd slopes(const Eigen::VectorXd& signals, const std::vector<Eigen::Index>& unknowns,
                         const Eigen::VectorXd& scale) const;

 private:
  class Slopes;

  std::vector<AxisWaves> motion(const Eigen::VectorXd& signals) const;
  std::vector<PortWaves> ports_under(const std::vector<AxisWaves>& axes) const {
    return system_.plant().respond(frequency_, harmonics_, axes);
  }
  Eigen::VectorXcd harmonic_of(const Eigen::VectorXd& signals, Eigen::Index m) const;

  const HarmonicBalance& system_;
  double frequency_;
  int harmonics_;
  Eigen::Index parts_;
  std::vector<Complex> commands_;
  std::vector<Answer> answers_{};           ///< one a harmonic
  std::vector<AxisWaves> driven_{};         ///< the commands
  std::vector<Eigen::VectorXcd> acting_{};  ///< commands behind the effects of their site, one a harmonic
};

}  // namespace hotfire::linear
