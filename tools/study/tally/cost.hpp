// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hotfire::study {

/// What explaining records of some length took.
struct CostPoint {
  double length = 0.0;             ///< of all records together [s]
  double processor_seconds = 0.0;  ///< of the whole search
  std::string found;               ///< names, joined by " + "
};

/// seconds = fixed + slope * length, by least squares.
struct CostLine {
  double fixed = 0.0;        ///< [s]
  double slope = 0.0;        ///< processor time per time of record
  double correlation = 0.0;  ///< squared, of the points with the line
};
CostLine line_through(const std::vector<CostPoint>& points);

/// Explains the given records of a case, cut to a quarter, a half, three quarters of their length, whole and given twice.
/// Throws FileError if the folder is no case of one axis.
std::vector<CostPoint> cost_by_length(const std::filesystem::path& folder, unsigned threads);

/// A line for each point, and the straight line through them with what it misses.
std::string table_of(const std::vector<CostPoint>& points);

nlohmann::json json_of(const std::vector<CostPoint>& points);

}  // namespace hotfire::study
