// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace hotfire::test {

/// Two effects of a model file, one of them a table; decimals that no binary number hits.
inline constexpr char kDelayAndTable[] = R"([effects.command_delay]
delay = 0.0123
[effects.soft_stiffness]
law = "table"
load = [0.0, 1234.5, 9876.1]
table_stiffness = [4.1e7, 7.7e7, 1.21e8]
)";

}  // namespace hotfire::test
