// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/files/record/drop_out.hpp"

namespace hotfire {

/// True for an input of the plant: "command.pitch" holds from a row to the next.
bool is_held_input(std::string_view channel);

/// Columns on an even grid.
struct Resampled {
  double start = 0.0;   ///< [s]
  double period = 0.0;  ///< [s]
  std::vector<std::vector<double>> values;
  std::string note;  ///< what was done, one sentence
};

/// Puts columns that were read at `times` [s] on an even grid of `period` [s], from the first time on.
///
/// A channel that is `held` between its rows, such as a command, becomes its mean over each new period: what the plant was
/// commanded over that time. Any other is first put on the even grid of its mean interval by a natural cubic spline through
/// its samples, if that interval varies by more than a thousandth; then it is reconstructed below 0.45 of the lower of both
/// sampling rates by a sinc of 32 zeros to either side under a Kaiser window of beta = 8 (pass band to 0.41, 80 dB from 0.49
/// on) [Kaiser 1974; Oppenheim and Schafer 1999, sec. 7.4], with the weights at the ends scaled to a sum of one.
///
/// Throws std::invalid_argument, its text to follow the file's name: a time that does not rise, a gap of more than two and a
/// half median intervals, fewer than four rows, a mean interval beyond 100 ms, a value that is not a number, more rows than
/// a record may have.
Resampled resampled(const std::vector<double>& times, const std::vector<std::vector<double>>& columns,
                    const std::vector<bool>& held, double period);

}  // namespace hotfire
