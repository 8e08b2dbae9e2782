// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>

#include "tools/files/exchange/exact_integer.hpp"
#include "tools/files/exchange/mdf4.hpp"
#include "tools/files/exchange/mdf4_blocks.hpp"
#include "tools/files/exchange/mdf4_file.hpp"

namespace hotfire {

namespace {

using namespace mdf4;

/// The most channels that lie within one another, as parts of a structure.
constexpr int kMostStructuresWithin = 16;

/// A channel group and its rows, one after the other.
struct Rows {
  Block group;
  std::uint64_t id = 0;
  std::uint64_t cycles = 0;       ///< as its program has counted them
  bool is_of_any_length = false;  ///< its rows are texts, each with its own length
  std::size_t data_bytes = 0;     ///< of a row, without its invalidation bits
  std::size_t row_bytes = 0;
  std::string bytes;
  std::size_t count = 0;
};

/// What a conversion makes of a raw value.
struct Conversion {
  ConversionType type = ConversionType::identity;
  std::array<double, 6> p{};

  double operator()(double x) const {
    switch (type) {
      case ConversionType::linear:
        return p[0] + p[1] * x;
      case ConversionType::rational:
        return (p[0] * x * x + p[1] * x + p[2]) / (p[3] * x * x + p[4] * x + p[5]);
      case ConversionType::identity:
        break;
    }
    return x;
  }
};

/// Where a channel's value is in a row.
struct Field {
  DataType type{};
  std::size_t byte = 0;
  std::size_t bytes = 0;
  unsigned first_bit = 0;
  unsigned bits = 0;

  bool is_float() const { return type == DataType::float_little || type == DataType::float_big; }
  bool is_known() const {
    return type <= DataType::float_big && bits > 0 && bits <= 64 && first_bit < 8 &&
           (!is_float() || (first_bit == 0 && (bits == 32 || bits == 64)));
  }
  /// Nothing for an integer that no double holds.
  std::optional<double> value_at(const char* row) const {
    std::array<unsigned char, 9> raw{};
    const bool is_big = type == DataType::unsigned_big || type == DataType::signed_big || type == DataType::float_big;
    for (std::size_t i = 0; i < std::min(bytes, raw.size()); ++i) {
      raw[i] = static_cast<unsigned char>(row[byte + (is_big ? bytes - 1 - i : i)]);
    }
    std::uint64_t low = 0;
    std::memcpy(&low, raw.data(), sizeof low);
    if (is_float()) {
      return bits == 64 ? std::bit_cast<double>(low)
                        : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(low)));
    }
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
      return std::nullopt;
    }
    return is_signed ? static_cast<double>(as_signed) : static_cast<double>(value);
  }
};

class Mdf4Reader {
 public:
  explicit Mdf4Reader(const std::filesystem::path& path) : file_(path) {}

  std::vector<ForeignGroup> read() {
    std::vector<ForeignGroup> groups;
    const Block header = file_.block(kIdentification, "HD");
    for (std::uint64_t at = file_.link(header, kFirstDataGroup); at != 0;) {
      file_.visit(at);
      const Block data_group = file_.block(at, "DG");
      for (const Rows& rows : rows_of(data_group)) {
        if (rows.row_bytes > 0 && !rows.is_of_any_length) {
          ForeignGroup& group = groups.emplace_back();
          group.name = file_.text_at(file_.link(rows.group, kAcquisitionName));
          read_channels(file_.link(rows.group, kFirstChannel), rows, 0, group);
        }
      }
      at = file_.link(data_group, kNextDataGroup);
    }
    return groups;
  }

 private:
  /// The channel groups of a data group with their rows. Where there are several ("unsorted"), each row begins with the id
  /// of its group.
  std::vector<Rows> rows_of(const Block& data_group) {
    std::vector<Rows> all;
    for (std::uint64_t at = file_.link(data_group, kFirstChannelGroup); at != 0;) {
      file_.visit(at);
      Rows& rows = all.emplace_back();
      rows.group = file_.block(at, "CG");
      rows.id = file_.number<std::uint64_t>(rows.group.data, 0);
      rows.cycles = file_.number<std::uint64_t>(rows.group.data, 8);
      rows.is_of_any_length = (file_.number<std::uint16_t>(rows.group.data, 16) & kRowsOfAnyLength) != 0;
      rows.data_bytes = file_.number<std::uint32_t>(rows.group.data, 24);
      rows.row_bytes = rows.data_bytes + file_.number<std::uint32_t>(rows.group.data, 28);
      at = file_.link(rows.group, kNextChannelGroup);
    }
    if (all.empty()) {
      return all;
    }
    const std::size_t id_bytes = file_.number<std::uint8_t>(data_group.data, 0);
    std::string data = file_.data_at(file_.link(data_group, kDataBlock));
    if (id_bytes > 0) {
      sort(data, id_bytes, all);
    } else if (all.size() > 1) {
      file_.refuse_at(data_group.place, "several groups, whose rows have no ids");
    } else {
      all.front().bytes = std::move(data);
    }
    for (Rows& rows : all) {
      count(rows);
    }
    return all;
  }

  void count(Rows& rows) const {
    if (rows.row_bytes == 0 || rows.is_of_any_length) {
      return;
    }
    const std::size_t whole = rows.bytes.size() / rows.row_bytes;
    const bool is_counted = (file_.undone() & kCycleCounts) == 0;
    if (is_counted && rows.cycles > whole) {
      file_.refuse_at(rows.group.place, fmt::format("{} rows, and bytes for {}", rows.cycles, whole));
    }
    rows.count = is_counted ? rows.cycles : whole;
  }

  /// Gives each row to its group. What is left at the end is part of a row that was still being written.
  void sort(const std::string& data, std::size_t id_bytes, std::vector<Rows>& all) const {
    if (id_bytes != 1 && id_bytes != 2 && id_bytes != 4 && id_bytes != 8) {
      file_.refuse(fmt::format("ids of rows have {} bytes; allowed: 1, 2, 4, 8; the file is damaged", id_bytes));
    }
    for (std::size_t at = 0; data.size() - at >= id_bytes;) {
      std::uint64_t id = 0;
      std::memcpy(&id, data.data() + at, id_bytes);
      const auto own = std::ranges::find(all, id, &Rows::id);
      if (own == all.end()) {
        file_.refuse(fmt::format("a row with the id {}, which no group has; the file is damaged", id));
      }
      at += id_bytes;
      std::size_t size = own->row_bytes;
      if (own->is_of_any_length) {
        constexpr std::size_t kLength = 4;
        if (data.size() - at < kLength) {
          return;
        }
        size = kLength + file_.number<std::uint32_t>(data, at);
      }
      if (data.size() - at < size) {
        return;
      }
      if (!own->is_of_any_length) {
        own->bytes.append(data, at, size);
      }
      at += size;
    }
  }

  /// A chain of channels, and the parts of those that are structures.
  void read_channels(std::uint64_t at, const Rows& rows, int nested, ForeignGroup& group) {
    if (nested > kMostStructuresWithin) {
      file_.refuse_at(at, fmt::format("channels within channels, more than {} deep", kMostStructuresWithin));
    }
    while (at != 0) {
      file_.visit(at);
      const Block channel = file_.block(at, "CN");
      const std::uint64_t parts = file_.link(channel, kComposition);
      const bool is_structure = parts != 0 && file_.block(parts).name == "CN";
      ForeignChannel result;
      result.name = file_.text_at(file_.link(channel, kNameText));
      result.unit = file_.text_at(file_.link(channel, kUnitText));
      if (parts != 0 && !is_structure) {
        result.problem = "an array; allowed: one number a row";
      } else {
        read_values(channel, rows, result);
      }
      group.channels.push_back(std::move(result));
      if (is_structure) {
        read_channels(parts, rows, nested + 1, group);
      }
      at = file_.link(channel, kNextChannel);
    }
  }

  void read_values(const Block& channel, const Rows& rows, ForeignChannel& result) const {
    const auto type = file_.number<ChannelType>(channel.data, 0);
    const auto sync = file_.number<SyncType>(channel.data, 1);
    result.is_time = (type == ChannelType::master || type == ChannelType::virtual_master) && sync == SyncType::time;
    const Conversion conversion = conversion_of(channel, result);
    if (!result.problem.empty()) {
      return;
    }
    if (type == ChannelType::virtual_master) {
      for (std::size_t row = 0; row < rows.count; ++row) {
        result.values.push_back(conversion(static_cast<double>(row)));
      }
      return;
    }
    const Field field = field_of(channel);
    if (type != ChannelType::fixed_length && type != ChannelType::master) {
      result.problem = fmt::format("a channel of type {}; allowed: values of fixed length", static_cast<int>(type));
    } else if (!field.is_known()) {
      result.problem = fmt::format("data type {} of {} bits; allowed: integers of up to 64 bits, floats of 32 and 64",
                                   static_cast<int>(field.type), field.bits);
    }
    if (!result.problem.empty()) {
      return;
    }
    if (field.byte > rows.row_bytes || field.bytes > rows.row_bytes - field.byte) {
      file_.refuse_at(channel.place, fmt::format("channel \"{}\" lies outside its rows", result.name));
    }
    const auto flags = file_.number<std::uint32_t>(channel.data, 12);
    const std::size_t invalid_bit = file_.number<std::uint32_t>(channel.data, 16);
    const std::size_t invalid_byte = rows.data_bytes + invalid_bit / 8;
    if ((flags & kHasInvalidBit) != 0 && invalid_byte >= rows.row_bytes) {
      file_.refuse_at(channel.place,
                      fmt::format("the invalidation bit of channel \"{}\" lies outside its rows", result.name));
    }
    result.values.reserve(rows.count);
    for (std::size_t row = 0; row < rows.count; ++row) {
      const char* const own = rows.bytes.data() + row * rows.row_bytes;
      const bool is_invalid =
          (flags & kAllInvalid) != 0 ||
          ((flags & kHasInvalidBit) != 0 && (static_cast<unsigned char>(own[invalid_byte]) >> (invalid_bit % 8) & 1U) != 0);
      const std::optional<double> value = field.value_at(own);
      if (!value) {
        result.problem = "an integer beyond 2^53, which no double holds";
        result.values.clear();
        return;
      }
      result.values.push_back(is_invalid ? std::numeric_limits<double>::quiet_NaN() : conversion(*value));
    }
  }

  /// The conversion of a channel; its unit is that of the channel unless that has one. Another one is the channel's problem.
  Conversion conversion_of(const Block& channel, ForeignChannel& result) const {
    Conversion conversion;
    const std::uint64_t at = file_.link(channel, kConversion);
    if (at == 0) {
      return conversion;
    }
    const Block block = file_.block(at, "CC");
    if (result.unit.empty()) {
      result.unit = file_.text_at(file_.link(block, kConversionUnit));
    }
    conversion.type = file_.number<ConversionType>(block.data, 0);
    std::size_t parameters = 0;
    switch (conversion.type) {
      case ConversionType::identity:
        break;
      case ConversionType::linear:
        parameters = 2;
        break;
      case ConversionType::rational:
        parameters = 6;
        break;
      default:
        result.problem = fmt::format("a conversion of type {}; allowed: 1:1, linear and rational. Export physical values",
                                     static_cast<int>(conversion.type));
    }
    constexpr std::size_t kFirstParameter = 24;
    for (std::size_t i = 0; i < parameters; ++i) {
      conversion.p[i] = file_.number<double>(block.data, kFirstParameter + i * sizeof(double));
    }
    return conversion;
  }

  Field field_of(const Block& channel) const {
    Field field;
    field.type = file_.number<DataType>(channel.data, 2);
    field.first_bit = file_.number<std::uint8_t>(channel.data, 3);
    field.byte = file_.number<std::uint32_t>(channel.data, 4);
    field.bits = file_.number<std::uint32_t>(channel.data, 8);
    field.bytes = (std::size_t{field.first_bit} + field.bits + 7) / 8;
    return field;
  }

  File file_;
};

}  // namespace

std::vector<ForeignGroup> read_mdf4(const std::filesystem::path& path) { return Mdf4Reader(path).read(); }

}  // namespace hotfire
