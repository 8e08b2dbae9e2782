// SPDX-License-Identifier: Apache-2.0
#include "tools/structure/vehicle_sensors.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/files/model/key_groups.hpp"
#include "tools/files/model/model_group.hpp"
#include "tools/files/model/toml_text.hpp"

namespace hotfire {

namespace {

constexpr std::string_view kSensors = "sensors";
constexpr std::string_view kStrings = "strings";

Words words_of(const std::vector<std::string>& names) { return {names.begin(), names.end()}; }

std::vector<std::string> numbered(std::string_view name, int count) {
  std::vector<std::string> names;
  for (int k = 1; k <= count; ++k) {
    names.push_back(fmt::format("{}{}", name, k));
  }
  return names;
}

/// A string's ends on every engine: what is said of all, then what is said of one.
void read_ends(const TomlSource& source, const toml::table& table, std::size_t string, VehicleSensors& sensors) {
  const std::vector<std::string> engines = numbered("engine", static_cast<int>(sensors.strings.size()));
  const std::string prefix = fmt::format("{}.string{}.", kStrings, string + 1);
  for (std::size_t e = 0; e < engines.size(); ++e) {
    model::AttachPoints<double>& ends = sensors.strings[e][string];
    read_group(source, table, part_group(ends), prefix, engines.size() > 1 ? words_of(engines) : Words{});
    const toml::node* own = engines.size() > 1 ? table.get(engines[e]) : nullptr;
    if (own != nullptr) {
      const std::string key = prefix + engines[e];
      read_group(source, source.table(*own, key), part_group(ends), key + ".");
    }
  }
}

void read_strings(const TomlSource& source, const toml::table& table, int engines, VehicleSensors& sensors) {
  constexpr std::string_view kPlacement = "placement_error";
  const std::vector<std::string> names = numbered("string", VehicleSensors::Strings::kStrings);
  sensors.strings.assign(static_cast<std::size_t>(engines), VehicleSensors::Strings::representative());
  Words others = words_of(names);
  others.push_back(kPlacement);
  read_group(source, table, part_group(sensors.string), "strings.", others);
  if (const toml::node* node = table.get(kPlacement)) {
    sensors.placement_error = source.number(*node, "strings.placement_error", "m");
    if (!(sensors.placement_error >= 0.0 && sensors.placement_error <= 1.0)) {
      source.refuse(*node, "strings.placement_error", "outside its bounds; allowed: 0 to 1 m");
    }
  }
  for (std::size_t string = 0; string < names.size(); ++string) {
    if (const toml::node* node = table.get(names[string])) {
      read_ends(source, source.table(*node, "strings." + names[string]), string, sensors);
    }
  }
  for (std::size_t e = 0; e < sensors.strings.size(); ++e) {
    if (const std::string_view broken = VehicleSensors::Strings::broken_relation(sensors.strings[e]); !broken.empty()) {
      source.refuse_missing(table, engines == 1 ? "strings" : fmt::format("strings of engine {}", e + 1), broken);
    }
  }
}

/// Lines of a part's table.
template <class Part>
std::string lines_of(Part part) {
  std::string lines;
  append_group(lines, part_group(part));
  return lines;
}

std::string strings_text(const VehicleSensors& sensors) {
  std::string text = fmt::format("\n[{}]\n{}", kStrings, lines_of(sensors.string));
  append_line(text, fmt::format("placement_error = {}", number_text(sensors.placement_error)), "m",
              "rms in each direction between an anchor and where it is drawn");
  for (std::size_t string = 0; string < VehicleSensors::Strings::kStrings; ++string) {
    std::vector<std::string> ends;
    for (const VehicleSensors::Strings::Anchors& engine : sensors.strings) {
      ends.push_back(lines_of(engine[string]));
    }
    const std::string table = fmt::format("{}.string{}", kStrings, string + 1);
    if (std::all_of(ends.begin(), ends.end(), [&](const std::string& lines) { return lines == ends.front(); })) {
      text += fmt::format("\n[{}]\n{}", table, ends.front());
      continue;
    }
    for (std::size_t engine = 0; engine < ends.size(); ++engine) {
      text += fmt::format("\n[{}.engine{}]\n{}", table, engine + 1, ends[engine]);
    }
  }
  return text;
}

}  // namespace

VehicleSensors read_vehicle_sensors(const TomlSource& source, int engines) {
  VehicleSensors sensors;
  if (const toml::node* node = source.root().get(kSensors)) {
    const toml::table& table = source.table(*node, kSensors);
    if (const toml::node* piston = table.get(kPistonSensor)) {
      read_group(source, source.table(*piston, "sensors.piston"), part_group(sensors.piston), "sensors.piston.");
    }
  }
  if (const toml::node* node = source.root().get(kStrings)) {
    read_strings(source, source.table(*node, kStrings), engines, sensors);
  }
  return sensors;
}

std::string vehicle_sensors_text(const VehicleSensors& sensors) {
  std::string text;
  if (const auto& piston = sensors.piston; piston.lag > 0.0 || piston.noise > 0.0 || piston.step > 0.0) {
    text += fmt::format("\n[{}.{}]\n{}", kSensors, kPistonSensor, lines_of(piston));
  }
  return sensors.strings.empty() ? text : text + strings_text(sensors);
}

}  // namespace hotfire
