// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/analysis/chart.hpp"
#include "tools/disperse/dispersion.hpp"

namespace hotfire::disperse {

/// One number that the command gave, over all draws.
struct Quantity {
  std::string name;            ///< its path in the command's JSON, or `record.CHANNEL.greatest`
  double declared = 0.0;       ///< of the declared model
  std::vector<double> values;  ///< by draw from 1; not a number where there is none
};

/// What is reported of a dispersion.
struct ReportGoal {
  std::vector<std::string> quantities = {};  ///< names with * for any text; empty: all, without long lists
  std::vector<double> percentiles{1.0, 5.0, 50.0, 95.0, 99.0};
};

/// Results of a dispersion that is complete, ready to be written.
class DispersionReport {
 public:
  /// Throws UsageError if a name of the goal fits no quantity.
  DispersionReport(const Dispersion& dispersion, ReportGoal goal);

  const std::vector<Quantity>& quantities() const { return quantities_; }

  /// Draws whose command failed.
  int failed() const { return failed_; }

  /// A row a draw, the declared model as draw 0: exit status, what each tolerance gives, every quantity. Bits depend on the
  /// draws alone.
  std::string table() const;

  /// Statistics, percentiles and rank correlations of every quantity.
  nlohmann::ordered_json json() const;

  /// The same for a reader, without quantities that no draw changes.
  std::string text() const;

  /// Pictures by name of file: values over the share of draws that lie below, with the percentiles, one picture for the
  /// quantities of one kind; and percentiles over time of each channel that was kept.
  std::map<std::string, analysis::Chart> pictures() const;

 private:
  void collect();
  void select();
  analysis::Chart channel_chart(const std::string& channel) const;

  const Dispersion& dispersion_;
  ReportGoal goal_;
  std::vector<Quantity> quantities_;
  std::vector<std::vector<double>> tolerance_values_;  ///< by tolerance, by draw from 0
  int failed_ = 0;
};

}  // namespace hotfire::disperse
