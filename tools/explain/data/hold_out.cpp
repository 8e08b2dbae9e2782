// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/hold_out.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/explain/data/statistics.hpp"

namespace hotfire::explain {

namespace {

constexpr double kBlockSeconds = 4.0;
constexpr std::size_t kFewestBlocks = 8;
constexpr std::size_t kHoldOutEvery = 4;
/// A rate is the change over this share of a block: longer than a sample's noise shows, shorter than a motion lasts.
constexpr std::size_t kRatesInBlock = 200;
/// Rows that a fit sees reach an extreme where they come this close to it, as a share of the range.
constexpr double kReached = 0.05;

/// True if the values of a quantity come as close to both ends of `whole` as a fit needs.
bool reaches_over(const Extent& extent, const Extent& whole) {
  const double margin = kReached * (whole.high - whole.low);
  return !(extent.low > whole.low + margin) && !(extent.high < whole.high - margin);
}

struct CutBlock {
  Block rows;
  std::vector<Extent> ranges;  ///< of every quantity: value and rate of the input and of each channel
  bool is_held = false;
};

bool is_in(const std::vector<Block>& blocks, std::size_t row) {
  return std::ranges::any_of(blocks, [&](const Block& block) { return row >= block.first && row < block.last; });
}

std::vector<Extent> ranges_of(const Experiment& experiment, Block rows) {
  std::vector<Extent> ranges;
  const std::size_t span = std::max<std::size_t>(1, (rows.last - rows.first) / kRatesInBlock);
  const auto add = [&](const std::vector<double>& values) {
    Extent value;
    Extent rate;
    for (std::size_t row = rows.first; row < rows.last && !values.empty(); ++row) {
      if (is_in(experiment.excluded, row)) {
        continue;
      }
      value.take(values[row]);
      if (row >= rows.first + span && !is_in(experiment.excluded, row - span)) {
        rate.take((values[row] - values[row - span]) / (static_cast<double>(span) * experiment.period));
      }
    }
    ranges.push_back(value);
    ranges.push_back(rate);
  };
  add(experiment.input);
  for (const std::vector<double>& channel : experiment.measured) {
    add(channel);
  }
  return ranges;
}

std::vector<CutBlock> cut(const Experiment& experiment, std::size_t shift) {
  const std::size_t rows = experiment.rows();
  const auto wanted = static_cast<std::size_t>(std::lround(static_cast<double>(rows) * experiment.period / kBlockSeconds));
  const std::size_t count = std::max(kFewestBlocks, wanted);
  std::vector<CutBlock> blocks;
  for (std::size_t block = 0; block < count; ++block) {
    const Block part{rows * block / count, rows * (block + 1) / count};
    blocks.push_back({part, ranges_of(experiment, part), (block + shift) % kHoldOutEvery == 2 && block > 0});
  }
  return blocks;
}

using Cuts = std::vector<std::vector<CutBlock>>;

/// A held-out block that reaches where no block that is fitted does.
std::optional<std::pair<std::size_t, std::size_t>> uncovered(const Cuts& cuts) {
  const std::size_t quantities = cuts.front().front().ranges.size();
  for (std::size_t q = 0; q < quantities; ++q) {
    Extent whole;
    Extent fitted;
    for (const auto& blocks : cuts) {
      for (const CutBlock& block : blocks) {
        whole.take(block.ranges[q]);
        if (!block.is_held) {
          fitted.take(block.ranges[q]);
        }
      }
    }
    if (!(whole.high > whole.low) || reaches_over(fitted, whole)) {
      continue;
    }
    const bool at_high = fitted.high < whole.high - kReached * (whole.high - whole.low);
    for (std::size_t e = 0; e < cuts.size(); ++e) {
      for (std::size_t b = 0; b < cuts[e].size(); ++b) {
        const Extent& own = cuts[e][b].ranges[q];
        if (cuts[e][b].is_held && (at_high ? own.high >= whole.high : own.low <= whole.low)) {
          return std::pair(e, b);
        }
      }
    }
  }
  return std::nullopt;
}

/// True if of all blocks that are fitted this one alone reaches an extreme.
bool is_needed(const Cuts& cuts, const CutBlock& wanted) {
  for (std::size_t q = 0; q < wanted.ranges.size(); ++q) {
    Extent whole;
    Extent others;
    for (const auto& blocks : cuts) {
      for (const CutBlock& block : blocks) {
        whole.take(block.ranges[q]);
        if (!block.is_held && &block != &wanted) {
          others.take(block.ranges[q]);
        }
      }
    }
    if (whole.high > whole.low && !reaches_over(others, whole)) {
      Extent with = others;
      with.take(wanted.ranges[q]);
      if (with.low < others.low || with.high > others.high) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

void hold_out(std::vector<Experiment>& experiments) {
  Cuts cuts;
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    cuts.push_back(cut(experiments[e], e));
  }
  // Each turn moves what is held out to a later block or takes it away, so that turns come to an end.
  while (const auto missing = uncovered(cuts)) {
    const auto [e, b] = *missing;
    cuts[e][b].is_held = false;
    for (std::size_t next = b + 1; next < cuts[e].size(); ++next) {
      if (!cuts[e][next].is_held && !is_needed(cuts, cuts[e][next])) {
        cuts[e][next].is_held = true;
        break;
      }
    }
  }
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    for (const CutBlock& block : cuts[e]) {
      if (block.is_held) {
        experiments[e].held_out.push_back(block.rows);
      }
    }
  }
}

}  // namespace hotfire::explain
