// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace hotfire {

/// The options --from, --to and --count of a command: frequencies at equal ratios.
struct Frequencies {
  double from;  ///< [Hz]
  double to;    ///< [Hz]
  int count;

  /// Throws UsageError unless `from` is below `to`.
  void require_band() const;

  /// The frequencies [Hz], after `require_band`.
  std::vector<double> spaced() const;
};

/// What a command takes for its frequencies.
struct AllowedFrequencies {
  double lowest;   ///< [Hz]
  double highest;  ///< [Hz]
  int most;
};

/// Gives a command the options. `of` says what the frequencies are of: "the responses".
void add_frequencies(CLI::App& command, Frequencies& frequencies, const std::string& of, const AllowedFrequencies& allowed);

}  // namespace hotfire
