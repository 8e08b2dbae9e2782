// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/data/exclusions.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "tools/explain/words/refusals.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire::explain {

Exclusion exclusion_from(const std::string& text) {
  const auto at = text.rfind('@');
  if (at != std::string::npos) {
    if (const auto stretch = drop_out_from(std::string_view(text).substr(at + 1))) {
      return {text.substr(0, at), *stretch};
    }
  }
  throw UsageError(words::malformed_exclusion(text));
}

void require_known_records(const std::vector<Exclusion>& exclusions, const std::vector<std::string>& names) {
  for (const Exclusion& exclusion : exclusions) {
    if (std::find(names.begin(), names.end(), exclusion.record) == names.end()) {
      throw UsageError(words::unknown_record(exclusion.record, names));
    }
  }
}

std::vector<DropOut> drop_outs_of(const std::vector<Exclusion>& exclusions, const std::string& record) {
  std::vector<DropOut> stretches;
  for (const Exclusion& exclusion : exclusions) {
    if (exclusion.record == record) {
      stretches.push_back(exclusion.stretch);
    }
  }
  return stretches;
}

std::vector<Block> excluded_rows(const Record& record, const std::vector<Exclusion>& exclusions) {
  std::vector<Block> rows;
  for (const Exclusion& exclusion : exclusions) {
    if (exclusion.record != record.name) {
      continue;
    }
    const auto row_at = [&](double time) {
      return static_cast<std::size_t>(
          std::clamp(std::ceil((time - record.start) / record.period - 1e-6), 0.0, static_cast<double>(record.rows)));
    };
    rows.push_back({row_at(exclusion.stretch.from), row_at(exclusion.stretch.to)});
    if (rows.back().first == rows.back().last) {
      throw UsageError(words::no_such_rows(exclusion.record, exclusion.stretch.from, exclusion.stretch.to, record.start,
                                           record.start + static_cast<double>(record.rows - 1) * record.period));
    }
  }
  std::sort(rows.begin(), rows.end(), [](const Block& a, const Block& b) { return a.first < b.first; });
  return rows;
}

std::vector<Block> without(const std::vector<Block>& blocks, const std::vector<Block>& taken) {
  std::vector<Block> rest;
  for (Block block : blocks) {
    for (const Block& hole : taken) {
      if (hole.last <= block.first || hole.first >= block.last) {
        continue;
      }
      if (hole.first > block.first) {
        rest.push_back({block.first, hole.first});
      }
      block.first = std::min(block.last, hole.last);
    }
    if (block.last > block.first) {
      rest.push_back(block);
    }
  }
  return rest;
}

std::vector<double> bridged(std::vector<double> values, const std::vector<Block>& excluded) {
  const std::size_t rows = values.size();
  const std::vector<Block> kept = without({{0, rows}}, excluded);
  for (std::size_t i = 0; i <= kept.size(); ++i) {
    const bool from_start = i == 0;
    const bool to_end = i == kept.size();
    const std::size_t first = from_start ? 0 : kept[i - 1].last;
    const std::size_t last = to_end ? rows : kept[i].first;
    const double before = from_start ? (to_end ? 0.0 : values[last]) : values[first - 1];
    const double after = to_end ? before : values[last];
    for (std::size_t row = first; row < last; ++row) {
      const double share = static_cast<double>(row + 1 - first) / static_cast<double>(last + 1 - first);
      values[row] = before + share * (after - before);
    }
  }
  return values;
}

std::vector<double> kept_rows(const std::vector<double>& values, const std::vector<Block>& excluded) {
  std::vector<double> kept;
  kept.reserve(values.size());
  for (const Block& block : without({{0, values.size()}}, excluded)) {
    kept.insert(kept.end(), values.begin() + static_cast<std::ptrdiff_t>(block.first),
                values.begin() + static_cast<std::ptrdiff_t>(block.last));
  }
  return kept;
}

bool is_missing_somewhere(const Channel& channel) {
  return std::any_of(channel.values.begin(), channel.values.end(), [](double value) { return std::isnan(value); });
}

std::vector<double> held_where_missing(const Channel& command, const Record& record) {
  std::vector<double> held = command.values;
  if (held.empty() || std::isnan(held.front())) {
    throw FileError(words::missing_start(record.path.string(), command.name));
  }
  for (std::size_t row = 1; row < held.size(); ++row) {
    if (std::isnan(held[row])) {
      held[row] = held[row - 1];
    }
  }
  return held;
}

}  // namespace hotfire::explain
