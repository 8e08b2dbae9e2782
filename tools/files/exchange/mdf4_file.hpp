// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>

namespace hotfire::mdf4 {

/// The part of a file that one block is.
struct Block {
  std::uint64_t place = 0;
  std::string_view name;
  std::string_view links;
  std::string_view data;
};

/// An MDF file in memory: its blocks, its texts and its data as one piece, whether they are in one block, in a list of
/// blocks or compressed. All throw FileError with the file and the place of the damage.
class File {
 public:
  /// Throws FileError for a file that is none of version 4, and for an unfinalised one of which it cannot be known where its
  /// data are.
  explicit File(const std::filesystem::path& path);

  [[noreturn]] void refuse(const std::string& problem) const;
  [[noreturn]] void refuse_at(std::uint64_t place, const std::string& problem) const;

  /// What its program has left undone: bits of `UnfinalisedFlag`.
  unsigned undone() const { return undone_; }

  /// The block at a place, of the name that is wanted if there is one.
  Block block(std::uint64_t place, std::string_view wanted = {}) const;
  /// A link that a block does not have leads nowhere, as one that is zero.
  std::uint64_t link(const Block& from, std::size_t which) const;
  /// A text, or what is between the tags <TX> of a comment.
  std::string text_at(std::uint64_t place) const;
  /// All data of a group: one block, a list of blocks, or a header of a list.
  std::string data_at(std::uint64_t place);
  /// A block of a chain or of data is part of one thing alone: a chain that closes on itself would have no end, and data
  /// that are used again no bound.
  void visit(std::uint64_t place);

  template <class T>
  T number(std::string_view bytes, std::size_t at) const {
    T value{};
    if (at > bytes.size() || bytes.size() - at < sizeof value) {
      refuse("a block is too short for its contents; the file is damaged");
    }
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  }

  /// Every letter that is not printable as "?", for messages.
  static std::string printable(std::string_view text);

 private:
  void append_data(const Block& part, std::string& data);
  void require_room(std::size_t bytes, const Block& part) const;
  std::string unzipped(const Block& part, std::size_t before) const;

  std::filesystem::path path_;
  std::string bytes_;
  unsigned undone_ = 0;
  std::set<std::uint64_t> visited_;
};

}  // namespace hotfire::mdf4
