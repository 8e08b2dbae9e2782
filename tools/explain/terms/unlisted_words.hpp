// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/explain/terms/candidates.hpp"

namespace hotfire::explain {

/// A fitted table: what is found of a term of unknown law.
struct FittedTable {
  std::string x_name;
  std::string x_unit;
  std::string y_name;
  std::string y_unit;
  std::string meaning;
  std::vector<double> x;
  std::vector<double> y;
};

/// The table of a term of the grammar with the quantity, the unit and the meaning that the term gives its axes; any other
/// as it is.
FittedTable with_own_axes(FittedTable table, const Candidate& candidate);

/// What a table looks like in words: its size, whether it is odd, even or constant, rises or falls, jumps about zero.
std::string in_words(const FittedTable& table);

/// The same of a term of unknown law without a table. Empty for one that has a table.
std::string law_in_words(const Candidate& candidate);

/// The width of a power, which no fit moves, as the end of that clause: " with a width of 0.02 m/s". Empty for other terms.
std::string width_in_words(const ModelParameters& parameters, const Candidate& candidate);

/// What a term of unknown law depends on, as a clause: "that depends on load pressure", "that is a sinusoid over time".
std::string dependence_in_words(const Candidate& candidate);

}  // namespace hotfire::explain
