#pragma once

#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/analysis/chart.hpp"
#include "tools/files/model/model_file.hpp"

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

/// The shipped parameter sets: representative, tuned to the published frequencies. Each file says which numbers are.
struct Sets {
  std::filesystem::path folder;
  ModelFile lab;
  ModelFile ambient;
  ModelFile hot_fire;
};

/// Reads lab.toml, ambient.toml and hot-fire.toml of a folder. Throws FileError.
Sets load_sets(const std::filesystem::path& folder);

/// One finding of the papers that the model must find too.
struct Finding {
  std::string_view id;       ///< "F1"
  std::string_view title;    ///< what the papers found
  std::string_view shown;    ///< when it counts as found
  std::string_view command;  ///< that shows it, beside `hotfire findings`
  Outcome (*find)(const Sets& sets);
};

/// All of them, in order.
std::span<const Finding> all_findings();

/// A figure within `relative` of `expected`.
Figure near(std::string what, double value, double expected, double relative, std::string unit);

}  // namespace hotfire::findings
