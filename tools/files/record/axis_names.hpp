// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace hotfire {

/// The tables that may declare an axis of a model of several, from general to particular: pitch, then pitch2.
std::vector<std::string> tables_of_axis(int axis, int engines);

/// The names of the axes in order, as channels end and tables are named: pitch, yaw for one engine; pitch1, yaw1, pitch2 ...
std::vector<std::string> axis_names(int engines);

}  // namespace hotfire
