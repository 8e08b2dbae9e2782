// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/analysis/frequency_response.hpp"
#include "tools/linear/linear_parts.hpp"
#include "tools/linear/plant/plant.hpp"

namespace hotfire::linear {

/// How the search for a balance moved last, where a search nearby begins: the parts of a port signal, the sizes of the
/// signals, which of their parts are unknown, and the inverse of the search's matrix in parts of these sizes.
struct SearchSlopes {
  Eigen::Index parts;
  Eigen::VectorXd scale;
  std::vector<Eigen::Index> unknowns;
  Eigen::MatrixXd inverse;
};

/// A periodic motion of a plant on which its linear parts and its nonlinear laws agree, harmonic by harmonic.
struct Balance {
  double frequency = 0.0;  ///< [Hz]
  int harmonics = 0;
  std::vector<Complex> commands;  ///< what drives it: the fundamental of every axis's held command [rad]
  std::vector<AxisWaves> axes;    ///< deviations from rest
  std::vector<PortWaves> ports;   ///< what the nonlinear laws put in
  std::vector<Complex> outputs;   ///< fundamentals, in the order of the map
  std::shared_ptr<const SearchSlopes> slopes;
};

/// The describing functions of a plant under sines of its commands [Gelb and Vander Velde 1968, Multiple-Input Describing
/// Functions, ch. 2], with higher harmonics: harmonic balance by alternating frequency and time [Cameron and Griffin 1989,
/// J. Appl. Mech. 56, 149-154]. Every law gives the mean and the first harmonics (`Plant::harmonics`) of what the model's
/// own code makes of a periodic motion; the linear parts answer each harmonic. The describing function is the fundamental of
/// an output over that of the command. A balance of few harmonics comes first, and is where the search for that of all
/// starts.
class HarmonicBalance {
 public:
  /// The plant must live as long. Throws what `reduced` throws.
  explicit HarmonicBalance(const Plant& plant);

  const Plant& plant() const { return plant_; }
  const LinearParts& parts() const { return parts_; }

  /// Motion under constant port signals: `kMotionRows` rows an axis, a column a port.
  const Eigen::MatrixXd& motion_at_rest() const { return at_rest_; }

  /// The balance under sines of the commands [rad] at `frequency` [Hz]; `near` is one nearby, where the search starts.
  /// Nothing if the search does not find one.
  std::optional<Balance> solve(double frequency, const std::vector<Complex>& commands, const Balance* near = nullptr) const;

  /// By how much a balance may be off: a port's signal against what the laws give, relative.
  static constexpr double kBalanced = 1e-3;

 private:
  const Plant& plant_;
  LinearParts parts_;
  Eigen::MatrixXd at_rest_;
};

/// What a delay [s] makes of a sine of `frequency` [Hz].
Complex delay_factor(double frequency, double delay);

/// What a command held over `period`, in steps of `step`, has of a sine's fundamental at the middle of a step: the hold's
/// lag.
Complex hold_factor(double frequency, double period, double step);

/// What a command to one axis does at one amplitude, frequency by frequency, by describing functions.
struct DescribedResponse {
  double amplitude = 0.0;                                      ///< of the command [rad]
  std::map<std::string, analysis::FrequencyResponse> outputs;  ///< of each that is wanted, where a balance was found
  std::vector<Balance> balances;                               ///< in the order of `frequencies` that have one
  std::vector<double> without;                                 ///< frequencies at which none was found [Hz]
};

/// Of a command of `axis` with `amplitude` [rad] that is held over `period` [s], as a sweep at this period measures it: the
/// outputs relative to the command. Each frequency starts from the balance of the one before.
DescribedResponse described_response(const HarmonicBalance& system, int axis, double amplitude, double period,
                                     const std::vector<double>& frequencies, const std::vector<std::string>& outputs);

}  // namespace hotfire::linear
