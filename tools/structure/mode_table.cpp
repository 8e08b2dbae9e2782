// SPDX-License-Identifier: Apache-2.0
#include "tools/structure/mode_table.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "tools/files/text/csv_cells.hpp"
#include "tools/files/text/csv_lines.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"

namespace hotfire {

namespace {

constexpr std::string_view kMode = "mode";
constexpr std::string_view kFrequency = "frequency[Hz]";
constexpr std::string_view kDamping = "damping[1]";
constexpr std::string_view kResidual = "residual.";

bool read_number(std::string_view cell, double& value) {
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc{} && end == cell.data() + cell.size() && std::isfinite(value);
}

/// The next line that is neither a comment nor blank.
bool next_row(CsvLines& lines, std::string_view& line) {
  while (lines.next(line)) {
    if (!line.starts_with('#') && !trimmed(line).empty()) {
      return true;
    }
  }
  return false;
}

/// Engine number at the end of the name of a port or a string; 0 if the name is neither's.
int engine_of(std::string_view name) {
  for (const std::string_view kind : {"attach.pitch", "attach.yaw", "gimbal.pitch", "gimbal.yaw", "side.pitch", "side.yaw",
                                      "string1.engine", "string2.engine", "string3.engine", "string4.engine"}) {
    int engine = 0;
    if (name.starts_with(kind)) {
      const auto [end, error] = std::from_chars(name.data() + kind.size(), name.data() + name.size(), engine);
      return error == std::errc{} && end == name.data() + name.size() && engine > 0 ? engine : 0;
    }
  }
  return 0;
}

/// The places of the columns of a table.
struct Columns {
  int engines = 0;
  std::size_t mode = 0;
  std::size_t frequency = 0;
  std::size_t damping = 0;
  std::vector<std::string> shapes;  ///< ports, then strings, then those of a flight if the table has them
  std::size_t of_flight = 0;        ///< where the latter begin
  std::vector<std::size_t> shape_at;
  std::size_t count = 0;
};

void refuse_unknown_column(const CsvLines& lines, std::string_view name) {
  if (const int engine = engine_of(name); engine > kMostEngines) {
    lines.refuse(
        fmt::format("column \"{}\": engine {}; allowed: at most {} engines in this build", name, engine, kMostEngines));
  }
  const std::vector<std::string> ports = port_names(kMostEngines);
  std::vector<std::string_view> known{kMode, kFrequency, kDamping};
  known.insert(known.end(), ports.begin(), ports.end());
  const std::vector<std::string> strings = string_names(kMostEngines);
  known.insert(known.end(), strings.begin(), strings.end());
  const std::vector<std::string> flight = flight_names(kMostEngines);
  known.insert(known.end(), flight.begin(), flight.end());
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    lines.refuse(fmt::format("column \"{}\": unknown; {}", name, suggestion(name, known)));
  }
}

Columns read_columns(CsvLines& lines) {
  std::string_view line;
  if (!next_row(lines, line)) {
    lines.refuse("no header; a mode table begins with a line like mode,frequency[Hz],damping[1],attach.pitch1,...");
  }
  std::map<std::string, std::size_t, std::less<>> at;
  Columns columns;
  for (const std::string_view name : parts_of(line, ',')) {
    refuse_unknown_column(lines, name);
    if (!at.emplace(name, at.size()).second) {
      lines.refuse(fmt::format("column \"{}\": named twice; allowed: each column once", name));
    }
    columns.engines = std::max(columns.engines, engine_of(name));
  }
  columns.count = at.size();
  const auto column = [&](std::string_view name, std::string_view why) {
    const auto found = at.find(name);
    if (found == at.end()) {
      lines.refuse(fmt::format("no column {}: {}", name, why));
    }
    return found->second;
  };
  columns.mode = column(kMode, "it numbers the rows");
  columns.frequency = column(kFrequency, "every mode has a natural frequency");
  columns.damping = column(kDamping, "every mode has a damping ratio");
  if (columns.engines == 0) {
    column("attach.pitch1", "a mode has a shape at every attach point and gimbal");
  }
  columns.shapes = port_names(columns.engines);
  if (std::any_of(at.begin(), at.end(), [](const auto& own) { return own.first.starts_with("string"); })) {
    const std::vector<std::string> strings = string_names(columns.engines);
    columns.shapes.insert(columns.shapes.end(), strings.begin(), strings.end());
  }
  columns.of_flight = columns.shapes.size();
  if (std::any_of(at.begin(), at.end(),
                  [](const auto& own) { return own.first.starts_with("side.") || own.first.starts_with("sensor."); })) {
    const std::vector<std::string> flight = flight_names(columns.engines);
    columns.shapes.insert(columns.shapes.end(), flight.begin(), flight.end());
  }
  for (const std::string& shape : columns.shapes) {
    columns.shape_at.push_back(column(
        shape, fmt::format(
                   "the table has {} engine{}. A mode has a shape at every attach point and gimbal of each engine. Strings, "
                   "side forces and sensor: all of them or none",
                   columns.engines, columns.engines == 1 ? "" : "s")));
  }
  return columns;
}

/// Reads the shapes, or a row of the residual.
Eigen::VectorXd read_shapes(const CsvLines& lines, const Columns& columns, const std::vector<std::string_view>& cells) {
  const std::vector<std::string>& names = columns.shapes;
  Eigen::VectorXd values(static_cast<Eigen::Index>(names.size()));
  for (std::size_t port = 0; port < names.size(); ++port) {
    const std::string_view cell = cells[columns.shape_at[port]];
    if (cell.empty() && port >= columns.of_flight && cells[columns.mode].starts_with(kResidual)) {
      values(static_cast<Eigen::Index>(port)) = 0.0;
      continue;
    }
    if (cell.empty()) {
      lines.refuse(fmt::format("{} {}: missing shape at {}; allowed: a number, 0 where the mode does not move it", kMode,
                               cells[columns.mode], names[port]));
    }
    if (!read_number(cell, values(static_cast<Eigen::Index>(port)))) {
      lines.refuse(fmt::format("{} = \"{}\": not a finite number", names[port], cell));
    }
  }
  return values;
}

double read_bounded(const CsvLines& lines, std::string_view name, std::string_view cell, bool (*good)(double),
                    std::string_view allowed) {
  double value = 0.0;
  if (!read_number(cell, value) || !good(value)) {
    lines.refuse(fmt::format("{} = \"{}\"; allowed: {}", name, cell, allowed));
  }
  return value;
}

void require_residual(const CsvLines& lines, const Columns& columns, const std::set<std::string>& rows,
                      const Eigen::MatrixXd& residual) {
  for (const std::string& port : port_names(columns.engines)) {
    if (!rows.empty() && rows.count(port) == 0) {
      lines.refuse(fmt::format("no row {}{}: a residual has one for every port", kResidual, port));
    }
  }
  const double size = residual.cwiseAbs().maxCoeff();
  if ((residual - residual.transpose()).cwiseAbs().maxCoeff() > 1e-9 * size) {
    lines.refuse("the residual is not symmetric; allowed: the same flexibility of a pair of ports both ways");
  }
  // In units of the ports' own flexibility, so that metres and radians weigh alike.
  const Eigen::VectorXd scale =
      residual.diagonal().cwiseAbs().cwiseSqrt().unaryExpr([](double x) { return x > 0.0 ? 1.0 / x : 1.0; });
  const Eigen::MatrixXd scaled = scale.asDiagonal() * residual * scale.asDiagonal();
  if (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled).eigenvalues().minCoeff() < -1e-9) {
    lines.refuse("the residual is not positive semidefinite: it would give energy; allowed: a flexibility");
  }
}

}  // namespace

std::vector<std::string> port_names(int engines) {
  std::vector<std::string> names;
  for (const std::string_view kind : {"attach", "gimbal"}) {
    for (int engine = 1; engine <= engines; ++engine) {
      names.push_back(fmt::format("{}.pitch{}", kind, engine));
      names.push_back(fmt::format("{}.yaw{}", kind, engine));
    }
  }
  return names;
}

std::vector<std::string> flight_names(int engines) {
  std::vector<std::string> names;
  for (int engine = 1; engine <= engines; ++engine) {
    names.push_back(fmt::format("side.pitch{}", engine));
    names.push_back(fmt::format("side.yaw{}", engine));
  }
  names.insert(names.end(), {"sensor.pitch", "sensor.yaw"});
  return names;
}

std::vector<std::string> string_names(int engines) {
  std::vector<std::string> names;
  for (int engine = 1; engine <= engines; ++engine) {
    for (int string = 1; string <= 4; ++string) {
      names.push_back(fmt::format("string{}.engine{}", string, engine));
    }
  }
  return names;
}

ModeSet load_modes(const std::filesystem::path& path) {
  CsvLines lines(path);
  const Columns columns = read_columns(lines);
  const std::vector<std::string> names = port_names(columns.engines);
  ModeSet set;
  set.engines = columns.engines;
  const Eigen::Index strings = static_cast<Eigen::Index>(columns.of_flight) - set.ports();
  const Eigen::Index flight = std::ssize(columns.shapes) - static_cast<Eigen::Index>(columns.of_flight);
  set.residual = Eigen::MatrixXd::Zero(set.ports(), set.ports());
  set.string_residual = Eigen::MatrixXd::Zero(strings, set.ports());
  std::vector<double> frequency;
  std::vector<double> damping;
  std::vector<Eigen::VectorXd> shapes;
  std::set<std::string, std::less<>> seen;
  std::set<std::string> residual_rows;
  std::string_view line;
  while (next_row(lines, line)) {
    const std::vector<std::string_view> cells = parts_of(line, ',');
    if (cells.size() != columns.count) {
      lines.refuse(
          fmt::format("ragged row: {} cells; allowed: {}, as many as the header names", cells.size(), columns.count));
    }
    const std::string_view label = cells[columns.mode];
    if (label.empty() || !seen.emplace(label).second) {
      lines.refuse(fmt::format("mode = \"{}\": {}; allowed: a name of its own for each row", label,
                               label.empty() ? "missing" : "given twice"));
    }
    const Eigen::VectorXd shape = read_shapes(lines, columns, cells);
    if (label.starts_with(kResidual)) {
      const auto port = std::find(names.begin(), names.end(), label.substr(kResidual.size()));
      if (port == names.end()) {
        lines.refuse(fmt::format("{}: no such port; {}", label,
                                 suggestion(label.substr(kResidual.size()), {names.begin(), names.end()})));
      }
      set.residual.row(port - names.begin()) = shape.head(set.ports()).transpose();
      set.string_residual.col(port - names.begin()) = shape.segment(set.ports(), strings);
      residual_rows.insert(*port);
      continue;
    }
    if (shapes.size() == kMostModes) {
      lines.refuse(fmt::format("more than {} modes", kMostModes));
    }
    const bool flies = columns.of_flight < columns.shapes.size();
    frequency.push_back(read_bounded(
        lines, kFrequency, cells[columns.frequency],
        flies ? +[](double f) { return f >= 0.0; } : +[](double f) { return f > 0.0; },
        "above 0, or 0 for a rigid-body mode in a table that has the columns side and sensor"));
    damping.push_back(read_bounded(
        lines, kDamping, cells[columns.damping], [](double z) { return z >= 0.0 && z < 1.0; }, "0 to below 1"));
    shapes.push_back(shape);
  }
  require_residual(lines, columns, residual_rows, set.residual);
  const auto all = static_cast<Eigen::Index>(shapes.size());
  std::vector<Eigen::Index> bending;
  for (Eigen::Index k = 0; k < all; ++k) {
    if (frequency[static_cast<std::size_t>(k)] > 0.0) {
      bending.push_back(k);
    }
  }
  Eigen::MatrixXd shape(std::ssize(columns.shapes), all);
  for (Eigen::Index k = 0; k < all; ++k) {
    shape.col(k) = shapes[static_cast<std::size_t>(k)];
  }
  const Eigen::VectorXd every_frequency = Eigen::Map<const Eigen::VectorXd>(frequency.data(), all);
  const Eigen::VectorXd every_damping = Eigen::Map<const Eigen::VectorXd>(damping.data(), all);
  set.frequency = every_frequency(bending);
  set.damping_ratio = every_damping(bending);
  set.shape = shape.topRows(set.ports())(Eigen::all, bending);
  set.string_shape = shape.middleRows(set.ports(), strings)(Eigen::all, bending);
  if (flight > 0) {
    set.flight = {every_frequency, every_damping, shape.middleRows(set.ports() + strings, 2 * set.engines),
                  shape.bottomRows(2), shape.topRows(set.ports() + strings)};
  }
  return set;
}

std::string mode_table_text(const ModeSet& modes, const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& comment : comments) {
    text += fmt::format("# {}\n", comment);
  }
  text += fmt::format("{},{},{}", kMode, kFrequency, kDamping);
  const std::vector<std::string> names = port_names(modes.engines);
  std::vector<std::string> columns = names;
  if (modes.string_shape.rows() > 0) {
    const std::vector<std::string> strings = string_names(modes.engines);
    columns.insert(columns.end(), strings.begin(), strings.end());
  }
  const bool flies = modes.flight.frequency.size() > 0;
  const std::vector<std::string> flight = flight_names(flies ? modes.engines : 0);
  if (flies) {
    columns.insert(columns.end(), flight.begin(), flight.end());
  }
  for (const std::string& column : columns) {
    text += fmt::format(",{}", column);
  }
  text += '\n';
  const auto append = [&text](const Eigen::VectorXd& values) {
    for (const double value : values) {
      text += fmt::format(",{}", value);
    }
  };
  const Eigen::VectorXd& frequency = flies ? modes.flight.frequency : modes.frequency;
  const Eigen::VectorXd& damping_ratio = flies ? modes.flight.damping_ratio : modes.damping_ratio;
  for (Eigen::Index k = 0; k < frequency.size(); ++k) {
    text += fmt::format("{},{},{}", k + 1, frequency(k), damping_ratio(k));
    if (flies) {
      append(modes.flight.shape.col(k));
      append(modes.flight.side.col(k));
      append(modes.flight.sensor.col(k));
    } else {
      append(modes.shape.col(k));
      append(modes.string_shape.col(k));
    }
    text += '\n';
  }
  const bool moves_strings = modes.string_residual.size() > 0 && modes.string_residual.cwiseAbs().maxCoeff() > 0.0;
  if (modes.residual.cwiseAbs().maxCoeff() > 0.0 || moves_strings) {
    for (int row = 0; row < modes.ports(); ++row) {
      text += fmt::format("{}{},,", kResidual, names[static_cast<std::size_t>(row)]);
      append(modes.residual.row(row));
      append(modes.string_residual.col(row));
      text += flies ? std::string(flight.size(), ',') + "\n" : "\n";
    }
  }
  return text;
}

}  // namespace hotfire
