// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "tools/files/model/key_groups.hpp"
#include "tools/files/model/toml_text.hpp"
#include "tools/files/record/axis_names.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire {

namespace {

/// A table with what it holds; nothing if that is nothing.
std::string table_text(const std::string& name, const std::string& comment, const std::string& lines) {
  return lines.empty() ? std::string{} : fmt::format("\n[{}]{}\n{}", name, comment, lines);
}

/// Writes the tables of one vehicle, those of its axes by their layouts.
template <class Parameters, class Plant>
class Writer {
 public:
  Writer(const VehicleFile& vehicle, Parameters parameters)
      : vehicle_(vehicle),
        parameters_(std::move(parameters)),
        axes_(axis_names(Plant::kEngines)),
        declarations_(vehicle.axes) {
    declarations_.resize(axes_.size());
    for (auto& axis : parameters_.axes) {
      layouts_.push_back(layout_of_plant<model::Simplex<double, typename Plant::Effects>>(axis));
    }
  }

  std::string text() {
    std::string text =
        fmt::format("schema = 1\nname = {}\ntopology = \"{}\"\n", toml_string(vehicle_.name), Plant::topology);
    for (std::size_t part = 0; part < layouts_.front().parts.size(); ++part) {
      append_part(text, part);
    }
    append_attach_points(text);
    append_gimbal(text);
    if (!vehicle_.modes_table.empty()) {
      text += table_text("modes", "",
                         fmt::format("table = {}\n", toml_string(std::filesystem::absolute(vehicle_.modes_table).string())));
    }
    append_noise(text);
    text += vehicle_sensors_text(vehicle_.sensors);
    append_tolerances(text);
    for (std::size_t effect = 0; effect < layouts_.front().effects.size(); ++effect) {
      append_effect(text, effect);
    }
    return text;
  }

 private:
  /// What is the same of all axes in a table of its own, and what is not in those of the axes. `of(axis, key)` is the line
  /// of one key, empty if the axis has none.
  template <class Line>
  void append_by_axis(std::string& text, const std::string& table, std::size_t keys, Line&& of) const {
    std::string common;
    std::vector<std::string> own(axes_.size());
    for (std::size_t key = 0; key < keys; ++key) {
      const std::string first = of(std::size_t{0}, key);
      bool same = true;
      for (std::size_t axis = 1; axis < axes_.size(); ++axis) {
        same = same && of(axis, key) == first;
      }
      common += same ? first : std::string{};
      for (std::size_t axis = 0; axis < axes_.size() && !same; ++axis) {
        own[axis] += of(axis, key);
      }
    }
    text += table_text(table, "", common);
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      text += table_text(table + "." + axes_[axis], "", own[axis]);
    }
  }

  void append_part(std::string& text, std::size_t part) const {
    const KeyGroup& first = layouts_.front().parts[part];
    append_by_axis(text, std::string{first.name}, first.numbers.size(), [&](std::size_t axis, std::size_t key) {
      const NumberKey& number = layouts_[axis].parts[part].numbers[key];
      std::string line;
      append_line(line, fmt::format("{} = {}", number.name, number_text(*number.value)), number.unit, number.meaning);
      return line;
    });
  }

  void append_noise(std::string& text) const {
    const std::vector<ModelChannel>& channels = layouts_.front().channels;
    append_by_axis(text, "sensors", channels.size(), [&](std::size_t axis, std::size_t key) {
      const auto& noise = declarations_[axis].noise;
      const auto found = noise.find(std::string{channels[key].name});
      std::string line;
      if (found != noise.end()) {
        append_line(line, fmt::format("{}_noise = {}", found->first, number_text(found->second)), channels[key].unit,
                    "rms noise of the channel");
      }
      return line;
    });
  }

  void append_tolerances(std::string& text) const {
    std::set<std::string> keys;
    for (const AxisDeclaration& axis : declarations_) {
      for (const auto& [key, relative] : axis.tolerance) {
        keys.insert(key);
      }
    }
    std::string lines;
    for (const std::string& key : keys) {
      const auto of = [&](std::size_t axis) {
        const auto found = declarations_[axis].tolerance.find(key);
        return found != declarations_[axis].tolerance.end() ? number_text(found->second) : std::string{};
      };
      bool same = true;
      for (std::size_t axis = 1; axis < axes_.size(); ++axis) {
        same = same && of(axis) == of(0);
      }
      for (std::size_t axis = 0; axis < (same ? 1 : axes_.size()); ++axis) {
        if (!of(axis).empty()) {
          const std::string name = same ? key : key_of_axis(key, axes_[axis]);
          lines += fmt::format("{} = {}\n", name, of(axis));
        }
      }
    }
    text += table_text("tolerance", "  # relative one-sigma of a declared value; a value without one is exact", lines);
  }

  void append_effect(std::string& text, std::size_t effect) const {
    std::vector<std::string> lines(axes_.size());
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      const KeyGroup& group = layouts_[axis].effects[effect];
      if (*group.active) {
        append_group(lines[axis], group);
      }
    }
    const KeyGroup& first = layouts_.front().effects[effect];
    const std::string name = fmt::format("effects.{}", first.name);
    const std::string comment = fmt::format("  # site: {}", first.site);
    if (std::all_of(lines.begin(), lines.end(), [&](const std::string& own) { return own == lines.front(); })) {
      text += table_text(name, comment, lines.front());
      return;
    }
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      text += table_text(name + "." + axes_[axis], comment, lines[axis]);
    }
  }

  void append_attach_points(std::string& text) {
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      if (!parameters_.constant_arms[axis / 2]) {
        std::string lines;
        append_group(lines, part_group(parameters_.attach[axis]));
        text += table_text("attach." + axes_[axis], "", lines);
      }
    }
  }

  /// The bearing of every engine; laws without action are left out.
  void append_gimbal(std::string& text) {
    auto& gimbal = parameters_.gimbals.front();
    std::string lines;
    append_group(lines, part_group(gimbal.bearing));
    if (gimbal.compliant) {
      lines += "stiffness = [\n";
      for (int row = 0; row < 6; ++row) {
        for (int column = 0; column < 6; ++column) {
          lines += (column == 0 ? "  [" : ", ") + number_text(gimbal.stiffness(row, column));
        }
        lines += "],\n";
      }
      lines += "]\n";
    }
    text += table_text("gimbal", "", lines);
    if (gimbal.friction.rubs()) {
      lines.clear();
      append_group(lines, part_group(gimbal.friction));
      text += table_text("gimbal.friction", "", lines);
    }
    if (gimbal.vibration.pitch_velocity > 0.0 || gimbal.vibration.yaw_velocity > 0.0) {
      lines.clear();
      append_group(lines, part_group(gimbal.vibration));
      text += table_text("gimbal.vibration", "", lines);
    }
  }

  const VehicleFile& vehicle_;
  Parameters parameters_;
  std::vector<std::string> axes_;
  std::vector<AxisDeclaration> declarations_;
  std::vector<ModelLayout> layouts_;
};

}  // namespace

std::string vehicle_text(const VehicleFile& vehicle) {
  if (const auto* taos = std::get_if<TaosParameters>(&vehicle.parameters)) {
    return Writer<TaosParameters, model::Taos<double>>(vehicle, *taos).text();
  }
  return Writer<MasvParameters, model::Masv<double>>(vehicle, std::get<MasvParameters>(vehicle.parameters)).text();
}

}  // namespace hotfire
