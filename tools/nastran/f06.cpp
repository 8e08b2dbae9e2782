// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/files/text/csv_cells.hpp"
#include "tools/nastran/modes.hpp"
#include "tools/nastran/text_lines.hpp"

namespace hotfire::nastran {

namespace {

constexpr std::string_view kValues = "R E A L   E I G E N V A L U E S";
constexpr std::string_view kVector = "R E A L   E I G E N V E C T O R   N O .";
constexpr std::string_view kCycles = "CYCLES =";
constexpr std::string_view kValue = "EIGENVALUE =";

bool contains(std::string_view line, std::string_view text) { return line.find(text) != std::string_view::npos; }

/// A page of the printed output begins with a 1 in the column of printer control.
bool begins_page(std::string_view line) { return line.starts_with('1'); }

/// The first word of what may follow a table on its page: a message, a heading, the next eigenvector.
bool ends_table(std::string_view word) { return word.starts_with('*') || word == "E" || word == "EIGENVALUE"; }

class F06Reader {
 public:
  F06Reader(const std::filesystem::path& path, const std::set<int>& grids) : lines_(path), grids_(grids) {}

  std::vector<NastranMode> read() {
    for (std::size_t i = 0; i < lines_.count(); ++i) {
      const std::string_view line = lines_[i];
      if (contains(line, "USER FATAL MESSAGE") || contains(line, "SYSTEM FATAL MESSAGE")) {
        lines_.refuse(i, fmt::format("\"{}\": Nastran ended with an error; correct its run", trimmed(line)));
      }
      if (contains(line, kVector)) {
        i = read_vector_page(i);
      } else if (contains(line, kValues)) {
        i = read_values_page(i);
      }
    }
    return joined();
  }

 private:
  struct Value {
    double eigenvalue;
    double generalised_mass;
    std::size_t line;
  };

  /// One page of the table of eigenvalues: `MODE, ORDER, EIGENVALUE, RADIANS, CYCLES, MASS, STIFFNESS`. Returns its last
  /// line.
  std::size_t read_values_page(std::size_t i) {
    // A later table of the same run, after residual vectors were added, replaces the one before.
    std::size_t rows = 0;
    for (++i; i < lines_.count() && !begins_page(lines_[i]); ++i) {
      const std::vector<std::string_view> words = words_of(lines_[i]);
      if (words.empty() || (rows == 0 && !id_of(words.front()))) {
        continue;
      }
      if (ends_table(words.front())) {
        break;
      }
      const auto number = [&](std::size_t column) {
        return column < words.size() ? number_of(words[column]) : std::nullopt;
      };
      if (words.size() != 7 || !id_of(words.front()) || !number(2) || !number(5)) {
        lines_.refuse(i, fmt::format("\"{}\": no row of the eigenvalues; expected seven numbers: mode, order, eigenvalue, "
                                     "radians, cycles, generalized mass, generalized stiffness",
                                     trimmed(lines_[i])));
      }
      const int mode = *id_of(words.front());
      if (mode == 1) {
        values_.clear();
      }
      values_[mode] = {*number(2), *number(5), i};
      ++rows;
    }
    if (rows == 0) {
      lines_.refuse(std::min(i, lines_.count() - 1), "the table of eigenvalues ends without a row; is the file cut?");
    }
    return i - 1;
  }

  /// The number behind a name in a line.
  static std::optional<double> named(std::string_view line, std::string_view name) {
    const std::size_t at = line.find(name);
    if (at == std::string_view::npos) {
      return {};
    }
    const std::vector<std::string_view> words = words_of(line.substr(at + name.size()));
    return words.empty() ? std::nullopt : number_of(words.front());
  }

  NastranMode& mode_at(std::size_t i) {
    const std::string_view line = lines_[i];
    const std::vector<std::string_view> words = words_of(line.substr(line.find(kVector) + kVector.size()));
    const std::optional<int> number = words.empty() ? std::nullopt : id_of(words.front());
    const std::optional<double> value = i > 0 ? named(lines_[i - 1], kValue) : std::nullopt;
    if (!number || !value || !named(line, kCycles)) {
      lines_.refuse(i, "the heading of an eigenvector without mode, EIGENVALUE or CYCLES; is the file damaged?");
    }
    const double eigenvalue = value.value_or(0.0);
    auto [found, is_new] = modes_.try_emplace(*number);
    NastranMode& mode = found->second;
    if (is_new) {
      mode.number = *number;
      mode.eigenvalue = eigenvalue;
      mode.place = fmt::format("{}:{}", lines_.path().string(), i + 1);
    } else if (mode.eigenvalue != eigenvalue) {
      lines_.refuse(i, fmt::format("mode {} has the eigenvalue {:g} here and {:g} at {}; give a file of one run and one "
                                   "subcase",
                                   *number, eigenvalue, mode.eigenvalue, mode.place));
    }
    return mode;
  }

  /// One page of an eigenvector. Returns its last line.
  std::size_t read_vector_page(std::size_t i) {
    NastranMode& mode = mode_at(i);
    std::size_t rows = 0;
    for (++i; i < lines_.count() && !begins_page(lines_[i]); ++i) {
      const std::vector<std::string_view> words = words_of(lines_[i]);
      if (words.empty() || words.front() == "POINT" || words.front() == "0") {
        continue;
      }
      const std::optional<int> grid = id_of(words.front());
      if (ends_table(words.front())) {
        break;
      }
      if (!grid || words.size() < 2) {
        lines_.refuse(i, fmt::format("\"{}\": no row of an eigenvector; expected a grid point, its type and six numbers",
                                     trimmed(lines_[i])));
      }
      ++rows;
      if (words[1] == "G" && grids_.contains(*grid)) {
        read_grid(i, words, *grid, mode);
      }
    }
    if (rows == 0) {
      lines_.refuse(std::min(i, lines_.count() - 1),
                    fmt::format("eigenvector {} ends without a grid point; is the file cut?", mode.number));
    }
    return i - 1;
  }

  void read_grid(std::size_t i, const std::vector<std::string_view>& words, int grid, NastranMode& mode) const {
    GridMotion motion;
    for (std::size_t k = 0; k < 6; ++k) {
      const std::optional<double> value = words.size() == 8 ? number_of(words[k + 2]) : std::nullopt;
      if (!value) {
        lines_.refuse(i, fmt::format("grid {} of mode {}: \"{}\": expected six numbers, T1 to R3", grid, mode.number,
                                     trimmed(lines_[i])));
      }
      motion(static_cast<Eigen::Index>(k)) = *value;
    }
    if (!mode.motion.emplace(grid, motion).second) {
      lines_.refuse(
          i, fmt::format("grid {} of mode {} is given twice; give a file of one run and one subcase", grid, mode.number));
    }
  }

  std::vector<NastranMode> joined() {
    for (const auto& [number, value] : values_) {
      if (!modes_.empty() && !modes_.contains(number)) {
        lines_.refuse(value.line,
                      fmt::format("mode {} has no eigenvector; print those of all modes, or is the file cut?", number));
      }
    }
    std::vector<NastranMode> all;
    for (auto& [number, mode] : modes_) {
      const auto value = values_.find(number);
      if (value == values_.end()) {
        lines_.refuse(lines_.count(),
                      fmt::format("eigenvector {} (at {}) has no row in the table of eigenvalues; is the file "
                                  "cut?",
                                  number, mode.place));
      }
      // Both are printed with seven digits.
      constexpr double kRounding = 1e-5;
      const double size = std::max(std::abs(value->second.eigenvalue), 1.0);
      if (std::abs(value->second.eigenvalue - mode.eigenvalue) > kRounding * size) {
        lines_.refuse(value->second.line,
                      fmt::format("mode {} has the eigenvalue {:g} here and {:g} at {}; give a file of one "
                                  "run and one subcase",
                                  number, value->second.eigenvalue, mode.eigenvalue, mode.place));
      }
      if (!(value->second.generalised_mass > 0.0)) {
        lines_.refuse(value->second.line, fmt::format("generalized mass {:g} of mode {}; allowed: above 0",
                                                      value->second.generalised_mass, number));
      }
      mode.generalised_mass = value->second.generalised_mass;
      all.push_back(std::move(mode));
    }
    return all;
  }

  TextLines lines_;
  const std::set<int>& grids_;
  std::map<int, Value> values_;
  std::map<int, NastranMode> modes_;
};

}  // namespace

std::vector<NastranMode> load_f06(const std::filesystem::path& path, const std::set<int>& grids) {
  return F06Reader(path, grids).read();
}

}  // namespace hotfire::nastran
