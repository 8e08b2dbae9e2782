// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>

namespace hotfire::test {

/// What one benchmark came to, best of its repetitions: what else the machine did only adds.
struct Measured {
  double seconds = 1e300;  ///< of processor time, per iteration
  std::map<std::string, double> counters;
};

/// Collects the runs instead of printing them.
class Collector : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override;

  const std::map<std::string, Measured>& measured() const { return measured_; }

 private:
  std::map<std::string, Measured> measured_;
};

/// The page docs/performance.md, with the tables whose benchmarks ran.
std::string performance_page(const std::map<std::string, Measured>& measured);

}  // namespace hotfire::test
