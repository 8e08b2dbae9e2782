// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "tools/files/text/csv_cells.hpp"
#include "tools/nastran/modes.hpp"
#include "tools/nastran/text_lines.hpp"

namespace hotfire::nastran {

namespace {

/// A line has 72 columns of data, then a number of its own: fields of 18 columns, the first with identification.
constexpr std::size_t kData = 72;
constexpr std::size_t kField = 18;
constexpr std::string_view kContinuation = "-CONT-";

/// True for a line of the heading that eigenvectors have, apart from those that are read.
bool belongs_to_vectors(std::string_view line) {
  return line.starts_with("$SUBTITLE") || line.starts_with("$LABEL") || line.starts_with("$REAL OUTPUT") ||
         line.starts_with("$SUBCASE");
}

class PunchReader {
 public:
  PunchReader(const std::filesystem::path& path, const std::set<int>& grids) : lines_(path), grids_(grids) {}

  std::vector<NastranMode> read() {
    bool in_vectors = false;
    NastranMode* mode = nullptr;
    for (std::size_t i = 0; i < lines_.count(); ++i) {
      const std::string_view line = data_of(i);
      if (line.starts_with("$TITLE")) {
        in_vectors = false;
        mode = nullptr;
      } else if (line.starts_with("$EIGENVECTOR")) {
        in_vectors = true;
        mark(mode);
      } else if (line.starts_with("$COMPLEX") || line.starts_with("$REAL-IMAGINARY") || line.starts_with("$MAGNITUDE")) {
        if (in_vectors) {
          lines_.refuse(i, "complex eigenvectors; allowed: the real modes of SOL 103");
        }
      } else if (line.starts_with("$EIGENVALUE")) {
        mode = &mode_at(i);
        mark(in_vectors ? mode : nullptr);
      } else if (line.starts_with('$')) {
        in_vectors = in_vectors && belongs_to_vectors(line);
      } else if (in_vectors && !trimmed(line).empty()) {
        if (mode == nullptr) {
          lines_.refuse(i, "a grid point before any $EIGENVALUE; is the file damaged?");
        }
        i = read_grid(i, *mode);
      }
    }
    std::vector<NastranMode> all;
    for (auto& [number, own] : modes_) {
      // Other results of a mode, such as element forces, name it too.
      if (with_vector_.contains(number)) {
        all.push_back(std::move(own));
      }
    }
    return all;
  }

 private:
  std::string_view data_of(std::size_t i) const { return lines_[i].substr(0, kData); }

  /// Notes that a mode has an eigenvector: behind $EIGENVALUE, or before it.
  void mark(const NastranMode* mode) {
    if (mode != nullptr) {
      with_vector_.insert(mode->number);
    }
  }

  NastranMode& mode_at(std::size_t i) {
    const std::string_view line = data_of(i);
    const std::vector<std::string_view> words = words_of(line.substr(line.find('=') + 1));
    // "8.2327765E+06  MODE =     1"
    const std::optional<double> value = !words.empty() ? number_of(words[0]) : std::nullopt;
    const std::optional<int> number =
        words.size() >= 4 && words[1] == "MODE" && words[2] == "=" ? id_of(words[3]) : std::nullopt;
    if (!value || !number) {
      lines_.refuse(i, fmt::format("\"{}\": expected $EIGENVALUE = a number, MODE = a number", trimmed(line)));
    }
    const double eigenvalue = value.value_or(0.0);
    auto [found, is_new] = modes_.try_emplace(*number);
    if (is_new) {
      found->second.number = *number;
      found->second.eigenvalue = eigenvalue;
      found->second.place = fmt::format("{}:{}", lines_.path().string(), i + 1);
    } else if (found->second.eigenvalue != eigenvalue) {
      lines_.refuse(i, fmt::format("mode {} has the eigenvalue {:g} here and {:g} at {}; give a file of one run and one "
                                   "subcase",
                                   *number, eigenvalue, found->second.eigenvalue, found->second.place));
    }
    return found->second;
  }

  double number_at(std::size_t i, std::size_t field, int grid, const NastranMode& mode) const {
    const std::string_view line = data_of(i);
    const std::string_view cell = field * kField < line.size() ? line.substr(field * kField, kField) : std::string_view{};
    const std::optional<double> value = number_of(cell);
    if (!value) {
      lines_.refuse(i, fmt::format("grid {} of mode {}: \"{}\" in columns {} to {}: expected a number", grid, mode.number,
                                   trimmed(cell), field * kField + 1, (field + 1) * kField));
    }
    return *value;
  }

  /// A grid point has two lines, a scalar point one. Returns the last.
  std::size_t read_grid(std::size_t i, NastranMode& mode) {
    const std::vector<std::string_view> words = words_of(data_of(i).substr(0, kField));
    const std::optional<int> grid = !words.empty() ? id_of(words[0]) : std::nullopt;
    if (!grid || words.size() != 2 || (words[1] != "G" && words[1] != "S" && words[1] != "H")) {
      lines_.refuse(i, fmt::format("\"{}\": expected a grid point, its type and three numbers", trimmed(data_of(i))));
    }
    if (words[1] != "G") {
      return i;
    }
    if (i + 1 >= lines_.count() || !data_of(i + 1).starts_with(kContinuation)) {
      lines_.refuse(i + 1, fmt::format("grid {} of mode {}: expected {} with its three rotations; is the file cut?", *grid,
                                       mode.number, kContinuation));
    }
    if (!grids_.contains(*grid)) {
      return i + 1;
    }
    GridMotion motion;
    for (std::size_t k = 0; k < 6; ++k) {
      motion(static_cast<Eigen::Index>(k)) = number_at(i + k / 3, 1 + k % 3, *grid, mode);
    }
    if (!mode.motion.emplace(*grid, motion).second) {
      lines_.refuse(
          i, fmt::format("grid {} of mode {} is given twice; give a file of one run and one subcase", *grid, mode.number));
    }
    return i + 1;
  }

  TextLines lines_;
  const std::set<int>& grids_;
  std::map<int, NastranMode> modes_;
  std::set<int> with_vector_;
};

}  // namespace

std::vector<NastranMode> load_punch(const std::filesystem::path& path, const std::set<int>& grids) {
  return PunchReader(path, grids).read();
}

}  // namespace hotfire::nastran
