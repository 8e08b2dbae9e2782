// SPDX-License-Identifier: Apache-2.0
#include "tools/files/import/foreign.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "tools/files/exchange/mdf4.hpp"
#include "tools/files/exchange/mdf4_blocks.hpp"
#include "tools/files/import/guess.hpp"

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"

namespace hotfire {

using test::expect_message;
using test::refusal;

namespace {

/// Numbers that a decimal text or a float would change.
Record record_of(std::vector<std::string> names) {
  Record record{"", "run", 0.25, 1e-3, 1000, {}};
  double number = 1.0 / 3.0;
  for (std::string& name : names) {
    Channel channel{std::move(name), "", {}};
    channel.unit = channel.name.starts_with("piston") ? "m" : channel.name.starts_with("load") ? "Pa" : "rad";
    for (std::size_t row = 0; row < record.rows; ++row) {
      channel.values.push_back(number);
      number = std::nextafter(-1.01 * number, 2.0);
      number = std::abs(number) > 1e3 ? 1e-3 / 7.0 : number;
    }
    record.channels.push_back(std::move(channel));
  }
  return record;
}

template <class T>
void put(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}
template <class T>
T get(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::size_t place_of(const std::string& bytes, const std::string& block, std::size_t which = 0) {
  std::size_t at = bytes.find("##" + block);
  for (; which > 0; --which) {
    at = bytes.find("##" + block, at + 1);
  }
  return at;
}

}  // namespace

TEST_GROUP(Foreign) {
  test::Scratch scratch;
  Record record = record_of({"command", "piston", "engine"});

  /// The bytes of the record as an MDF file.
  std::string mdf() const {
    write_mdf4(record, scratch.path("run.mf4"));
    std::ifstream file(scratch.path("run.mf4"), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::vector<ForeignChannel> channels_of(const std::string& bytes) const {
    return read_mdf4(scratch.write("changed.mf4", bytes)).front().channels;
  }
  std::string refusal_of(const std::string& bytes) const {
    const auto path = scratch.write("changed.mf4", bytes);
    return refusal([&] { read_mdf4(path); });
  }
};

TEST(Foreign, RecordComesBackFromEveryFormatBitForBit) {
  for (const Record& written : {record, record_of({"command.pitch", "piston.pitch", "load_pressure.yaw", "engine.yaw"})}) {
    for (const std::string& extension : foreign_extensions()) {
      const auto path = scratch.path("run" + extension);
      write_foreign(written, path);
      const Record read = load_foreign(path);
      UNSIGNED_LONGS_EQUAL(written.rows, read.rows);
      DOUBLES_EQUAL(written.start, read.start, 0.0);
      DOUBLES_EQUAL(written.period, read.period, 1e-15);
      UNSIGNED_LONGS_EQUAL(written.channels.size(), read.channels.size());
      for (const Channel& channel : written.channels) {
        const Channel* const other = read.find(channel.name);
        CHECK(other != nullptr);
        STRCMP_EQUAL(channel.unit.c_str(), other->unit.c_str());
        CHECK(channel.values == other->values);
      }
    }
  }
}

TEST(Foreign, FileThatCannotBeWrittenIsSaidAndNothingIsLeft) {
  for (const std::string& extension : foreign_extensions()) {
    const auto path = scratch.path("no-such-folder") / ("run" + extension);
    expect_message(refusal([&] { write_foreign(record, path); }), {"cannot be written"});
  }
}

TEST(Foreign, ChannelsOfOtherNamesAreForImport) {
  record.channels.back().name = "flow";
  for (const std::string& extension : foreign_extensions()) {
    const auto path = scratch.path("run" + extension);
    write_foreign(record, path);
    expect_message(refusal([&] { load_foreign(path); }), {"flow", "none of a record", "hotfire import"});
    if (extension == ".mat") {
      continue;
    }
    ImportMap map;
    map.columns = {{"time", "time", "s"}, {"command", "command", "rad"}, {"engine", "flow", "rad", 2.0}};
    const Record imported = import_record(path, map, scratch.path("imported.csv"));
    DOUBLES_EQUAL(2.0 * record.channels.back().values[5], imported.find("engine")->values[5], 0.0);
    map.columns.back().column = "floww";
    expect_message(refusal([&] { import_record(path, map, scratch.path("imported.csv")); }),
                   {"no channel \"floww\" for engine", "did you mean \"flow\""});
  }
}

TEST(Foreign, MdfThatItsProgramBrokeOffIsReadUpToTheLastWholeRow) {
  std::string bytes = mdf();
  const std::size_t row_bytes = 4 * sizeof(double);
  std::string rows = bytes.substr(place_of(bytes, "DT") + mdf4::kBlockHeader, record.rows * row_bytes);
  // Data come last in a file that is still being written.
  const std::uint64_t end = bytes.size();
  std::string block = "##DT" + std::string(20, '\0');
  put<std::uint64_t>(block, 8, mdf4::kBlockHeader);
  bytes += block + rows.substr(0, 700 * row_bytes + 5);
  put<std::uint64_t>(bytes, place_of(bytes, "DG") + mdf4::kBlockHeader + mdf4::kDataBlock * mdf4::kLink, end);
  put<std::uint64_t>(bytes, place_of(bytes, "CG") + mdf4::kBlockHeader + 6 * mdf4::kLink + 8, 0);
  std::memcpy(bytes.data(), "UnFinMF ", 8);
  put<std::uint16_t>(bytes, mdf4::kUnfinalisedFlags, mdf4::kCycleCounts | mdf4::kLastDataLength);
  const auto channels = channels_of(bytes);
  UNSIGNED_LONGS_EQUAL(700, channels.back().values.size());
  DOUBLES_EQUAL(record.channels.back().values[699], channels.back().values[699], 0.0);
  put<std::uint16_t>(bytes, mdf4::kUnfinalisedFlags, 1U << 7U);
  expect_message(refusal_of(bytes), {"not finalised", "the program that has recorded it"});
}

TEST(Foreign, MdfOfCompressedAndTransposedBlocksIsTheSame) {
  for (const bool transposed : {false, true}) {
    std::string bytes = mdf();
    const std::size_t columns = 4 * sizeof(double);
    const std::string rows = bytes.substr(place_of(bytes, "DT") + mdf4::kBlockHeader, record.rows * columns);
    std::string plain = rows;
    for (std::size_t i = 0; transposed && i < rows.size(); ++i) {
      plain[i % columns * record.rows + i / columns] = rows[i];
    }
    std::string small(compressBound(plain.size()), '\0');
    uLongf length = small.size();
    LONGS_EQUAL(Z_OK, compress(reinterpret_cast<Bytef*>(small.data()), &length, reinterpret_cast<const Bytef*>(plain.data()),
                               plain.size()));
    small.resize(length);
    const std::uint64_t end = bytes.size();
    std::string block = "##DZ" + std::string(44, '\0');
    put<std::uint64_t>(block, 8, block.size() + small.size());
    std::memcpy(block.data() + 24, "DT", 2);
    put<std::uint8_t>(block, 26, transposed ? 1 : 0);
    put<std::uint32_t>(block, 28, static_cast<std::uint32_t>(columns));
    put<std::uint64_t>(block, 32, plain.size());
    put<std::uint64_t>(block, 40, small.size());
    bytes += block + small;
    put<std::uint64_t>(bytes, place_of(bytes, "DG") + mdf4::kBlockHeader + mdf4::kDataBlock * mdf4::kLink, end);
    const auto channels = channels_of(bytes);
    CHECK(channels[1].values == record.channels[0].values);
    CHECK(channels[3].values == record.channels[2].values);
    put<std::uint64_t>(bytes, end + 32, std::uint64_t{1} << 40U);
    expect_message(refusal_of(bytes), {"lengths do not agree"});
  }
}

TEST(Foreign, MdfIntegersOfAnyBitsAndByteOrderWithALinearConversion) {
  std::string bytes = mdf();
  // The last channel, its doubles taken apart: 12 bits from bit 3 on, signed, in both byte orders.
  const std::size_t channel = place_of(bytes, "CN", 0);
  const std::size_t data = channel + mdf4::kBlockHeader + 8 * mdf4::kLink;
  const std::size_t values = place_of(bytes, "DT") + mdf4::kBlockHeader + 3 * sizeof(double);
  const std::uint64_t end = bytes.size();
  std::string conversion = "##CC" + std::string(20 + 4 * mdf4::kLink + 24 + 16, '\0');
  put<std::uint64_t>(conversion, 8, conversion.size());
  put<std::uint64_t>(conversion, 16, 4);
  const std::size_t law = mdf4::kBlockHeader + 4 * mdf4::kLink;
  put(conversion, law, mdf4::ConversionType::linear);
  put(conversion, law + 24, 10.0);
  put(conversion, law + 32, 0.5);
  bytes += conversion;
  put<std::uint64_t>(bytes, channel + mdf4::kBlockHeader + mdf4::kConversion * mdf4::kLink, end);
  put<std::uint8_t>(bytes, data + 3, 3);
  put<std::uint32_t>(bytes, data + 8, 12);
  for (const bool is_big : {false, true}) {
    put(bytes, data + 2, is_big ? mdf4::DataType::signed_big : mdf4::DataType::signed_little);
    for (const int value : {-2048, -1, 0, 1, 2047}) {
      const auto raw = static_cast<std::uint16_t>((static_cast<unsigned>(value) & 0xfffU) << 3U | 0x8005U);
      put<std::uint16_t>(bytes, values, is_big ? __builtin_bswap16(raw) : raw);
      DOUBLES_EQUAL(10.0 + 0.5 * value, channels_of(bytes).back().values.front(), 0.0);
    }
  }
  put<std::uint8_t>(bytes, data + 3, 0);
  put<std::uint32_t>(bytes, data + 8, 64);
  put(bytes, data + 2, mdf4::DataType::unsigned_little);
  constexpr std::uint64_t kLargestExact = std::uint64_t{1} << 53U;
  for (std::size_t row = 0; row < record.rows; ++row) {
    put(bytes, values + 4 * row * sizeof(double), kLargestExact);
  }
  DOUBLES_EQUAL(10.0 + 0.5 * 9007199254740992.0, channels_of(bytes).back().values.front(), 0.0);
  put(bytes, values, kLargestExact + 1);
  STRCMP_CONTAINS("beyond 2^53", channels_of(bytes).back().problem.c_str());
  put<std::uint32_t>(bytes, data + 8, 12);
  put<std::uint8_t>(bytes, data + 3, 3);
  put(bytes, data + 2, mdf4::DataType::float_little);
  STRCMP_CONTAINS("data type 4 of 12 bits", channels_of(bytes).back().problem.c_str());
  put<std::uint8_t>(bytes, data + 3, 0);
  put<std::uint32_t>(bytes, data + 8, 32);
  put(bytes, values, 0.75F);
  DOUBLES_EQUAL(10.375, channels_of(bytes).back().values.front(), 0.0);
  put(bytes, end + law, std::uint8_t{7});
  // What cannot be read is of matter only where it is wanted.
  const auto channels = channels_of(bytes);
  STRCMP_CONTAINS("a conversion of type 7", channels.back().problem.c_str());
  CHECK(channels[1].values == record.channels[0].values);
  ImportMap map;
  map.columns = {{"time", "time", "s"}, {"command", "command", "rad"}};
  const auto changed = scratch.path("changed.mf4");
  CHECK(import_record(changed, map, scratch.path("imported.csv")).find("command")->values == record.channels[0].values);
  map.columns.push_back({"engine", "engine", "rad"});
  expect_message(refusal([&] { import_record(changed, map, scratch.path("imported.csv")); }),
                 {"changed.mf4", "\"engine\" for engine", "a conversion of type 7"});
}

TEST(Foreign, MdfRationalConversionIsTheQuotientOfItsPolynomials) {
  std::string bytes = mdf();
  const std::uint64_t end = bytes.size();
  const std::size_t law = mdf4::kBlockHeader + 4 * mdf4::kLink;
  std::string conversion = "##CC" + std::string(law - 4 + 24 + 6 * sizeof(double), '\0');
  put<std::uint64_t>(conversion, 8, conversion.size());
  put<std::uint64_t>(conversion, 16, 4);
  put(conversion, law, mdf4::ConversionType::rational);
  const std::array p{1.0, 2.0, 3.0, 0.0, 0.5, 4.0};
  for (std::size_t i = 0; i < p.size(); ++i) {
    put(conversion, law + 24 + i * sizeof(double), p[i]);
  }
  bytes += conversion;
  put<std::uint64_t>(bytes, place_of(bytes, "CN") + mdf4::kBlockHeader + mdf4::kConversion * mdf4::kLink, end);
  const double x = record.channels.back().values[7];
  DOUBLES_EQUAL((x * x + 2.0 * x + 3.0) / (0.5 * x + 4.0), channels_of(bytes).back().values[7], 0.0);
}

TEST(Foreign, MdfValueThatItsInvalidationBitTakesBackIsMissing) {
  std::string bytes = mdf();
  // A ninth byte group: one byte of bits behind the doubles of each row, of which bit 3 is that of the last channel.
  const std::size_t doubles = 4 * sizeof(double);
  std::string rows;
  for (std::size_t row = 0; row < record.rows; ++row) {
    rows += bytes.substr(place_of(bytes, "DT") + mdf4::kBlockHeader + row * doubles, doubles);
    rows += row == 5 ? '\x08' : '\x77';
  }
  const std::uint64_t end = bytes.size();
  std::string block = "##DT" + std::string(20, '\0') + rows;
  put<std::uint64_t>(block, 8, block.size());
  bytes += block;
  const std::size_t group = place_of(bytes, "CG") + mdf4::kBlockHeader + 6 * mdf4::kLink;
  put<std::uint32_t>(bytes, group + 28, 1);
  put<std::uint64_t>(bytes, place_of(bytes, "DG") + mdf4::kBlockHeader + mdf4::kDataBlock * mdf4::kLink, end);
  const std::size_t data = place_of(bytes, "CN") + mdf4::kBlockHeader + 8 * mdf4::kLink;
  put<std::uint32_t>(bytes, data + 12, mdf4::kHasInvalidBit);
  put<std::uint32_t>(bytes, data + 16, 3);
  const auto values = channels_of(bytes).back().values;
  CHECK(std::isnan(values[5]));
  UNSIGNED_LONGS_EQUAL(1, std::ranges::count_if(values, [](double value) { return std::isnan(value); }));
  DOUBLES_EQUAL(record.channels.back().values[6], values[6], 0.0);
  put<std::uint32_t>(bytes, data + 16, 8);
  expect_message(refusal_of(bytes), {"invalidation bit", "engine", "damaged"});
}

TEST(Foreign, MdfRowsWithIdsAreThoseOfTheirGroup) {
  std::string bytes = mdf();
  const std::size_t row_bytes = 4 * sizeof(double);
  const std::string plain = bytes.substr(place_of(bytes, "DT") + mdf4::kBlockHeader, record.rows * row_bytes);
  // Between the rows stand texts of a second group, each behind its length.
  const std::size_t group = place_of(bytes, "CG");
  const std::uint64_t texts_at = bytes.size();
  std::string texts = "##CG" + std::string(4 + 16 + 6 * mdf4::kLink + 32, '\0');
  put<std::uint64_t>(texts, 8, texts.size());
  put<std::uint64_t>(texts, 16, 6);
  put<std::uint64_t>(texts, mdf4::kBlockHeader + 6 * mdf4::kLink, 9);
  put<std::uint16_t>(texts, mdf4::kBlockHeader + 6 * mdf4::kLink + 16, mdf4::kRowsOfAnyLength);
  bytes += texts;
  put<std::uint64_t>(bytes, group + mdf4::kBlockHeader, texts_at);
  std::string rows;
  for (std::size_t row = 0; row < record.rows; ++row) {
    rows += std::string("\0\0", 2) + plain.substr(row * row_bytes, row_bytes);
    rows += row % 3 == 0 ? std::string("\x09\0\x02\0\0\0ab", 8) : std::string();
  }
  const auto with_rows = [&](const std::string& data) {
    std::string whole = bytes;
    std::string block = "##DT" + std::string(20, '\0') + data;
    put<std::uint64_t>(block, 8, block.size());
    put<std::uint64_t>(whole, place_of(whole, "DG") + mdf4::kBlockHeader + mdf4::kDataBlock * mdf4::kLink, whole.size());
    put<std::uint8_t>(whole, place_of(whole, "DG") + mdf4::kBlockHeader + 4 * mdf4::kLink, 2);
    return whole + block;
  };
  const auto channels = channels_of(with_rows(rows));
  CHECK(channels[1].values == record.channels[0].values);
  CHECK(channels[3].values == record.channels[2].values);
  expect_message(refusal_of(with_rows(rows.substr(0, rows.size() - row_bytes))), {"1000 rows, and bytes for 999"});
  std::string stray = rows;
  stray[0] = 5;
  expect_message(refusal_of(with_rows(stray)), {"id 5", "damaged"});
  // Cut anywhere, in the middle of an id or of a length: refused for the rows that are missing, and read to no other end.
  for (std::size_t cut = 1; cut < 3 * row_bytes; ++cut) {
    CHECK(!refusal_of(with_rows(rows.substr(0, rows.size() - 8 - cut))).empty());
  }
  std::string without_ids = with_rows(rows);
  put<std::uint8_t>(without_ids, place_of(without_ids, "DG") + mdf4::kBlockHeader + 4 * mdf4::kLink, 0);
  expect_message(refusal_of(without_ids), {"several groups", "damaged"});
}

TEST(Foreign, FirstMapOfAForeignFileHasItsChannelsWithTheirUnits) {
  record = record_of({"command", "stroke of \"the\" ram", "note"});
  record.channels[1].unit = "mm";
  for (const std::string extension : {".mf4", ".h5"}) {
    const auto path = scratch.path("foreign" + extension);
    write_foreign(record, path);
    const auto map_path = scratch.write("map.toml", guessed_map(path));
    const ImportMap map = load_import_map(map_path, ImportSource::table);
    const Record imported = import_record(path, map, scratch.path("imported.csv"));
    CHECK(imported.find("command")->values == record.channels[0].values);
    DOUBLES_EQUAL(1e-3 * record.channels[1].values[9], imported.find("piston")->values[9], 1e-12);
    CHECK(imported.find("note") == nullptr);
  }
}

TEST(Foreign, MdfThatIsDamagedAnywhereIsRefusedOrReadAndNothingElse) {
  record = record_of({"command", "piston"});
  record.rows = 3;
  for (Channel& channel : record.channels) {
    channel.values.resize(record.rows);
  }
  const std::string whole = mdf();
  std::size_t refused = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    refused += refusal_of(whole.substr(0, size)).empty() ? 0 : 1;
  }
  // What lies behind the last link alone may be cut off.
  CHECK(refused > whole.size() / 2);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const unsigned char flip : {0x01, 0x80, 0xff}) {
      std::string changed = whole;
      changed[at] = static_cast<char>(static_cast<unsigned char>(changed[at]) ^ flip);
      refusal_of(changed);
    }
  }
  std::string circle = whole;
  const std::size_t group = place_of(circle, "DG");
  put<std::uint64_t>(circle, place_of(circle, "CN") + mdf4::kBlockHeader, place_of(circle, "CN"));
  expect_message(refusal_of(circle), {"linked to twice", "damaged"});
  put<std::uint64_t>(circle, group + mdf4::kBlockHeader, std::numeric_limits<std::uint64_t>::max());
  CHECK(!refusal_of(circle).empty());
}

TEST(Foreign, DamagedHdf5AndMatlabFilesAreRefusedWithTheirName) {
  for (const std::string extension : {".h5", ".mat"}) {
    const auto path = scratch.path("run" + extension);
    write_foreign(record, path);
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    expect_message(refusal([&] { load_foreign(path); }), {("run" + extension).c_str()});
    scratch.write("text" + extension, "time[s],command[rad]\n");
    expect_message(refusal([&] { load_foreign(scratch.path("text" + extension)); }), {("text" + extension).c_str()});
  }
}

}  // namespace hotfire
