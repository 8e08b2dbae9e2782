// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/analysis/frequency_response.hpp"
#include "tools/linear/harmonic_balance.hpp"
#include "tools/linear/plant/plant.hpp"

namespace hotfire::linear {

/// A linear model of a plant about a point of rest, in continuous time and as the exact steps of a sampled system:
///   x' = A x + B u, y = C x + D u    and    x(k+1) = step_a x(k) + step_b u(k), y(k) = C x(k) + D u(k),
/// with u held over a period. Transport delays are beside the matrices.
struct LinearModel {
  std::string topology;
  std::vector<Quantity> states;
  std::vector<Quantity> inputs;
  std::vector<Quantity> outputs;
  Eigen::MatrixXd a;
  Eigen::MatrixXd b;
  Eigen::MatrixXd c;
  Eigen::MatrixXd d;
  double period = 0.0;  ///< of the sampled system [s]
  Eigen::MatrixXd step_a;
  Eigen::MatrixXd step_b;
  bool by_logarithm = true;  ///< how A and B follow from the model's step (`continuous`)
  std::vector<Delay> delays;
};

/// The exact small deviations from rest.
LinearModel small_signal_model(const Plant& plant, double period);

/// The same with every nonlinear law in its place as a spring and damper that give its first harmonic at a balance of sines:
/// the gain k + i 2 pi f c of its describing function over opening, position, angle, deflection or slip. Exact at the
/// balance's own frequency and amplitude; of a bearing, for the axis that slips more.
LinearModel quasi_linear_model(const HarmonicBalance& system, double period, const Balance& balance);

/// Eigenvalues of A, in order of their size [rad/s].
std::vector<Complex> poles(const LinearModel& model);

/// Place of an input or output by its name. Throws UsageError naming the nearest.
int place_of(const std::vector<Quantity>& quantities, const std::string& name, const std::string& option);

/// Response of an output to an input, delays included. `held`: to an input that is held over a period, as a sweep at this
/// period measures it (exact); otherwise of the continuous model.
Complex response(const LinearModel& model, int output, int input, double frequency, bool held);
analysis::FrequencyResponse response(const LinearModel& model, int output, int input, const std::vector<double>& frequencies,
                                     bool held);

}  // namespace hotfire::linear
