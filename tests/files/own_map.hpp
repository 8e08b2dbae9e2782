// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/files/can/can_map.hpp"

namespace hotfire::test {

/// The map of the project's own frames. Read before the first test: it stays, and regular expressions keep what is theirs.
inline const CanMap& own_map = own_can_map();

}  // namespace hotfire::test
