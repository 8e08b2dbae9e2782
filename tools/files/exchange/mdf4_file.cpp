// SPDX-License-Identifier: Apache-2.0
#include "tools/files/exchange/mdf4_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <fstream>

#include "tools/files/exchange/mdf4_blocks.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/near_file.hpp"

namespace hotfire::mdf4 {

namespace {

/// The largest file and the most data after decompression: as many rows as a record may have, of 50 channels.
constexpr std::size_t kMostBytes = 4'000'000'000;

}  // namespace

File::File(const std::filesystem::path& path) : path_(path) {
  std::error_code failed;
  if (!std::filesystem::exists(path, failed)) {
    refuse("is not there" + near_file(path));
  }
  const std::uintmax_t size = std::filesystem::is_regular_file(path, failed) ? std::filesystem::file_size(path, failed) : 0;
  if (size < kIdentification || size > kMostBytes) {
    refuse(fmt::format("is not an MDF file of {} to {} bytes", kIdentification, kMostBytes));
  }
  bytes_.resize(size);
  if (!std::ifstream(path, std::ios::binary).read(bytes_.data(), static_cast<std::streamsize>(size))) {
    refuse("cannot be read");
  }
  const std::string_view kind = std::string_view(bytes_).substr(0, kFinalised.size());
  if (kind != kFinalised && kind != kUnfinalised) {
    refuse("does not begin as an MDF file");
  }
  if (bytes_[kFinalised.size()] != '4') {
    refuse(fmt::format("is of version {}; allowed: 4. Save it as MDF 4 with the program that has recorded it",
                       printable(std::string_view(bytes_).substr(kFinalised.size(), 4))));
  }
  if (kind == kUnfinalised) {
    undone_ = number<std::uint16_t>(bytes_, kUnfinalisedFlags);
    if ((undone_ & ~kReadUndone) != 0) {
      refuse(fmt::format("is not finalised, flags 0x{:x}; finalise it with the program that has recorded it", undone_));
    }
  }
}

void File::refuse(const std::string& problem) const { throw FileError(fmt::format("{}: {}", path_.string(), problem)); }

void File::refuse_at(std::uint64_t place, const std::string& problem) const {
  refuse(fmt::format("byte {}: {}; the file is damaged", place, problem));
}

void File::visit(std::uint64_t place) {
  if (!visited_.insert(place).second) {
    refuse_at(place, "a block that is linked to twice");
  }
}

Block File::block(std::uint64_t place, std::string_view wanted) const {
  const std::string_view all = bytes_;
  if (place > all.size() || all.size() - place < kBlockHeader || all.substr(place, 2) != "##") {
    refuse_at(place, "no block");
  }
  Block found{place, all.substr(place + 2, 2), {}, {}};
  if (!wanted.empty() && found.name != wanted) {
    refuse_at(place, fmt::format("a block \"{}\" instead of \"{}\"", printable(found.name), wanted));
  }
  std::uint64_t length = number<std::uint64_t>(all, place + 8);
  const auto links = number<std::uint64_t>(all, place + 16);
  const std::uint64_t rest = all.size() - place;
  // What was still being written when the program broke off goes on to the end of the file.
  const bool is_open = found.name == "DT" && (undone_ & kLastDataLength) != 0 && (length <= kBlockHeader || length > rest);
  length = is_open ? rest : length;
  if (length < kBlockHeader || length > rest || links > (length - kBlockHeader) / kLink) {
    refuse_at(place, fmt::format("a block \"{}\" that does not lie in the file", printable(found.name)));
  }
  found.links = all.substr(place + kBlockHeader, links * kLink);
  found.data = all.substr(place + kBlockHeader + links * kLink, length - kBlockHeader - links * kLink);
  return found;
}

std::string File::printable(std::string_view text) {
  std::string result(text);
  std::ranges::replace_if(
      result, [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
  return result;
}

std::uint64_t File::link(const Block& from, std::size_t which) const {
  return (which + 1) * kLink <= from.links.size() ? number<std::uint64_t>(from.links, which * kLink) : 0;
}

std::string File::text_at(std::uint64_t place) const {
  if (place == 0) {
    return {};
  }
  const Block found = block(place);
  std::string_view text = found.data.substr(0, found.data.find('\0'));
  if (found.name == "MD") {
    const std::size_t from = text.find("<TX>");
    const std::size_t to = text.find("</TX>");
    text = from != std::string_view::npos && to != std::string_view::npos && to > from ? text.substr(from + 4, to - from - 4)
                                                                                       : std::string_view{};
  } else if (found.name != "TX") {
    refuse_at(place, "no text");
  }
  return std::string(text);
}

std::string File::data_at(std::uint64_t place) {
  std::string data;
  if (place == 0) {
    return data;
  }
  Block found = block(place);
  if (found.name == "HL") {
    found = block(link(found, 0), "DL");
  }
  if (found.name != "DL") {
    append_data(found, data);
    return data;
  }
  for (;;) {
    visit(found.place);
    for (std::size_t i = 1; i < found.links.size() / kLink; ++i) {
      if (const std::uint64_t part = link(found, i); part != 0) {
        append_data(block(part), data);
      }
    }
    const std::uint64_t next = link(found, 0);
    if (next == 0) {
      return data;
    }
    found = block(next, "DL");
  }
}

void File::append_data(const Block& part, std::string& data) {
  visit(part.place);
  if (part.name == "DT") {
    require_room(data.size() + part.data.size(), part);
    data += part.data;
  } else if (part.name == "DZ") {
    data += unzipped(part, data.size());
  } else if (part.name == "DV" || part.name == "LD") {
    refuse("has its rows by channel, as MDF 4.2 may; save it as MDF 4.1 with the program that has recorded it");
  } else {
    refuse_at(part.place, fmt::format("a block \"{}\" where data are", printable(part.name)));
  }
}

void File::require_room(std::size_t bytes, const Block& part) const {
  if (bytes > kMostBytes) {
    refuse_at(part.place, fmt::format("more than {} bytes of data", kMostBytes));
  }
}

std::string File::unzipped(const Block& part, std::size_t before) const {
  constexpr std::size_t kHead = 24;
  constexpr std::uint64_t kMostGain = 1100;  // of deflate, whose most is 1032
  const auto kind = number<std::uint8_t>(part.data, 2);
  const auto columns = number<std::uint32_t>(part.data, 4);
  const auto size = number<std::uint64_t>(part.data, 8);
  const auto stored = number<std::uint64_t>(part.data, 16);
  if (part.data.substr(0, 2) != "DT" || kind > 1 || stored > part.data.size() - kHead || size / kMostGain > stored) {
    refuse_at(part.place, "a compressed block that is none of rows, or whose lengths do not agree");
  }
  require_room(before + size, part);
  std::string bytes(size, '\0');
  uLongf length = size;
  if (uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length, reinterpret_cast<const Bytef*>(part.data.data() + kHead),
                 stored) != Z_OK ||
      length != size) {
    refuse_at(part.place, "a compressed block that does not give its length");
  }
  if (kind == 0 || columns == 0) {
    return bytes;
  }
  // Transposed for compression: all first bytes of the rows, all second ones, ...; what is no whole row follows as it is.
  const std::size_t rows = size / columns;
  std::string turned = bytes;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      turned[row * columns + column] = bytes[column * rows + row];
    }
  }
  return turned;
}

}  // namespace hotfire::mdf4
