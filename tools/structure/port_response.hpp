// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "tools/structure/mode_table.hpp"

namespace hotfire {

/// A mode's response per generalised force, 1 / (w_k^2 - w^2 + 2 i zeta w_k w), at a frequency [Hz]; of mode k from 0.
std::complex<double> mode_response(const ModeSet& modes, int k, double frequency);

/// Displacement of every port per force on every port at a frequency [Hz], sum over the modes of phi phi^T times the mode's
/// response, and the residual: a row a displacement, a column a force; units as in `ModeSet::residual`.
Eigen::MatrixXcd port_response(const ModeSet& modes, double frequency);

/// The modal integral of a port up to each mode's frequency, sum of phi^2 / w^2 over the modes up to there [m/N] or
/// [rad/(N m)], in order of frequency. The residual is not part of it. [SD 1]: its reciprocal is the load stiffness.
struct ModalIntegral {
  std::vector<double> frequency;    ///< of the modes [Hz], rising
  std::vector<double> flexibility;  ///< up to and with that mode
};
ModalIntegral modal_integral(const ModeSet& modes, int port);

}  // namespace hotfire
