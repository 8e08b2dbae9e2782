// SPDX-License-Identifier: Apache-2.0
#include "tools/nastran/projection.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "tools/files/text/error.hpp"
#include "tools/nastran/geometry.hpp"
#include "tools/nastran/modes.hpp"
#include "tools/nastran/projection_map.hpp"

namespace hotfire::nastran {

namespace {

/// A point of the map, found in the geometry.
struct Point {
  int grid = 0;
  Eigen::Vector3d place;   ///< [length of the model]
  Eigen::Vector3d offset;  ///< from the grid point, which it moves with
};

/// Motion of a point in the basic system.
struct Motion {
  Eigen::Vector3d translation;
  Eigen::Vector3d rotation;
};

class Projector {
 public:
  explicit Projector(const std::filesystem::path& path)
      : source_(path), map_(read_projection_map(source_, path.parent_path())), grids_(load_geometry(map_.geometry)) {}

  Projection run() {
    find_points();
    const std::vector<NastranMode> all = load_modes_of(map_.modes, wanted_);
    std::vector<const NastranMode*> kept;
    for (const NastranMode& mode : all) {
      if (mode.frequency() > map_.least_frequency) {
        kept.push_back(&mode);
      }
    }
    if (kept.empty()) {
      throw FileError(
          fmt::format("{}: no mode above {:g} Hz; lower least_frequency", map_.modes.string(), map_.least_frequency));
    }
    if (map_.damping.size() > 1 && map_.damping.size() != kept.size()) {
      source_.refuse(*source_.root().get("damping"), "damping",
                     fmt::format("{} ratios for {} modes above {:g} Hz; allowed: one, or as many as modes",
                                 map_.damping.size(), kept.size(), map_.least_frequency));
    }
    Projection projection;
    projection.left_out = static_cast<int>(all.size() - kept.size());
    projection.lines = described();
    fill(projection.modes, kept);
    return projection;
  }

 private:
  struct Line {
    Point engine;
    Point vehicle;
    Eigen::Vector3d direction;  ///< from vehicle to engine
  };

  Point found(const MapPoint& point) {
    Point own;
    if (point.grid) {
      const auto grid = grids_.find(*point.grid);
      if (grid == grids_.end()) {
        source_.refuse(*point.node, point.key,
                       fmt::format("grid point {} is not in {}; print its GRID entry", *point.grid, map_.geometry.string()));
      }
      own.grid = *point.grid;
    } else {
      double least = std::numeric_limits<double>::infinity();
      for (const auto& [id, grid] : grids_) {
        const double distance = (grid.place - *point.place).norm();
        if (distance < least) {
          least = distance;
          own.grid = id;
        }
      }
    }
    const Eigen::Vector3d& at = grids_.at(own.grid).place;
    own.place = point.place.value_or(at);
    own.offset = own.place - at;
    wanted_.insert(own.grid);
    return own;
  }

  Line found(const MapLine& line) {
    Line own{found(line.engine), found(line.vehicle), {}};
    const Eigen::Vector3d between = own.engine.place - own.vehicle.place;
    if (!(between.norm() > 0.0)) {
      source_.refuse(*line.vehicle.node, line.vehicle.key,
                     fmt::format("{}: engine and vehicle are at the same place, which gives no line", line.name));
    }
    own.direction = between.normalized();
    return own;
  }

  void find_points() {
    std::transform(map_.lines.begin(), map_.lines.end(), std::back_inserter(lines_),
                   [this](const MapLine& line) { return found(line); });
    std::transform(map_.strings.begin(), map_.strings.end(), std::back_inserter(strings_),
                   [this](const MapLine& line) { return found(line); });
    for (const MapGimbal& gimbal : map_.gimbals) {
      gimbals_.emplace_back(found(gimbal.engine), found(gimbal.vehicle));
    }
  }

  Motion motion_of(const NastranMode& mode, const Point& point) const {
    const GridMotion& own = mode.motion.at(point.grid);
    const Eigen::Matrix3d axes = mode.in_basic_system ? Eigen::Matrix3d::Identity() : grids_.at(point.grid).axes;
    const Eigen::Vector3d rotation = axes * own.tail<3>();
    return {axes * own.head<3>() + rotation.cross(point.offset), rotation};
  }

  double approach(const NastranMode& mode, const Line& line) const {
    return line.direction.dot(motion_of(mode, line.vehicle).translation - motion_of(mode, line.engine).translation);
  }

  /// Mass unit of the generalised coordinate [kg^0.5].
  double root_of_mass(const NastranMode& mode) const {
    const std::optional<double> mass = mode.generalised_mass ? mode.generalised_mass : map_.generalised_mass;
    if (!mass) {
      source_.refuse_missing(
          source_.root(), "generalised_mass",
          fmt::format("missing: {} has no generalised masses; write generalised_mass = 1.0 if its vectors are "
                      "normalised to mass",
                      map_.modes.string()));
    }
    return std::sqrt(*mass * map_.mass);
  }

  void fill(ModeSet& set, const std::vector<const NastranMode*>& kept) const {
    const auto count = static_cast<Eigen::Index>(kept.size());
    set.engines = map_.engines;
    set.frequency.resize(count);
    set.damping_ratio.resize(count);
    set.shape.resize(set.ports(), count);
    set.residual = Eigen::MatrixXd::Zero(set.ports(), set.ports());
    set.string_shape.resize(static_cast<Eigen::Index>(strings_.size()), count);
    set.string_residual = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(strings_.size()), set.ports());
    for (Eigen::Index k = 0; k < count; ++k) {
      const NastranMode& mode = *kept[static_cast<std::size_t>(k)];
      const double root = root_of_mass(mode);
      set.frequency(k) = mode.frequency();
      set.damping_ratio(k) = map_.damping[map_.damping.size() == 1 ? 0 : static_cast<std::size_t>(k)];
      Eigen::Index row = 0;
      for (const Line& line : lines_) {
        set.shape(row++, k) = approach(mode, line) / root;
      }
      for (std::size_t e = 0; e < gimbals_.size(); ++e) {
        const Eigen::Vector3d turned =
            motion_of(mode, gimbals_[e].second).rotation - motion_of(mode, gimbals_[e].first).rotation;
        // A rotation per displacement of the generalised coordinate, which has the length of the model in it.
        set.shape(row++, k) = map_.gimbals[e].pitch_axis.dot(turned) / (root * map_.length);
        set.shape(row++, k) = map_.gimbals[e].yaw_axis.dot(turned) / (root * map_.length);
      }
      for (std::size_t s = 0; s < strings_.size(); ++s) {
        set.string_shape(static_cast<Eigen::Index>(s), k) = approach(mode, strings_[s]) / root;
      }
    }
  }

  static std::string text_of(const Point& point) {
    return point.offset.norm() > 0.0 ? fmt::format("{:g} from grid {}", point.offset.norm(), point.grid)
                                     : fmt::format("grid {}", point.grid);
  }

  std::vector<std::string> described() const {
    std::vector<std::string> all;
    const auto add = [&](const std::string& name, const Line& line) {
      all.push_back(fmt::format("{}: vehicle {}, engine {}, {:g} m apart, along ({:.4f}, {:.4f}, {:.4f})", name,
                                text_of(line.vehicle), text_of(line.engine),
                                (line.engine.place - line.vehicle.place).norm() * map_.length, line.direction.x(),
                                line.direction.y(), line.direction.z()));
    };
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      add(map_.lines[i].name, lines_[i]);
    }
    for (std::size_t e = 0; e < gimbals_.size(); ++e) {
      all.push_back(fmt::format("gimbal of engine {}: vehicle {}, engine {}", e + 1, text_of(gimbals_[e].second),
                                text_of(gimbals_[e].first)));
    }
    for (std::size_t s = 0; s < strings_.size(); ++s) {
      add(map_.strings[s].name, strings_[s]);
    }
    return all;
  }

  TomlSource source_;
  ProjectionMap map_;
  std::map<int, Grid> grids_;
  std::set<int> wanted_;
  std::vector<Line> lines_;
  std::vector<Line> strings_;
  std::vector<std::pair<Point, Point>> gimbals_;  ///< engine, vehicle
};

}  // namespace

double NastranMode::frequency() const { return eigenvalue > 0.0 ? std::sqrt(eigenvalue) / (2.0 * std::numbers::pi) : 0.0; }

std::vector<NastranMode> load_modes_of(const std::filesystem::path& path, const std::set<int>& grids) {
  const std::string ending = path.extension().string();
  if (ending != ".f06" && ending != ".pch" && ending != ".op2") {
    throw FileError(fmt::format("{}: an ending that is not read; allowed: .f06, .pch, .op2", path.string()));
  }
  std::vector<NastranMode> modes = ending == ".f06"   ? load_f06(path, grids)
                                   : ending == ".pch" ? load_punch(path, grids)
                                                      : load_op2(path, grids);
  if (modes.empty()) {
    throw FileError(fmt::format("{}:1: no eigenvector; ask Nastran for DISPLACEMENT = ALL in SOL 103", path.string()));
  }
  for (const NastranMode& mode : modes) {
    for (const int grid : grids) {
      if (!mode.motion.contains(grid)) {
        throw FileError(fmt::format("{}: the eigenvector of mode {} has no grid point {}; print it, or is the file cut?",
                                    mode.place, mode.number, grid));
      }
    }
  }
  return modes;
}

Projection project(const std::filesystem::path& map) { return Projector(map).run(); }

}  // namespace hotfire::nastran
