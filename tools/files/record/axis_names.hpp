// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hotfire {

/// The tables that may declare an axis of a model of several, from general to particular: pitch, then pitch2.
std::vector<std::string> tables_of_axis(int axis, int engines);

/// The names of the axes in order, as channels end and tables are named: pitch, yaw for one engine; pitch1, yaw1, pitch2 ...
std::vector<std::string> axis_names(int engines);

/// The name of a channel without its axis, engine or direction: "command" of "command.pitch".
inline std::string_view own_name(std::string_view channel) { return channel.substr(0, channel.find('.')); }

/// The key of one axis: "engine.pitch.inertia" of "engine.inertia".
std::string key_of_axis(const std::string& key, const std::string& axis);

}  // namespace hotfire
