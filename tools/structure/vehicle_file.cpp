// SPDX-License-Identifier: Apache-2.0
#include "tools/structure/vehicle_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "tools/files/model/key_groups.hpp"
#include "tools/files/model/model_group.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"
#include "tools/structure/mode_table.hpp"

namespace hotfire {

namespace {

constexpr std::string_view kTaos = model::Taos<double>::topology;
constexpr std::string_view kMasv = model::Masv<double>::topology;

std::vector<std::string> tables_of_all_axes(int engines) {
  std::vector<std::string> names;
  for (int axis = 0; axis < 2 * engines; ++axis) {
    for (const std::string& name : tables_of_axis(axis, engines)) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        names.push_back(name);
      }
    }
  }
  return names;
}

/// Reads the tables of one vehicle file, step by step.
template <class Plant>
class Reader {
  /// One axis of a vehicle as the layout of keys wants it.
  using Axis = model::Simplex<double, typename Plant::Effects>;

 public:
  Reader(const TomlSource& source, std::filesystem::path folder)
      : source_(source), folder_(std::move(folder)), axis_tables_(tables_of_all_axes(Plant::kEngines)) {}

  void read(VehicleFile& vehicle) {
    refuse_unknown_keys(source_, source_.root(), "",
                        {"schema", "name", "topology", "servovalve", "actuator", "structure", "engine", "effects", "attach",
                         "gimbal", "modes", "sensors", "strings", "tolerance"});
    for (int axis = 0; axis < Plant::kAxes; ++axis) {
      read_axis(axis);
    }
    read_tolerance();
    read_attach_points();
    read_gimbals();
    sensors_ = read_vehicle_sensors(source_, Plant::kEngines);
    read_modes();
    vehicle.parameters = parameters_;
    vehicle.sensors = sensors_;
    vehicle.axes = declarations_;
    vehicle.modes_table = modes_table_;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  const toml::table* table_at(const toml::table& parent, std::string_view name, const std::string& key) const {
    const toml::node* node = parent.get(name);
    return node != nullptr ? &source_.table(*node, key) : nullptr;
  }

  Words axis_words() const { return {axis_tables_.begin(), axis_tables_.end()}; }

  /// Calls `f(table, prefix)` for the tables of an axis within another, from general to particular.
  template <class F>
  void for_tables_of_axis(const toml::table& table, const std::string& prefix, int axis, F&& f) const {
    for (const std::string& name : tables_of_axis(axis, Plant::kEngines)) {
      if (const toml::table* particular = table_at(table, name, prefix + name)) {
        f(*particular, prefix + name + ".");
      }
    }
  }

  /// Reads a part's own table, then those of its axis within it.
  void read_part(const KeyGroup& part, int axis) {
    const toml::table* own = table_at(source_.root(), part.name, std::string{part.name});
    const std::string prefix = fmt::format("{}.", part.name);
    const toml::table empty;
    auto left_out = read_group(source_, own != nullptr ? *own : empty, part, prefix, axis_words());
    if (own != nullptr) {
      for_tables_of_axis(*own, prefix, axis, [&](const toml::table& table, const std::string& at) {
        read_group(source_, table, part, at, {}, Extent::difference);
        std::erase_if(left_out, [&](const NumberKey* number) { return table.contains(number->name); });
      });
    }
    for (const NumberKey* number : left_out) {
      if (!number->has_usual_value) {
        declarations_[at(axis)].left_out.push_back(prefix + std::string{number->name});
      }
    }
  }

  /// Reads an effect's own table, which is that of every axis unless it holds tables of axes only, then those of its axis.
  void read_effect(const KeyGroup& effect, const toml::table& own, int axis) {
    const std::string prefix = fmt::format("effects.{}.", effect.name);
    const auto is_axis = [&](const auto& entry) {
      return std::find(axis_tables_.begin(), axis_tables_.end(), entry.first.str()) != axis_tables_.end();
    };
    const bool of_every_axis = own.empty() || !std::all_of(own.begin(), own.end(), is_axis);
    if (of_every_axis) {
      read_group(source_, own, effect, prefix, axis_words());
      *effect.active = true;
    }
    for_tables_of_axis(own, prefix, axis, [&](const toml::table& table, const std::string& at) {
      read_group(source_, table, effect, at, {}, *effect.active ? Extent::difference : Extent::whole);
      *effect.active = true;
    });
  }

  void read_axis(int axis) {
    const ModelLayout layout = layout_of_plant<Axis>(parameters_.axes[at(axis)]);
    for (const KeyGroup& part : layout.parts) {
      read_part(part, axis);
    }
    if (const toml::table* effects = table_at(source_.root(), "effects", "effects")) {
      refuse_unknown_keys(source_, *effects, "effects.", names_of(layout.effects));
      for (const KeyGroup& effect : layout.effects) {
        if (const toml::table* own = table_at(*effects, effect.name, fmt::format("effects.{}", effect.name))) {
          read_effect(effect, *own, axis);
        }
      }
    }
    if (const toml::table* sensors = table_at(source_.root(), "sensors", "sensors")) {
      auto& noise = declarations_[at(axis)].noise;
      Words others = axis_words();
      others.push_back(kPistonSensor);
      read_noise(source_, *sensors, "sensors.", layout.channels, others, noise);
      for_tables_of_axis(*sensors, "sensors.", axis, [&](const toml::table& table, const std::string& prefix) {
        read_noise(source_, table, prefix, layout.channels, {}, noise);
      });
    }
  }

  void read_tolerance() {
    const toml::table* table = table_at(source_.root(), "tolerance", "tolerance");
    if (table == nullptr) {
      return;
    }
    const std::vector<std::string> keys = declared_keys(layout_of_plant<Axis>(parameters_.axes.front()));
    std::vector<std::string> allowed = keys;
    for (const std::string& key : keys) {
      for (const std::string& axis : axis_tables_) {
        allowed.push_back(key_of_axis(key, axis));
      }
    }
    const auto tolerances = read_tolerances(source_, *table, Words(allowed.begin(), allowed.end()));
    for (int axis = 0; axis < Plant::kAxes; ++axis) {
      for (const std::string& key : keys) {
        std::vector<std::string> said{key};
        for (const std::string& name : tables_of_axis(axis, Plant::kEngines)) {
          said.push_back(key_of_axis(key, name));
        }
        for (const std::string& name : said) {
          if (const auto found = tolerances.find(name); found != tolerances.end()) {
            declarations_[at(axis)].tolerance[key] = found->second;
          }
        }
      }
    }
  }

  void read_attach_points() {
    const toml::table* attach = table_at(source_.root(), "attach", "attach");
    if (attach == nullptr) {
      parameters_.constant_arms.fill(true);
      return;
    }
    refuse_unknown_keys(source_, *attach, "attach.", axis_words());
    for (int axis = 0; axis < Plant::kAxes; ++axis) {
      const KeyGroup group = part_group(parameters_.attach[at(axis)]);
      for_tables_of_axis(*attach, "attach.", axis, [&](const toml::table& own, const std::string& prefix) {
        read_group(source_, own, group, prefix);
      });
    }
    for (int engine = 0; engine < Plant::kEngines; ++engine) {
      const std::string_view broken =
          model::broken_relation(parameters_.attach[at(2 * engine)], parameters_.attach[at(2 * engine + 1)]);
      if (!broken.empty()) {
        const std::string key =
            Plant::kEngines == 1 ? std::string("attach") : fmt::format("attach of engine {}", engine + 1);
        source_.refuse_missing(*attach, key, broken);
      }
    }
  }

  void read_gimbals() {
    const toml::table* table = table_at(source_.root(), "gimbal", "gimbal");
    if (table == nullptr) {
      return;
    }
    model::GimbalParameters<double> gimbal;
    read_group(source_, *table, part_group(gimbal.bearing), "gimbal.", {"friction", "vibration", "stiffness"});
    if (const toml::table* friction = table_at(*table, "friction", "gimbal.friction")) {
      read_group(source_, *friction, part_group(gimbal.friction), "gimbal.friction.");
    }
    if (const toml::table* vibration = table_at(*table, "vibration", "gimbal.vibration")) {
      read_group(source_, *vibration, part_group(gimbal.vibration), "gimbal.vibration.");
    }
    const toml::node* stiffness = table->get("stiffness");
    if (stiffness != nullptr) {
      gimbal.compliant = true;
      read_stiffness(*stiffness, gimbal.stiffness);
    }
    if (const std::string_view broken = model::broken_relation(gimbal); !broken.empty()) {
      if (broken.find("matrix") != std::string_view::npos) {
        source_.refuse(*stiffness, "gimbal.stiffness", broken);
      }
      source_.refuse_missing(*table, "gimbal", broken);
    }
    parameters_.gimbals.fill(gimbal);
  }

  void read_stiffness(const toml::node& node, Eigen::Matrix<double, 6, 6>& matrix) const {
    constexpr std::size_t kSize = 6;
    const toml::array* rows = node.as_array();
    if (rows == nullptr || rows->size() != kSize) {
      source_.refuse(node, "gimbal.stiffness", "must be an array of six rows: forces x, y, z [N], then moments [N.m]");
    }
    for (std::size_t row = 0; row < kSize; ++row) {
      const toml::array* cells = (*rows)[row].as_array();
      const std::string key = fmt::format("gimbal.stiffness[{}]", row);
      if (cells == nullptr || cells->size() != kSize) {
        source_.refuse((*rows)[row], key, "must have six numbers: per translation x, y, z [m], then per rotation [rad]");
      }
      for (std::size_t column = 0; column < kSize; ++column) {
        // Units differ over the matrix: bare numbers, in SI.
        matrix(static_cast<int>(row), static_cast<int>(column)) =
            source_.number((*cells)[column], fmt::format("{}[{}]", key, column), "1");
      }
    }
  }

  void read_modes() {
    const toml::table* table = table_at(source_.root(), "modes", "modes");
    if (table == nullptr) {
      return;
    }
    refuse_unknown_keys(source_, *table, "modes.", {"table"});
    const toml::node* node = table->get("table");
    if (node == nullptr) {
      source_.refuse_missing(*table, "modes.table", "missing; the file name of a mode table, beside this file");
    }
    modes_table_ = folder_ / source_.text(*node, "modes.table");
    const ModeSet modes = load_modes(modes_table_);
    if (modes.engines != Plant::kEngines) {
      source_.refuse(*node, "modes.table",
                     fmt::format("is for {} engines; allowed: {}, as topology \"{}\" has", modes.engines, Plant::kEngines,
                                 Plant::topology));
    }
    constexpr int kRoom = Plant::Modes::kCapacity;
    if (modes.modes() > kRoom) {
      source_.refuse(
          *node, "modes.table",
          fmt::format("has {} modes; allowed: at most {}: 'hotfire reduce' keeps those that matter", modes.modes(), kRoom));
    }
    parameters_.modes.modes = modes.modes();
    for (int k = 0; k < modes.modes(); ++k) {
      parameters_.modes.frequency[at(k)] = modes.frequency(k);
      parameters_.modes.damping_ratio[at(k)] = modes.damping_ratio(k);
      parameters_.modes.shape.col(k) = modes.shape.col(k);
    }
    parameters_.modes.residual = modes.residual;
    sensors_.string_shape = modes.string_shape;
    sensors_.string_residual = modes.string_residual;
  }

  const TomlSource& source_;
  std::filesystem::path folder_;
  std::vector<std::string> axis_tables_;
  typename Plant::Parameters parameters_{};
  VehicleSensors sensors_;
  std::vector<AxisDeclaration> declarations_{Plant::kAxes};
  std::filesystem::path modes_table_;
};

std::string topology_of(const TomlSource& source) {
  const toml::node* node = source.root().get("topology");
  return node != nullptr ? source.text(*node, "topology") : std::string{};
}

bool is_of_several_axes(const TomlSource& source) {
  const std::string topology = topology_of(source);
  return topology == kTaos || topology == kMasv;
}

VehicleFile read_vehicle(const TomlSource& source, const std::filesystem::path& path) {
  source.require_schema();
  const std::string topology = topology_of(source);
  VehicleFile vehicle{path, path.stem().string(), {}, {}, {}, {}};
  if (const toml::node* name = source.root().get("name")) {
    vehicle.name = source.text(*name, "name");
  }
  if (topology == kTaos) {
    Reader<model::Taos<double>>(source, path.parent_path()).read(vehicle);
  } else if (topology == kMasv) {
    Reader<model::Masv<double>>(source, path.parent_path()).read(vehicle);
  } else {
    source.refuse_missing(source.root(), "topology",
                          fmt::format("\"{}\" is not one of several axes; allowed: \"{}\", \"{}\"", topology, kTaos, kMasv));
  }
  return vehicle;
}

}  // namespace

bool is_vehicle(const std::filesystem::path& path) { return is_of_several_axes(TomlSource(path)); }

bool is_vehicle(std::string text, const std::filesystem::path& path) {
  return is_of_several_axes(TomlSource(path, std::move(text)));
}

VehicleFile load_vehicle(const std::filesystem::path& path) { return read_vehicle(TomlSource(path), path); }

VehicleFile parse_vehicle(std::string text, const std::filesystem::path& path) {
  return read_vehicle(TomlSource(path, std::move(text)), path);
}

VehicleFile with_thrust(VehicleFile vehicle, double thrust) {
  if (!(thrust >= 0.0)) {
    throw UsageError(fmt::format("--thrust {}: allowed: at least 0 N", thrust));
  }
  std::visit(
      [thrust](auto& parameters) {
        for (auto& gimbal : parameters.gimbals) {
          gimbal.bearing.thrust = thrust;
        }
      },
      vehicle.parameters);
  return vehicle;
}

FaultyPlant faulty_plant(const VehicleFile& vehicle) {
  // An axis has these channels whatever its effects.
  const auto axes = std::visit([](const auto& parameters) { return parameters.axes.size(); }, vehicle.parameters);
  return {channels_of_plant<model::Taos<double>::AxisModel>(), true, static_cast<std::int64_t>(axes), true};
}

}  // namespace hotfire
