// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/analysis/chart.hpp"
#include "tools/findings/bench.hpp"

namespace hotfire::findings {

/// The value of a figure that was not reached at all: it lies inside nothing.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// One number that a finding is judged by, and what it must lie between, both included.
struct Figure {
  std::string what;
  double value;
  double lowest;
  double highest;
  std::string unit;

  bool inside() const { return value >= lowest && value <= highest; }
};

/// What one finding came to.
struct Outcome {
  std::vector<Figure> figures;
  analysis::Chart picture;
  std::string note = {};  ///< what a reader must know beside the figures; empty if nothing

  bool inside() const;
};

/// What has to be taken out for a finding to fail, each for itself. A finding without any does not compile.
class Mutants {
 public:
  // Never for a runtime list: an empty one reaches a throw, which is no constant expression.
  consteval Mutants(std::initializer_list<Physics> removed) {  // NOLINT(google-explicit-constructor)
    for (const Physics physics : removed) {
      removed_[count_++] = physics;
    }
    if (count_ == 0) {
      throw "a finding needs a mutant: name the physics that it is about";
    }
  }
  constexpr std::span<const Physics> all() const { return {removed_.data(), count_}; }

 private:
  std::array<Physics, 4> removed_{};
  std::size_t count_ = 0;
};

/// One finding of the papers that the model must find too.
struct Finding {
  std::string_view id;       ///< "F1"
  std::string_view title;    ///< what the papers found
  std::string_view source;   ///< paper and place, "SD eq. 1-2"; empty if the finding is none of the papers'
  std::string_view shown;    ///< when it counts as found
  std::string_view command;  ///< that shows it, beside `hotfire findings`
  Outcome (*find)(const Bench& bench);
  Mutants mutants;
};

/// All of them, in order.
std::span<const Finding> all_findings();

/// A figure within `relative` of `expected`.
Figure near(std::string what, double value, double expected, double relative, std::string unit);

}  // namespace hotfire::findings
