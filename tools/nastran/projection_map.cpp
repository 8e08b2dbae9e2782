// SPDX-License-Identifier: Apache-2.0
#include "tools/nastran/projection_map.hpp"

#include <fmt/format.h>

#include "tools/files/model/model_group.hpp"
#include "tools/files/text/units.hpp"
#include "tools/structure/mode_table.hpp"

namespace hotfire::nastran {

namespace {

/// Least frequency of a mode if the map gives none [Hz]: rigid bodies come out of a solver with millihertz.
constexpr double kLeastFrequency = 0.1;

class MapReader {
 public:
  explicit MapReader(const TomlSource& source) : source_(source) {}

  ProjectionMap read(const std::filesystem::path& folder) {
    source_.require_schema();
    const toml::table& root = source_.root();
    refuse_unknown_keys(source_, root, "",
                        {"schema", "modes", "geometry", "length", "mass", "least_frequency", "damping", "generalised_mass",
                         "attach", "gimbal", "strings"});
    ProjectionMap map;
    map.modes = folder / source_.text(required(root, "modes", "the file of the eigenvectors, .f06, .pch or .op2"), "modes");
    const toml::node* geometry = root.get("geometry");
    map.geometry = geometry != nullptr ? folder / source_.text(*geometry, "geometry") : map.modes;
    map.length = unit_of("length", "m");
    map.mass = unit_of("mass", "kg");
    const toml::node* least = root.get("least_frequency");
    map.least_frequency = least != nullptr ? source_.number(*least, "least_frequency", "Hz") : kLeastFrequency;
    if (map.least_frequency < 0.0) {
      source_.refuse(*least, "least_frequency", "allowed: at least 0 Hz");
    }
    read_damping(map);
    if (const toml::node* mass = root.get("generalised_mass")) {
      map.generalised_mass = source_.number(*mass, "generalised_mass", "1");
      if (!(*map.generalised_mass > 0.0)) {
        source_.refuse(*mass, "generalised_mass", "allowed: above 0, 1 for vectors that are normalised to mass");
      }
    }
    read_ports(map);
    read_strings(map);
    return map;
  }

 private:
  const toml::node& required(const toml::table& table, const std::string& key, std::string_view what) const {
    const toml::node* node = table.get(key.substr(key.rfind('.') + 1));
    if (node == nullptr) {
      source_.refuse_missing(table, key, fmt::format("missing; {}", what));
    }
    return *node;
  }

  /// The size of a unit of the model in SI.
  double unit_of(const std::string& key, const std::string& wanted) const {
    const toml::node* node = source_.root().get(key);
    if (node == nullptr) {
      return 1.0;
    }
    try {
      return convert_unit(1.0, source_.text(*node, key), wanted);
    } catch (const UnitError& error) {
      source_.refuse(*node, key,
                     fmt::format("{}; allowed: a unit such as \"{}\"", error.what(), wanted == "m" ? "in" : "lbf.s^2/in"));
    }
  }

  void read_damping(ProjectionMap& map) const {
    const toml::node& node = required(source_.root(), "damping", "the damping ratio of every mode, or a list");
    const auto add = [&](const toml::node& own) {
      const double ratio = source_.number(own, "damping", "1");
      if (!(ratio >= 0.0 && ratio < 1.0)) {
        source_.refuse(own, "damping", "allowed: from 0 to below 1");
      }
      map.damping.push_back(ratio);
    };
    const toml::array* list = node.as_array();
    if (list == nullptr) {
      add(node);
      return;
    }
    for (const toml::node& own : *list) {
      add(own);
    }
    if (map.damping.empty()) {
      source_.refuse(node, "damping", "an empty list; allowed: one ratio for each mode that is kept");
    }
  }

  Eigen::Vector3d vector(const toml::node& node, const std::string& key) const {
    const toml::array* list = node.as_array();
    if (list == nullptr || list->size() != 3) {
      source_.refuse(node, key, "allowed: [x, y, z] in the basic system, bare numbers");
    }
    Eigen::Vector3d vector;
    for (std::size_t i = 0; i < 3; ++i) {
      vector(static_cast<Eigen::Index>(i)) = source_.number((*list)[i], key, "1");
    }
    return vector;
  }

  MapPoint point(const toml::table& table, const std::string& key) const {
    const toml::node& node =
        required(table, key, "a grid point such as 2001, {grid = 2001, at = [x, y, z]} or {at = [x, y, z]}");
    MapPoint point{{}, {}, &node, key};
    const auto grid_of = [&](const toml::node& own) {
      const auto value = own.value_exact<std::int64_t>();
      if (!value || *value < 1 || *value > 999'999'999) {
        source_.refuse(own, key, "allowed: the number of a grid point, above 0");
      }
      return static_cast<int>(*value);
    };
    const toml::table* own = node.as_table();
    if (own == nullptr) {
      point.grid = grid_of(node);
      return point;
    }
    refuse_unknown_keys(source_, *own, key + ".", {"grid", "at"});
    if (const toml::node* grid = own->get("grid")) {
      point.grid = grid_of(*grid);
    }
    if (const toml::node* at = own->get("at")) {
      point.place = vector(*at, key + ".at");
    }
    if (!point.grid && !point.place) {
      source_.refuse_missing(*own, key, "names no point; allowed: grid, at, or both");
    }
    return point;
  }

  const toml::table& table(const std::string& key) const {
    const toml::table* own = &source_.root();
    for (std::size_t from = 0; from < key.size();) {
      const std::size_t dot = std::min(key.find('.', from), key.size());
      const toml::node* node = own->get(key.substr(from, dot - from));
      if (node == nullptr) {
        source_.refuse_missing(*own, key, fmt::format("missing; write [{}] with engine and vehicle", key));
      }
      own = &source_.table(*node, key.substr(0, dot));
      from = dot + 1;
    }
    return *own;
  }

  MapLine line(const std::string& name, const std::string& key) const {
    const toml::table& own = table(key);
    refuse_unknown_keys(source_, own, key + ".", {"engine", "vehicle"});
    return {name, point(own, key + ".engine"), point(own, key + ".vehicle")};
  }

  Eigen::Vector3d axis(const toml::table& table, const std::string& key, const Eigen::Vector3d& usual) const {
    const toml::node* node = table.get(key.substr(key.rfind('.') + 1));
    if (node == nullptr) {
      return usual;
    }
    const Eigen::Vector3d axis = vector(*node, key);
    if (!(axis.norm() > 0.0)) {
      source_.refuse(*node, key, "allowed: a direction, not all of it 0");
    }
    return axis.normalized();
  }

  void read_ports(ProjectionMap& map) const {
    const toml::table& gimbals = table("gimbal");
    map.engines = static_cast<int>(gimbals.size());
    if (map.engines < 1 || map.engines > kMostEngines) {
      source_.refuse_missing(gimbals, "gimbal", fmt::format("{} engines; allowed: 1 to {}", map.engines, kMostEngines));
    }
    std::vector<std::string> names;
    for (int engine = 1; engine <= map.engines; ++engine) {
      names.push_back(fmt::format("engine{}", engine));
    }
    refuse_unknown_keys(source_, gimbals, "gimbal.", {names.begin(), names.end()});
    for (int engine = 1; engine <= map.engines; ++engine) {
      const std::string key = fmt::format("gimbal.engine{}", engine);
      const toml::table& own = table(key);
      refuse_unknown_keys(source_, own, key + ".", {"engine", "vehicle", "pitch_axis", "yaw_axis"});
      map.gimbals.push_back({engine, point(own, key + ".engine"), point(own, key + ".vehicle"),
                             axis(own, key + ".pitch_axis", Eigen::Vector3d::UnitY()),
                             axis(own, key + ".yaw_axis", Eigen::Vector3d::UnitZ())});
    }
    std::vector<std::string> axes;
    const std::vector<std::string> ports = port_names(map.engines);
    for (int axis = 0; axis < 2 * map.engines; ++axis) {
      const std::string& name = ports[static_cast<std::size_t>(axis)];
      map.lines.push_back(line(name, name));
      axes.push_back(name.substr(name.find('.') + 1));
    }
    refuse_unknown_keys(source_, table("attach"), "attach.", {axes.begin(), axes.end()});
  }

  void read_strings(ProjectionMap& map) const {
    if (source_.root().get("strings") == nullptr) {
      return;
    }
    for (const std::string& name : string_names(map.engines)) {
      map.strings.push_back(line(name, "strings." + name));
    }
  }

  const TomlSource& source_;
};

}  // namespace

ProjectionMap read_projection_map(const TomlSource& source, const std::filesystem::path& folder) {
  return MapReader(source).read(folder);
}

}  // namespace hotfire::nastran
