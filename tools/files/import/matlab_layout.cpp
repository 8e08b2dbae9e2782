// SPDX-License-Identifier: Apache-2.0
#include "tools/files/import/matlab_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

constexpr std::size_t kHeader = 128;  // [B] with version and byte order in its last four
// The version as a number of 16 bits, then the letters "MI" as one.
static_assert(std::endian::native == std::endian::little);
constexpr std::uint32_t kVersion5 = 0x4D490100;
constexpr std::uint32_t kVersion7_3 = 0x4D490200;
constexpr std::size_t kTag = 8;  // [B]
constexpr std::uint32_t kMatrix = 14;
constexpr std::uint32_t kCompressed = 15;
constexpr std::uint32_t kLastType = 18;  // UTF-32
// A table inside a structure inside a cell needs three.
constexpr int kDeepest = 8;

// A variable of MATLAB 4: a header of five words, the name, the values (MathWorks, MAT-File Format, 2019, appendix A).
constexpr std::size_t kHeader4 = 20;        // [B] type, rows, columns, is complex, length of the name
constexpr std::uint32_t kMostType4 = 4052;  // decimal digits: machine, 0, precision, kind
constexpr std::array<std::size_t, 6> kPrecisions4{8, 4, 4, 2, 2, 1};  // [B] double, single, int32, int16, uint16, uint8

std::uint32_t swapped(std::uint32_t word) {
  return (word >> 24) | ((word >> 8) & 0xff00U) | ((word << 8) & 0xff0000U) | (word << 24);
}

/// A version in a file of the other byte order: each of its two numbers is swapped.
constexpr std::uint32_t in_other_order(std::uint32_t version) {
  return ((version >> 8) & 0x00ff00ffU) | ((version << 8) & 0xff00ff00U);
}

/// Follows the tags of one file.
class MatlabLayout {
 public:
  explicit MatlabLayout(const std::filesystem::path& path)
      : path_(path), file_(path, std::ios::binary), end_(std::filesystem::file_size(path)) {}

  void check() {
    const std::uint32_t version = end_ < kHeader ? 0 : word(kHeader - sizeof version);
    if (version == kVersion7_3 || version == in_other_order(kVersion7_3)) {
      return;  // HDF5, whose library checks it
    }
    other_order_ = version == in_other_order(kVersion5);
    if (version == kVersion5 || other_order_) {
      elements(kHeader, end_, 0);
    } else {
      variables_of_matlab_4();
    }
  }

 private:
  struct Element {
    std::uint32_t type = 0;
    std::size_t data = 0;  ///< where its bytes begin
    std::size_t size = 0;  ///< number of its bytes
    std::size_t next = 0;  ///< where the next element begins
  };

  [[noreturn]] void refuse(std::size_t at, const std::string& problem) const {
    throw FileError(fmt::format("{}: byte {}: {}; it is damaged: save it again with -v7", path_.string(), at, problem));
  }

  std::uint32_t word(std::size_t at) {
    std::array<char, sizeof(std::uint32_t)> bytes{};
    file_.seekg(static_cast<std::streamoff>(at));
    if (!file_.read(bytes.data(), bytes.size())) {
      refuse(at, "cannot be read");
    }
    const auto value = std::bit_cast<std::uint32_t>(bytes);
    return other_order_ ? swapped(value) : value;
  }

  Element element(std::size_t at, std::size_t end) {
    if (end - at < kTag) {
      refuse(at, fmt::format("{} bytes are left; the tag of an element has {}", end - at, kTag));
    }
    const std::uint32_t first = word(at);
    Element element;
    if (first >> 16 != 0) {  // a small one: its bytes are in the tag
      element = {first & 0xffffU, at + kTag / 2, first >> 16, at + kTag};
      if (element.size > kTag / 2) {
        refuse(at, fmt::format("a small element of {} bytes; allowed: 4", element.size));
      }
    } else {
      element = {first, at + kTag, word(at + kTag / 2), 0};
      if (element.size > end - element.data) {
        refuse(at, fmt::format("an element of {} bytes, and {} are left", element.size, end - element.data));
      }
      const std::size_t padded = element.type == kCompressed ? element.size : (element.size + 7) / 8 * 8;
      element.next = std::min(element.data + padded, end);
    }
    if (element.type == 0 || element.type > kLastType) {
      refuse(at, fmt::format("an element of type {}; allowed: 1 to {}", element.type, kLastType));
    }
    return element;
  }

  void elements(std::size_t begin, std::size_t end, int depth) {
    if (depth > kDeepest) {
      refuse(begin, fmt::format("matrices in each other to more than {}", kDeepest));
    }
    for (std::size_t at = begin; at < end;) {
      const Element element = this->element(at, end);
      if (depth == 0 && element.type != kMatrix && element.type != kCompressed) {
        refuse(at, fmt::format("an element of type {}; a variable has {} or {}", element.type, kMatrix, kCompressed));
      }
      if (element.type == kMatrix) {
        elements(element.data, element.data + element.size, depth + 1);
      }
      at = element.next;
    }
  }

  void variables_of_matlab_4() {
    if (end_ == 0) {
      refuse_format();
    }
    for (std::size_t at = 0; at < end_;) {
      at = end_of_matlab_4_variable(at);
    }
  }

  std::size_t end_of_matlab_4_variable(std::size_t at) {
    if (end_ - at < kHeader4) {
      refuse_variable(at, fmt::format("{} bytes are left; the header of a variable has {}", end_ - at, kHeader4));
    }
    other_order_ = false;
    std::uint32_t type = word(at);
    if (type > kMostType4) {
      other_order_ = true;
      type = word(at);
    }
    const std::uint32_t machine = type / 1000;
    const std::uint32_t precision = type / 10 % 10;
    const std::uint32_t kind = type % 10;
    if (machine != (other_order_ ? 1U : 0U) || type / 100 % 10 != 0 || precision >= kPrecisions4.size() || kind > 2) {
      refuse_variable(at, fmt::format("a variable of type {}", type));
    }
    const std::array<std::uint32_t, 4> sizes{word(at + 4), word(at + 8), word(at + 12), word(at + 16)};
    const auto [rows, columns, is_complex, name] = sizes;
    const std::size_t left = end_ - at - kHeader4;
    if (is_complex > 1) {
      refuse_variable(at, fmt::format("complex by a flag of {}; allowed: 0 and 1", is_complex));
    }
    if (name == 0 || name > left) {
      refuse_variable(at, fmt::format("a name of {} bytes, and {} are left", name, left));
    }
    // The product of two words fits in 64 bits.
    const std::size_t values = std::size_t{rows} * columns;
    const std::size_t each = kPrecisions4[precision] * (is_complex + 1);
    if (values > (left - name) / each) {
      refuse_variable(at, fmt::format("{} x {} values of {} bytes, and {} are left", rows, columns, each, left - name));
    }
    return at + kHeader4 + name + values * each;
  }

  /// A file that does not begin with a variable of MATLAB 4 is no MATLAB file.
  [[noreturn]] void refuse_variable(std::size_t at, const std::string& problem) const {
    if (at == 0) {
      refuse_format();
    }
    refuse(at, problem);
  }

  [[noreturn]] void refuse_format() const {
    throw FileError(fmt::format("{}: is not a readable MATLAB file; save it with -v7", path_.string()));
  }

  const std::filesystem::path& path_;
  std::ifstream file_;
  std::size_t end_;
  bool other_order_ = false;
};

}  // namespace

void require_matlab_layout(const std::filesystem::path& path) { MatlabLayout(path).check(); }

}  // namespace hotfire
