// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/explain/laws/transformation.hpp"

namespace hotfire::test {

/// A parameter as the finder reports it.
struct Value {
  double value = 0.0;
  double error = 0.0;  ///< standard error; 0 where the data do not determine it
  std::string unit;
};

/// An effect as the finder reports it.
struct Find {
  std::string name;  ///< "unlisted" of a term without one
  std::string law;   ///< of a term its form in words
  std::string site;
};

/// What the finder says of what it was given.
struct Answer {
  std::string verdict;
  std::vector<Find> finds;
  std::map<std::string, Value> values;  ///< "valve_asymmetry.asymmetry", "engine.inertia"
  std::string model;                    ///< as it is written
  double compared = 0.0;                ///< values that fits compare: rows by channels
};

Answer answer_of(const Given& given);

/// What of `transformed` does not follow from `original`, in words; empty: all does.
std::string broken(const Transformation& transformation, const Answer& original, const Answer& transformed);

}  // namespace hotfire::test
