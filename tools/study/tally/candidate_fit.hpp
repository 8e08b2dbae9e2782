// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace hotfire::study {

/// One candidate fitted to all rows of a case, and what it took: the finder's fit by itself, without its search.
struct CandidateFit {
  std::string name;
  std::string candidate;                ///< "gimbal_friction (lugre)"
  double seconds = 0.0;                 ///< of the fit, the records being read
  double processor_seconds = 0.0;       ///< the same of all threads' processor time
  std::map<std::string, double> after;  ///< on the unseen record, rms in sensor noise, by channel
};

/// Fits the declared parameters within their tolerances together with the effect `name` in its law `law` (empty for an
/// effect without laws), from the declared and the typical values. Throws UsageError if there is no such candidate,
/// FileError if the folder is no case of one axis or the start can't be simulated.
CandidateFit fit_candidate(const std::filesystem::path& folder, const std::string& name, const std::string& law,
                           unsigned threads);

nlohmann::json json_of(const CandidateFit& fit);

}  // namespace hotfire::study
