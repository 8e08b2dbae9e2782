// SPDX-License-Identifier: Apache-2.0
#include "tools/nastran/geometry.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tools/files/text/csv_cells.hpp"
#include "tools/nastran/text_lines.hpp"

namespace hotfire::nastran {

namespace {

constexpr std::size_t kSmallField = 8;
constexpr std::size_t kLargeField = 16;

/// An entry of bulk data: its name, then its fields, without those of continuation.
struct Entry {
  std::size_t line;  ///< of its first line, from 0
  std::string name;
  std::vector<std::string> fields;
};

/// The part of a line that is bulk data: in the echo of the printed output, what is behind "     12-        ".
std::optional<std::string_view> bulk_part(std::string_view line, bool is_printed) {
  if (!is_printed) {
    return line.substr(0, line.find('$'));
  }
  const std::size_t dash = line.find('-');
  if (line.starts_with('1') || dash == std::string_view::npos || !id_of(line.substr(0, dash)) || line.size() < dash + 9) {
    return std::nullopt;
  }
  return line.substr(dash + 9);
}

std::vector<std::string> fields_of(std::string_view line, std::string& name) {
  std::vector<std::string> fields;
  if (line.find(',') != std::string_view::npos) {
    const std::vector<std::string_view> cells = parts_of(line, ',');
    name = cells.front();
    fields.assign(cells.begin() + 1, cells.end());
    // The tenth field is that of continuation.
    fields.resize(8);
    return fields;
  }
  name = trimmed(line.substr(0, kSmallField));
  const bool is_large = name.ends_with('*') || name.starts_with('*');
  const std::size_t width = is_large ? kLargeField : kSmallField;
  const std::size_t count = is_large ? 4 : 8;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t at = kSmallField + k * width;
    fields.emplace_back(at < line.size() ? trimmed(line.substr(at, width)) : std::string_view{});
  }
  return fields;
}

class GeometryReader {
 public:
  explicit GeometryReader(const std::filesystem::path& path) : lines_(path), is_printed_(path.extension() == ".f06") {}

  std::map<int, Grid> read() {
    collect();
    std::map<int, Grid> grids;
    for (const Entry& entry : entries_) {
      if (entry.name == "GRID") {
        const int id = id_at(entry, 0, "identification");
        const System& system = system_of(entry, system_at(entry, 1));
        const Eigen::Vector3d own{number_at(entry, 2), number_at(entry, 3), number_at(entry, 4)};
        const Grid grid{system.origin + system.axes * own, system_of(entry, system_at(entry, 5)).axes};
        if (!grids.emplace(id, grid).second) {
          lines_.refuse(entry.line, fmt::format("GRID {} is given twice; give a file of one model", id));
        }
      }
    }
    if (grids.empty()) {
      lines_.refuse(0,
                    "no GRID entry; allowed: bulk data (.bdf), or a file with its echo: ECHO = SORT in a .f06, ECHO = PUNCH "
                    "in a .pch");
    }
    return grids;
  }

 private:
  struct System {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  };

  static bool is_wanted(std::string_view name) { return name == "GRID" || name.starts_with("CORD"); }

  void collect() {
    bool continues = false;
    for (std::size_t i = 0; i < lines_.count(); ++i) {
      const auto part = bulk_part(lines_[i], is_printed_);
      if (!part || trimmed(*part).empty()) {
        continue;
      }
      std::string name;
      std::vector<std::string> fields = fields_of(*part, name);
      const bool is_continuation = name.empty() || name.starts_with('+') || name.starts_with('*');
      if (is_continuation) {
        if (continues) {
          std::vector<std::string>& own = entries_.back().fields;
          own.insert(own.end(), fields.begin(), fields.end());
        }
        continue;
      }
      std::transform(name.begin(), name.end(), name.begin(), [](unsigned char letter) { return std::toupper(letter); });
      name.erase(std::remove(name.begin(), name.end(), '*'), name.end());
      continues = is_wanted(name);
      if (continues) {
        entries_.push_back({i, name, std::move(fields)});
        if (name.starts_with("CORD")) {
          const int id = id_at(entries_.back(), 0, "identification");
          if (!systems_at_.emplace(id, entries_.size() - 1).second) {
            lines_.refuse(i, fmt::format("{} {} is given twice; give a file of one model", name, id));
          }
        }
      }
    }
  }

  std::string field(const Entry& entry, std::size_t k) const {
    return k < entry.fields.size() ? entry.fields[k] : std::string{};
  }

  int id_at(const Entry& entry, std::size_t k, std::string_view what) const {
    const std::optional<int> id = id_of(field(entry, k));
    if (!id) {
      lines_.refuse(entry.line, fmt::format("{}: \"{}\" in field {}: expected its {}, a number above 0", entry.name,
                                            field(entry, k), k + 2, what));
    }
    return *id;
  }

  /// A coordinate system: empty is the basic one.
  int system_at(const Entry& entry, std::size_t k) const {
    const std::string text = field(entry, k);
    return text.empty() || text == "0" ? 0 : id_at(entry, k, "coordinate system");
  }

  double number_at(const Entry& entry, std::size_t k) const {
    const std::string text = field(entry, k);
    const std::optional<double> value = text.empty() ? std::optional(0.0) : number_of(text);
    if (!value) {
      lines_.refuse(entry.line,
                    fmt::format("{} {}: \"{}\" in field {}: expected a number", entry.name, field(entry, 0), text, k + 2));
    }
    return *value;
  }

  const System& system_of(const Entry& user, int id) {
    if (const auto known = systems_.find(id); known != systems_.end()) {
      return known->second;
    }
    const auto place = systems_at_.find(id);
    if (place == systems_at_.end()) {
      lines_.refuse(user.line,
                    fmt::format("{} {}: coordinate system {} is not defined in the file", user.name, field(user, 0), id));
    }
    const Entry& entry = entries_[place->second];
    if (entry.name != "CORD2R") {
      lines_.refuse(entry.line,
                    fmt::format("{} {}: of a kind that is not read; allowed: CORD2R, or motion printed in the basic "
                                "system (PARAM,OUGCORD,BASIC)",
                                entry.name, id));
    }
    if (!in_work_.insert(id).second) {
      lines_.refuse(entry.line, fmt::format("CORD2R {}: is defined through itself", id));
    }
    const System base = system_of(entry, system_at(entry, 1));
    std::array<Eigen::Vector3d, 3> points;
    for (std::size_t p = 0; p < points.size(); ++p) {
      const Eigen::Vector3d own{number_at(entry, 2 + 3 * p), number_at(entry, 3 + 3 * p), number_at(entry, 4 + 3 * p)};
      points[p] = base.origin + base.axes * own;
    }
    // A is the origin, B lies on z, C in the plane of x and z.
    const Eigen::Vector3d z = points[1] - points[0];
    const Eigen::Vector3d y = z.cross(points[2] - points[0]);
    if (!(y.norm() > 1e-9 * z.norm() * (points[2] - points[0]).norm()) || !(z.norm() > 0.0)) {
      lines_.refuse(entry.line, fmt::format("CORD2R {}: its three points are on a line", id));
    }
    System system;
    system.origin = points[0];
    system.axes.col(2) = z.normalized();
    system.axes.col(1) = y.normalized();
    system.axes.col(0) = system.axes.col(1).cross(system.axes.col(2));
    in_work_.erase(id);
    return systems_.emplace(id, system).first->second;
  }

  TextLines lines_;
  bool is_printed_;
  std::vector<Entry> entries_;
  std::map<int, std::size_t> systems_at_;
  std::map<int, System> systems_{{0, System{}}};
  std::set<int> in_work_;
};

}  // namespace

std::map<int, Grid> load_geometry(const std::filesystem::path& path) { return GeometryReader(path).read(); }

}  // namespace hotfire::nastran
