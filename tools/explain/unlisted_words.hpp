#pragma once

#include <string>
#include <string_view>
#include <vector>

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

/// What a table looks like in words: its size, whether it is odd, even or constant, rises or falls, jumps about zero.
std::string in_words(const FittedTable& table);

/// The same of a term of unknown law without a table, by what it depends on: "periodic", "creep". Empty for any other.
std::string law_in_words(std::string_view depends_on);

}  // namespace hotfire::explain
