// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iostream>
#include <nlohmann/json.hpp>

namespace hotfire {

/// Prints the result of a command. A byte of a file name that is not UTF-8 is replaced.
inline void print_json(const nlohmann::ordered_json& result) {
  std::cout << result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
}

}  // namespace hotfire
