// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "tools/explain/result/result.hpp"

namespace hotfire::explain {

/// report.json (docs/report.md) of a result, without the keys that only the caller knows (command line, seconds, version,
/// digests).
nlohmann::json report_json(const Result& result);

}  // namespace hotfire::explain
