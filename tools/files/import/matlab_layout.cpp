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
constexpr std::size_t kTag = 8;       // [B]
constexpr std::uint32_t kMatrix = 14;
constexpr std::uint32_t kCompressed = 15;
constexpr std::uint32_t kLastType = 18;  // UTF-32
// A table inside a structure inside a cell needs three.
constexpr int kDeepest = 8;

std::uint32_t swapped(std::uint32_t word) {
  return (word >> 24) | ((word >> 8) & 0xff00U) | ((word << 8) & 0xff0000U) | (word << 24);
}

/// Follows the tags of one file.
class MatlabElements {
 public:
  explicit MatlabElements(const std::filesystem::path& path)
      : path_(path), file_(path, std::ios::binary), end_(std::filesystem::file_size(path)) {}

  void check() {
    // Files of MATLAB 4 have no header, those of 7.3 another one.
    if (end_ < kHeader) {
      return;
    }
    // Version 1.0 as a number of 16 bits, then the letters "MI" as one; in a file of the other byte order both are turned.
    static_assert(std::endian::native == std::endian::little);
    const std::uint32_t version = word(kHeader - sizeof version);
    other_order_ = version == 0x494D0001;
    if (version == 0x4D490100 || other_order_) {
      elements(kHeader, end_, 0);
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

  const std::filesystem::path& path_;
  std::ifstream file_;
  std::size_t end_;
  bool other_order_ = false;
};

}  // namespace

void require_matlab_layout(const std::filesystem::path& path) { MatlabElements(path).check(); }

}  // namespace hotfire
