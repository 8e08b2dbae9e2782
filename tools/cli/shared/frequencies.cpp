// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/shared/frequencies.hpp"

#include <fmt/format.h>

#include "tools/files/text/error.hpp"
#include "tools/trials/profiles.hpp"

namespace hotfire {

void Frequencies::require_band() const {
  if (!(from < to)) {
    throw UsageError(fmt::format("--from {:g} --to {:g}: no band; allowed: --from below --to", from, to));
  }
}

std::vector<double> Frequencies::spaced() const {
  require_band();
  return trials::spaced(from, to, count);
}

void add_frequencies(CLI::App& command, Frequencies& frequencies, const std::string& of, const AllowedFrequencies& allowed) {
  const CLI::Range range(allowed.lowest, allowed.highest);
  command.add_option("--from", frequencies.from, fmt::format("lowest frequency of {} [Hz]", of))
      ->check(range)
      ->capture_default_str();
  command.add_option("--to", frequencies.to, fmt::format("highest frequency of {} [Hz]", of))
      ->check(range)
      ->capture_default_str();
  command.add_option("--count", frequencies.count, "number of frequencies, at equal ratios")
      ->check(CLI::Range(2, allowed.most))
      ->capture_default_str();
}

}  // namespace hotfire
