// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include "tools/files/text/error.hpp"
#include "tools/nastran/modes.hpp"

namespace hotfire::nastran {

namespace {

/// Words of an eigenvector's row, and of a row of eigenvalues.
constexpr std::size_t kGridWords = 8;
constexpr std::size_t kValueWords = 7;
/// The table code of eigenvectors, and the approach of real eigenvalues.
constexpr std::int64_t kEigenvectors = 7;
constexpr std::int64_t kRealEigenvalues = 2;

template <class T>
T turned(T value) {
  std::array<char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), &value, sizeof value);
  std::reverse(bytes.begin(), bytes.end());
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

/// The records of a file of OUTPUT2: each between its own length, four bytes before and after it. A key is a record of one
/// word. Words have four bytes or eight.
class Records {
 public:
  explicit Records(const std::filesystem::path& path) : path_(path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
      throw FileError(fmt::format("{}: cannot be opened; name a file that Nastran has written", path.string()));
    }
    bytes_.assign(std::istreambuf_iterator<char>(file), {});
    std::uint32_t first = 0;
    if (bytes_.size() >= sizeof first) {
      std::memcpy(&first, bytes_.data(), sizeof first);
    }
    const std::uint32_t other = turned(first);
    if (first != 4 && first != 8) {
      swaps_ = true;
      first = other;
    }
    if (first != 4 && first != 8) {
      refuse("no file of OUTPUT2: its first record is neither four bytes nor eight; ask Nastran for PARAM,POST,-1");
    }
    word_ = first;
  }

  bool at_end() const { return at_ >= bytes_.size(); }
  std::size_t word() const { return word_; }

  [[noreturn]] void refuse(std::string_view problem) const {
    throw FileError(fmt::format("{}: byte {}: {}", path_.string(), at_, problem));
  }
  std::string place() const { return fmt::format("{}: byte {}", path_.string(), at_); }

  /// The bytes of the next record.
  std::string_view next() {
    const std::uint32_t length = length_at(at_);
    if (length > bytes_.size() - at_ - 4 || bytes_.size() - at_ - 4 - length < 4) {
      refuse(fmt::format("a record of {} bytes goes beyond the end of the file; is the file cut?", length));
    }
    const std::string_view content(bytes_.data() + at_ + 4, length);
    if (length_at(at_ + 4 + length) != length) {
      refuse("a record whose lengths before and after it differ; is the file damaged?");
    }
    at_ += 8 + length;
    return content;
  }

  std::int64_t key() {
    const std::size_t start = at_;
    const std::string_view content = next();
    if (content.size() != word_) {
      at_ = start;
      refuse(fmt::format("a key of {} bytes; expected {}; is the file damaged?", content.size(), word_));
    }
    return integer(content, 0);
  }

  /// A record that a key with its words announces, and those that continue it. Empty at the end of a table.
  std::string logical_record() {
    std::string content;
    std::int64_t words = key();
    if (words == 0) {
      return content;
    }
    while (words > 0) {
      const std::string_view part = next();
      if (part.size() != static_cast<std::size_t>(words) * word_) {
        refuse(fmt::format("a record of {} bytes where its key has {} words; is the file damaged?", part.size(), words));
      }
      content += part;
      words = key();
    }
    return content;
  }

  std::int64_t integer(std::string_view record, std::size_t place) const {
    if (word_ == 4) {
      return value_at<std::int32_t>(record, place);
    }
    return value_at<std::int64_t>(record, place);
  }
  double real(std::string_view record, std::size_t place) const {
    if (word_ == 4) {
      return static_cast<double>(value_at<float>(record, place));
    }
    return value_at<double>(record, place);
  }

 private:
  std::uint32_t length_at(std::size_t at) const {
    std::uint32_t length = 0;
    if (at + sizeof length > bytes_.size()) {
      refuse("ends within a record; is the file cut?");
    }
    std::memcpy(&length, bytes_.data() + at, sizeof length);
    return swaps_ ? turned(length) : length;
  }

  template <class T>
  T value_at(std::string_view record, std::size_t place) const {
    T value{};
    if ((place + 1) * sizeof value > record.size()) {
      refuse(fmt::format("a record of {} bytes has no word {}; is the file damaged?", record.size(), place + 1));
    }
    std::memcpy(&value, record.data() + place * sizeof value, sizeof value);
    return swaps_ ? turned(value) : value;
  }

  std::filesystem::path path_;
  std::string bytes_;
  std::size_t at_ = 0;
  std::size_t word_ = 4;
  bool swaps_ = false;
};

class Op2Reader {
 public:
  Op2Reader(const std::filesystem::path& path, const std::set<int>& grids) : records_(path), grids_(grids) {}

  std::vector<NastranMode> read() {
    skip_label();
    while (!records_.at_end()) {
      const std::int64_t words = records_.key();
      if (words == 0) {
        break;
      }
      read_block();
    }
    for (const auto& [number, mass] : masses_) {
      if (!modes_.empty() && !modes_.contains(number)) {
        records_.refuse(fmt::format("mode {} has no eigenvector; print those of all modes", number));
      }
    }
    std::vector<NastranMode> all;
    for (auto& [number, mode] : modes_) {
      const auto mass = masses_.find(number);
      if (mass != masses_.end()) {
        mode.generalised_mass = mass->second;
      }
      all.push_back(std::move(mode));
    }
    return all;
  }

 private:
  /// Date, the words NASTRAN FORT TAPE ID CODE, a label: there with PARAM,POST,-1.
  void skip_label() {
    if (records_.key() != 3) {
      records_.refuse("no label of the file; ask Nastran for PARAM,POST,-1");
    }
    records_.next();
    records_.key();
    records_.next();
    records_.key();
    records_.next();
    records_.key();
    records_.key();
  }

  /// A data block whose first key was read.
  void read_block() {
    std::string name;
    for (const char letter : records_.next()) {
      if (std::isalnum(static_cast<unsigned char>(letter)) != 0) {
        name += letter;
      }
    }
    records_.key();
    records_.key();
    records_.next();  // trailer
    for (int i = 0; i < 4; ++i) {
      records_.key();
    }
    records_.next();  // name once more, with the date
    records_.key();
    records_.key();
    const bool is_table = records_.key() == 0;
    if (!is_table) {
      skip_matrix();
    } else if (name == "LAMA" || name == "BLAMA" || name == "LAMAS") {
      read_table([this](const std::string& head, const std::string& rows) { read_values(head, rows); });
    } else if (name.starts_with("OUG") || name.starts_with("BOUG") || name.starts_with("OPHIG") ||
               name.starts_with("BOPHIG")) {
      const bool in_basic_system = name.starts_with('B');
      read_table([&](const std::string& head, const std::string& rows) { read_vector(head, rows, in_basic_system); });
    } else {
      read_table([](const std::string&, const std::string&) {});
    }
  }

  void skip_matrix() {
    for (std::int64_t more = 1; more > 0;) {
      records_.logical_record();
      records_.key();
      more = records_.key();
    }
    records_.key();
  }

  /// Calls `take(head, rows)` for each pair of records.
  template <class Take>
  void read_table(Take&& take) {
    std::string head;
    for (bool is_head = true;; is_head = !is_head) {
      std::string record = records_.logical_record();
      if (record.empty()) {
        return;
      }
      records_.key();
      records_.key();
      if (is_head) {
        head = std::move(record);
      } else {
        take(head, record);
      }
    }
  }

  void require_rows(const std::string& rows, std::size_t words, std::string_view what) const {
    if (rows.size() % (words * records_.word()) != 0) {
      records_.refuse(fmt::format("{} of {} bytes, which are not whole rows of {} words; is the file damaged?", what,
                                  rows.size(), words));
    }
  }

  void read_values(const std::string& /*head*/, const std::string& rows) {
    require_rows(rows, kValueWords, "eigenvalues");
    for (std::size_t row = 0; row < rows.size() / records_.word(); row += kValueWords) {
      const auto mode = static_cast<int>(records_.integer(rows, row));
      const double mass = records_.real(rows, row + 5);
      if (!(mass > 0.0)) {
        records_.refuse(fmt::format("generalized mass {:g} of mode {}; allowed: above 0", mass, mode));
      }
      masses_[mode] = mass;
    }
  }

  void read_vector(const std::string& head, const std::string& rows, bool in_basic_system) {
    // Words of the head, from 1: approach, table code, -, subcase, mode, eigenvalue, cycles, -, format, words of a row.
    const std::int64_t approach = records_.integer(head, 0) / 10;
    const std::int64_t table = records_.integer(head, 1) % 1000;
    if (approach != kRealEigenvalues || table != kEigenvectors) {
      return;
    }
    if (records_.integer(head, 8) != 1 || records_.integer(head, 9) != static_cast<std::int64_t>(kGridWords)) {
      records_.refuse("eigenvectors that are not real; allowed: the modes of SOL 103");
    }
    require_rows(rows, kGridWords, "an eigenvector");
    const auto number = static_cast<int>(records_.integer(head, 4));
    auto [found, is_new] = modes_.try_emplace(number);
    NastranMode& mode = found->second;
    if (!is_new) {
      records_.refuse(fmt::format("mode {} has two eigenvectors; give a file of one run and one subcase", number));
    }
    mode.number = number;
    mode.eigenvalue = records_.real(head, 5);
    mode.in_basic_system = in_basic_system;
    mode.place = records_.place();
    for (std::size_t row = 0; row < rows.size() / records_.word(); row += kGridWords) {
      const auto grid = static_cast<int>(records_.integer(rows, row) / 10);
      if (records_.integer(rows, row + 1) != 1 || !grids_.contains(grid)) {
        continue;
      }
      GridMotion motion;
      for (std::size_t k = 0; k < 6; ++k) {
        motion(static_cast<Eigen::Index>(k)) = records_.real(rows, row + 2 + k);
      }
      if (!motion.allFinite()) {
        records_.refuse(
            fmt::format("grid {} of mode {} has a motion that is not a number; is the file damaged?", grid, number));
      }
      mode.motion[grid] = motion;
    }
  }

  Records records_;
  const std::set<int>& grids_;
  std::map<int, double> masses_;
  std::map<int, NastranMode> modes_;
};

}  // namespace

std::vector<NastranMode> load_op2(const std::filesystem::path& path, const std::set<int>& grids) {
  return Op2Reader(path, grids).read();
}

}  // namespace hotfire::nastran
