// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace hotfire {

/// A stretch of a record's own time of which its user says that it is wrong: values may be missing there, and whole rows.
struct DropOut {
  double from = 0.0;  ///< [s]
  double to = 0.0;    ///< [s], not in it any more

  bool holds(double time) const { return time >= from && time < to; }
};

/// "3.0-3.5" [s]; nothing if the text is not of this form, or ends before it begins.
std::optional<DropOut> drop_out_from(std::string_view text);

/// The most rows that one gap may have lost.
inline constexpr std::size_t kMostLostRows = 1'000'000;

/// Where the rows of a record are in its file: rows that were lost are in none.
class RowLines {
 public:
  explicit RowLines(std::size_t first_line) : first_line_(first_line) {}

  /// `count` rows before `row` (as counted with them) have no line. Ascending.
  void skip(std::size_t row, std::size_t count) { lost_.push_back({row - count, count}); }

  /// The line of a row that has one.
  std::size_t of(std::size_t row) const;

  /// Whether the interval that ends at `row` begins or ends at a lost row: what rows are lost, their number is rounded.
  bool ends_lost_interval(std::size_t row) const;

 private:
  struct Lost {
    std::size_t first;
    std::size_t count;
  };
  std::size_t first_line_;
  std::vector<Lost> lost_;
};

/// Puts rows of NaN where a gap of the time column lies within a drop-out, as many as the mean of the other intervals asks
/// for, and says in `lines` that they have no line. Other gaps stay.
void put_lost_rows(const std::vector<DropOut>& drop_outs, std::size_t time_column, std::vector<std::vector<double>>& columns,
                   RowLines& lines);

}  // namespace hotfire
