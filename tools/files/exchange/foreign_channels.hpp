// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace hotfire {

/// A channel of another program's file.
struct ForeignChannel {
  std::string name;
  std::string unit;  ///< as the file spells it; empty: it has none
  bool is_time = false;
  std::vector<double> values;
  std::string problem;  ///< why its values are not available; empty: they are. Used only if a map names the channel
};

/// Channels that were sampled together.
struct ForeignGroup {
  std::string name;  ///< empty: it has none
  std::vector<ForeignChannel> channels;
};

}  // namespace hotfire
