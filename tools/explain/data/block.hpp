// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace hotfire::explain {

/// A stretch of rows [first, last).
struct Block {
  std::size_t first;
  std::size_t last;
};

}  // namespace hotfire::explain
