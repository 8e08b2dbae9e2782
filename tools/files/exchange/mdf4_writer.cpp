// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "tools/files/exchange/mdf4.hpp"
#include "tools/files/exchange/mdf4_blocks.hpp"
#include "tools/files/exchange/xml_text.hpp"
#include "tools/files/text/whole_file.hpp"

namespace hotfire {

namespace {

using namespace mdf4;

static_assert(std::endian::native == std::endian::little);

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A file as its blocks are laid one after the other: each is written once all that it links to has its place.
class Blocks {
 public:
  explicit Blocks(std::size_t start) : start_(start) {}

  /// Appends a block and returns its place in the file.
  std::uint64_t add(std::string_view name, const std::vector<std::uint64_t>& links, const std::string& data) {
    const std::uint64_t place = start_ + bytes_.size();
    bytes_ += "##";
    bytes_ += name;
    append(bytes_, std::uint32_t{0});
    append(bytes_, static_cast<std::uint64_t>(kBlockHeader + kLink * links.size() + data.size()));
    append(bytes_, static_cast<std::uint64_t>(links.size()));
    for (const std::uint64_t link : links) {
      append(bytes_, link);
    }
    bytes_ += data;
    bytes_.append((kLink - bytes_.size() % kLink) % kLink, '\0');
    return place;
  }

  std::uint64_t add_text(std::string_view kind, const std::string& text) {
    std::string data = text;
    data.append(kLink - data.size() % kLink, '\0');
    return add(kind, {}, data);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  std::size_t start_;
  std::string bytes_;
};

std::string channel_data(ChannelType type, SyncType sync, std::size_t byte_offset) {
  std::string data;
  append(data, type);
  append(data, sync);
  append(data, DataType::float_little);
  append(data, std::uint8_t{0});  // first bit
  append(data, static_cast<std::uint32_t>(byte_offset));
  append(data, std::uint32_t{64});  // bits
  append(data, std::uint32_t{0});   // flags
  append(data, std::uint32_t{0});   // place of an invalidation bit
  append(data, std::uint32_t{0});   // precision, reserved, attachments
  for (int i = 0; i < 6; ++i) {
    append(data, 0.0);  // ranges, which no flag declares valid
  }
  return data;
}

std::string identification() {
  std::string bytes(kFinalised);
  bytes += "4.10    hotfire ";
  append(bytes, std::uint32_t{0});
  append(bytes, kVersion);
  bytes.resize(kIdentification, '\0');
  return bytes;
}

}  // namespace

void write_mdf4(const Record& record, const std::filesystem::path& path) {
  constexpr std::size_t kHeaderBlock = 104;
  Blocks blocks(kIdentification + kHeaderBlock);
  const std::uint64_t comment = blocks.add_text(
      "MD",
      "<FHcomment><TX>" + escaped(record.name) +
          "</TX><tool_id>hotfire</tool_id><tool_vendor>Hotfire</tool_vendor><tool_version>1</tool_version></FHcomment>");
  const std::uint64_t history = blocks.add("FH", {0, comment}, std::string(16, '\0'));

  // Channels from the last on: each links to the next.
  std::uint64_t next = 0;
  const std::size_t columns = record.channels.size() + 1;
  for (std::size_t column = columns; column-- > 0;) {
    const bool is_time = column == 0;
    const std::string& name = is_time ? std::string("time") : record.channels[column - 1].name;
    const std::uint64_t name_text = blocks.add_text("TX", name);
    const std::uint64_t unit_text = blocks.add_text("TX", is_time ? "s" : record.channels[column - 1].unit);
    next = blocks.add("CN", {next, 0, name_text, 0, 0, 0, unit_text, 0},
                      channel_data(is_time ? ChannelType::master : ChannelType::fixed_length,
                                   is_time ? SyncType::time : SyncType::none, column * sizeof(double)));
  }
  std::string group;
  append(group, std::uint64_t{0});  // record id
  append(group, static_cast<std::uint64_t>(record.rows));
  append(group, std::uint64_t{0});  // flags, path separator, reserved
  append(group, static_cast<std::uint32_t>(columns * sizeof(double)));
  append(group, std::uint32_t{0});  // bytes of invalidation bits
  const std::uint64_t name = blocks.add_text("TX", record.name);
  const std::uint64_t channels = blocks.add("CG", {0, next, name, 0, 0, 0}, group);
  std::string rows;
  rows.reserve(record.rows * columns * sizeof(double));
  const std::vector<double> times = times_of(record);
  for (std::size_t row = 0; row < record.rows; ++row) {
    append(rows, times[row]);
    for (const Channel& channel : record.channels) {
      append(rows, channel.values[row]);
    }
  }
  const std::uint64_t data = blocks.add("DT", {}, rows);
  const std::uint64_t data_group = blocks.add("DG", {0, channels, data, 0}, std::string(8, '\0'));

  Blocks header(kIdentification);
  header.add("HD", {data_group, history, 0, 0, 0, 0}, std::string(32, '\0'));
  WholeFile file(path);
  file.write(identification());
  file.write(header.bytes());
  file.write(blocks.bytes());
  file.commit();
}

}  // namespace hotfire
