// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/explain/data/block.hpp"
#include "tools/files/record/drop_out.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire::explain {

/// A stretch of a record that its user knows to be wrong, such as a drop-out: simulated, not compared.
struct Exclusion {
  std::string record;  ///< "steps.csv"
  DropOut stretch;     ///< in the record's own time
};

/// "steps.csv@3.0-3.5". Throws UsageError if the text is not of this form.
Exclusion exclusion_from(const std::string& text);

/// Throws UsageError if an exclusion is of none of these records.
void require_known_records(const std::vector<Exclusion>& exclusions, const std::vector<std::string>& names);

/// The stretches of the record of that name.
std::vector<DropOut> drop_outs_of(const std::vector<Exclusion>& exclusions, const std::string& record);

/// The rows of a record that are excluded, ascending. Throws UsageError if there are none in a stretch.
std::vector<Block> excluded_rows(const Record& record, const std::vector<Exclusion>& exclusions);

/// The rows of `blocks` that are in none of `taken`; both ascending.
std::vector<Block> without(const std::vector<Block>& blocks, const std::vector<Block>& taken);

/// A measured channel with a straight line over each excluded stretch: what it read there is not known.
std::vector<double> bridged(std::vector<double> values, const std::vector<Block>& excluded);

/// The values that are in no excluded stretch.
std::vector<double> kept_rows(const std::vector<double>& values, const std::vector<Block>& excluded);

/// Whether a value of a channel is missing.
bool is_missing_somewhere(const Channel& channel);

/// A command as the plant had it: where it is missing it holds. Throws FileError for one that is missing from the start.
std::vector<double> held_where_missing(const Channel& command, const Record& record);

}  // namespace hotfire::explain
