// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/structure/mode_table.hpp"

namespace hotfire {

/// What a reduction is asked for.
struct ReductionGoal {
  double lowest = 1.0;    ///< band [Hz]
  double highest = 20.0;  ///< [Hz]
  double error = 0.01;    ///< of the in-band response, relative, at every attach point
  int most = 40;          ///< modes
};

/// A reduced set, and how far its response is from that of the full one.
struct Reduction {
  ModeSet modes;
  std::vector<int> kept;      ///< rows of the full set, from 0, ascending
  std::vector<double> error;  ///< of each attach point: rms over the band of the difference over rms of the response
  double static_error = 0.0;  ///< largest difference of the static flexibility over its size

  bool reaches(const ReductionGoal& goal) const;
};

/// Static flexibility of the ports: sum over the modes of phi phi^T / w^2, and the residual.
Eigen::MatrixXd static_flexibility(const ModeSet& modes);

/// Motion of the strings at rest per force on the ports, in the same way; no row for a set without strings.
Eigen::MatrixXd static_string_motion(const ModeSet& modes);

/// Keeps the fewest modes with which the response of every attach point to its own force stays within the goal's error in
/// its band, but no more than the goal's number. Modes are ranked by the largest share that their dynamics (response less
/// static flexibility) have in the band's response of any attach point; the static flexibility of those that are cut goes
/// into the residual, so that at rest nothing changes, strings included. Of a stage in flight the rigid-body modes are kept,
/// and a mode that is cut no longer moves the attitude. The response is taken on a grid that has every
/// resonance in it. Throws UsageError for a goal that is none.
Reduction reduce(const ModeSet& full, const ReductionGoal& goal);

}  // namespace hotfire
