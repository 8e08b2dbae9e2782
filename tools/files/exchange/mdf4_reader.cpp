// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <set>

#include "tools/files/exchange/exact_integer.hpp"
#include "tools/files/exchange/mdf4.hpp"
#include "tools/files/exchange/mdf4_blocks.hpp"
#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

using namespace mdf4;

/// The largest file and the most data after decompression: as many rows as a record may have, of 50 channels.
constexpr std::size_t kMostBytes = 4'000'000'000;

/// The part of a file that one block is.
struct Block {
  std::uint64_t place = 0;
  std::string_view name;
  std::string_view links;
  std::string_view data;
};

class Mdf4Reader {
 public:
  explicit Mdf4Reader(const std::filesystem::path& path) : path_(path) {
    std::error_code failed;
    const std::uintmax_t size =
        std::filesystem::is_regular_file(path, failed) ? std::filesystem::file_size(path, failed) : 0;
    if (size < kIdentification || size > kMostBytes) {
      refuse(fmt::format("is no MDF file of {} to {} bytes", kIdentification, kMostBytes));
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
      refuse(fmt::format("is of version {}; allowed: 4", std::string(bytes_, kFinalised.size(), 4)));
    }
    if (kind == kUnfinalised) {
      undone_ = number<std::uint16_t>(bytes_, kUnfinalisedFlags);
      if ((undone_ & ~(kCycleCounts | kLastDataLength)) != 0) {
        refuse(fmt::format("is not finalised, flags 0x{:x}; finalise it with the program that has recorded it", undone_));
      }
    }
  }

  std::vector<ForeignGroup> read() {
    std::vector<ForeignGroup> groups;
    const Block header = block(kIdentification, "HD");
    for (std::uint64_t at = link(header, kFirstDataGroup); at != 0;) {
      visit(at);
      const Block group = block(at, "DG");
      read_group(group, groups);
      at = link(group, kNextDataGroup);
    }
    return groups;
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const {
    throw FileError(fmt::format("{}: {}", path_.string(), problem));
  }
  [[noreturn]] void refuse_at(std::uint64_t place, const std::string& problem) const {
    refuse(fmt::format("byte {}: {}; the file is damaged", place, problem));
  }
  /// A block of a chain or of data is part of one thing alone: a chain that closes on itself would have no end, and data
  /// that are used again no bound.
  void visit(std::uint64_t place) {
    if (!visited_.insert(place).second) {
      refuse_at(place, "a block that is linked to twice");
    }
  }

  template <class T>
  T number(std::string_view bytes, std::size_t at) const {
    T value{};
    if (at > bytes.size() || bytes.size() - at < sizeof value) {
      refuse("a block is too short for what it holds; the file is damaged");
    }
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  }

  Block block(std::uint64_t place, std::string_view wanted = {}) const {
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

  static std::string printable(std::string_view text) {
    std::string result(text);
    std::ranges::replace_if(
        result, [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
    return result;
  }

  /// A link that a block does not have leads nowhere, as one that is zero.
  std::uint64_t link(const Block& from, std::size_t which) const {
    return (which + 1) * kLink <= from.links.size() ? number<std::uint64_t>(from.links, which * kLink) : 0;
  }

  /// A text, or what is between the tags <TX> of a comment.
  std::string text_at(std::uint64_t place) const {
    if (place == 0) {
      return {};
    }
    const Block found = block(place);
    std::string_view text = found.data.substr(0, found.data.find('\0'));
    if (found.name == "MD") {
      const std::size_t from = text.find("<TX>");
      const std::size_t to = text.find("</TX>");
      text = from != std::string_view::npos && to != std::string_view::npos && to > from
                 ? text.substr(from + 4, to - from - 4)
                 : std::string_view{};
    } else if (found.name != "TX") {
      refuse_at(place, "no text");
    }
    return std::string(text);
  }

  void read_group(const Block& data_group, std::vector<ForeignGroup>& groups) {
    const std::uint64_t first = link(data_group, kFirstChannelGroup);
    if (first == 0) {
      return;
    }
    const Block group = block(first, "CG");
    if (link(group, kNextChannelGroup) != 0 || number<std::uint8_t>(data_group.data, 0) != 0) {
      refuse_at(group.place,
                "rows of several groups in one block (unsorted): sort it with the program that has recorded it");
    }
    const auto cycles = number<std::uint64_t>(group.data, 8);
    const std::size_t row_bytes = std::size_t{number<std::uint32_t>(group.data, 24)} + number<std::uint32_t>(group.data, 28);
    if (row_bytes == 0) {
      return;
    }
    const std::string rows = data_at(link(data_group, kDataBlock));
    const std::size_t whole = rows.size() / row_bytes;
    if ((undone_ & kCycleCounts) == 0 && cycles > whole) {
      refuse_at(group.place, fmt::format("{} rows, and bytes for {}", cycles, whole));
    }
    const std::size_t count = (undone_ & kCycleCounts) != 0 ? whole : cycles;
    ForeignGroup& result = groups.emplace_back();
    result.name = text_at(link(group, kAcquisitionName));
    for (std::uint64_t at = link(group, kFirstChannel); at != 0;) {
      visit(at);
      const Block channel = block(at, "CN");
      result.channels.push_back(read_channel(channel, rows, row_bytes, count));
      at = link(channel, kNextChannel);
    }
  }

  /// All data of a group: one block, a list of blocks, or a header of a list.
  std::string data_at(std::uint64_t place) {
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

  void append_data(const Block& part, std::string& data) {
    visit(part.place);
    if (part.name == "DT") {
      require_room(data.size() + part.data.size(), part);
      data += part.data;
    } else if (part.name == "DZ") {
      data += unzipped(part, data.size());
    } else {
      refuse_at(part.place, fmt::format("a block \"{}\" where data are", printable(part.name)));
    }
  }

  void require_room(std::size_t bytes, const Block& part) const {
    if (bytes > kMostBytes) {
      refuse_at(part.place, fmt::format("more than {} bytes of data", kMostBytes));
    }
  }

  std::string unzipped(const Block& part, std::size_t before) const {
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

  ForeignChannel read_channel(const Block& channel, const std::string& rows, std::size_t row_bytes,
                              std::size_t count) const {
    ForeignChannel result;
    result.name = text_at(link(channel, kNameText));
    result.unit = text_at(link(channel, kUnitText));
    const auto type = number<ChannelType>(channel.data, 0);
    const auto sync = number<SyncType>(channel.data, 1);
    result.is_time = (type == ChannelType::master || type == ChannelType::virtual_master) && sync == SyncType::time;
    double offset = 0.0;
    double factor = 1.0;
    if (const std::uint64_t at = link(channel, kConversion); at != 0) {
      const Block conversion = block(at, "CC");
      const auto kind = number<ConversionType>(conversion.data, 0);
      if (kind == ConversionType::linear) {
        offset = number<double>(conversion.data, 24);
        factor = number<double>(conversion.data, 32);
      } else if (kind != ConversionType::identity) {
        refuse(fmt::format("channel \"{}\": a conversion of type {}; allowed: 1:1 and linear. Export physical values",
                           result.name, static_cast<int>(kind)));
      }
      if (result.unit.empty()) {
        result.unit = text_at(link(conversion, kConversionUnit));
      }
    }
    if (type == ChannelType::virtual_master) {
      for (std::size_t row = 0; row < count; ++row) {
        result.values.push_back(offset + factor * static_cast<double>(row));
      }
      return result;
    }
    if (type != ChannelType::fixed_length && type != ChannelType::master) {
      refuse(fmt::format("channel \"{}\": type {}; allowed: values of fixed length", result.name, static_cast<int>(type)));
    }
    const Field field = field_of(channel, result.name, row_bytes);
    result.values.reserve(count);
    for (std::size_t row = 0; row < count; ++row) {
      const double value = field.value_at(rows.data() + row * row_bytes, *this, result.name);
      result.values.push_back(factor == 1.0 && offset == 0.0 ? value : offset + factor * value);
    }
    return result;
  }

  /// Where a channel's value is in a row.
  struct Field {
    DataType type{};
    std::size_t byte = 0;
    std::size_t bytes = 0;
    unsigned first_bit = 0;
    unsigned bits = 0;

    double value_at(const char* row, const Mdf4Reader& reader, const std::string& name) const {
      std::array<unsigned char, 9> raw{};
      const bool is_big = type == DataType::unsigned_big || type == DataType::signed_big || type == DataType::float_big;
      for (std::size_t i = 0; i < std::min(bytes, raw.size()); ++i) {
        raw[i] = static_cast<unsigned char>(row[byte + (is_big ? bytes - 1 - i : i)]);
      }
      if (type == DataType::float_little || type == DataType::float_big) {
        std::uint64_t pattern = 0;
        std::memcpy(&pattern, raw.data(), sizeof pattern);
        return bits == 64 ? std::bit_cast<double>(pattern)
                          : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(pattern)));
      }
      std::uint64_t low = 0;
      std::memcpy(&low, raw.data(), sizeof low);
      std::uint64_t value = first_bit == 0 ? low : low >> first_bit | std::uint64_t{raw[8]} << (64U - first_bit);
      const bool is_signed = type == DataType::signed_little || type == DataType::signed_big;
      if (bits < 64) {
        value &= (std::uint64_t{1} << bits) - 1;
        if (is_signed && (value >> (bits - 1) & 1U) != 0) {
          value |= ~((std::uint64_t{1} << bits) - 1);
        }
      }
      const auto as_signed = static_cast<std::int64_t>(value);
      if (is_signed ? !is_exact(as_signed) : !is_exact(value)) {
        reader.refuse(fmt::format("channel \"{}\": an integer beyond 2^53, which no double holds", name));
      }
      return is_signed ? static_cast<double>(as_signed) : static_cast<double>(value);
    }
  };

  Field field_of(const Block& channel, const std::string& name, std::size_t row_bytes) const {
    Field field;
    field.type = number<DataType>(channel.data, 2);
    field.first_bit = number<std::uint8_t>(channel.data, 3);
    field.byte = number<std::uint32_t>(channel.data, 4);
    field.bits = number<std::uint32_t>(channel.data, 8);
    const bool is_float = field.type == DataType::float_little || field.type == DataType::float_big;
    const bool is_known = field.type <= DataType::float_big && field.bits > 0 && field.bits <= 64 && field.first_bit < 8 &&
                          (!is_float || (field.first_bit == 0 && (field.bits == 32 || field.bits == 64)));
    if (!is_known) {
      refuse(fmt::format("channel \"{}\": data type {} of {} bits; allowed: integers of up to 64 bits, floats of 32 and 64",
                         name, static_cast<int>(field.type), field.bits));
    }
    field.bytes = (field.first_bit + field.bits + 7) / 8;
    if (field.byte > row_bytes || field.bytes > row_bytes - field.byte) {
      refuse_at(channel.place, fmt::format("channel \"{}\" lies outside its rows", name));
    }
    return field;
  }

  std::filesystem::path path_;
  std::string bytes_;
  unsigned undone_ = 0;
  std::set<std::uint64_t> visited_;
};

}  // namespace

std::vector<ForeignGroup> read_mdf4(const std::filesystem::path& path) { return Mdf4Reader(path).read(); }

}  // namespace hotfire
