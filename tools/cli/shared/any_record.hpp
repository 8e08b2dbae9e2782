// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "tools/files/can/candump.hpp"
#include "tools/files/import/foreign.hpp"

namespace hotfire {

/// A record in any format that it can have: CSV, a recording, a candump log, MDF, HDF5, MATLAB.
inline Record load_any_record(const std::filesystem::path& path, const CandumpOptions& candump = {},
                              const std::vector<DropOut>& drop_outs = {}) {
  return is_foreign(path) ? load_foreign(path) : load_record_or_log(path, candump, drop_outs);
}

}  // namespace hotfire
