// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hotfire::mdf4 {

// The layout of ASAM MDF 4.1 (ASAM MCD-2, "Measurement Data Format", version 4.1.1), as far as records need it. Every block
// begins with its name, 4 reserved bytes, its length and its number of links, then come the links, then its data; all
// numbers are little-endian.

inline constexpr std::size_t kIdentification = 64;  ///< bytes; the header block follows
inline constexpr std::size_t kBlockHeader = 24;     ///< name, length, number of links
inline constexpr std::size_t kLink = 8;
inline constexpr std::uint16_t kVersion = 410;
inline constexpr std::string_view kFinalised = "MDF     ";
inline constexpr std::string_view kUnfinalised = "UnFinMF ";
inline constexpr std::size_t kUnfinalisedFlags = 60;  ///< place of the flags in the identification

/// What a program that broke off has left undone. Sample reductions and values of variable length are not read, and a list
/// of data without its last links ends at the last one.
enum UnfinalisedFlag : std::uint16_t {
  kCycleCounts = 1U << 0U,
  kReductionCounts = 1U << 1U,
  kLastDataLength = 1U << 2U,
  kLastReductionLength = 1U << 3U,
  kLastDataList = 1U << 4U,
  kLengthsOfAnyLength = 1U << 5U,
  kOffsetsOfAnyLength = 1U << 6U
};
/// What of it is read all the same.
inline constexpr unsigned kReadUndone = kCycleCounts | kReductionCounts | kLastDataLength | kLastReductionLength |
                                        kLastDataList | kLengthsOfAnyLength | kOffsetsOfAnyLength;

/// Flag of a channel group: its rows are values of any length, each behind its own length.
inline constexpr unsigned kRowsOfAnyLength = 1U << 0U;
/// Flags of a channel: none of its values holds; a bit of each row says whether its value does not.
inline constexpr unsigned kAllInvalid = 1U << 0U;
inline constexpr unsigned kHasInvalidBit = 1U << 1U;

/// Places of the links in their blocks, from 0.
enum HeaderLink { kFirstDataGroup, kFirstHistory };
enum DataGroupLink { kNextDataGroup, kFirstChannelGroup, kDataBlock };
enum ChannelGroupLink { kNextChannelGroup, kFirstChannel, kAcquisitionName };
enum ChannelLink { kNextChannel, kComposition, kNameText, kSourceText, kConversion, kSignalData, kUnitText };
enum ConversionLink { kConversionName, kConversionUnit };

enum class ChannelType : std::uint8_t { fixed_length = 0, master = 2, virtual_master = 3 };
enum class SyncType : std::uint8_t { none = 0, time = 1 };
enum class DataType : std::uint8_t {
  unsigned_little = 0,
  unsigned_big = 1,
  signed_little = 2,
  signed_big = 3,
  float_little = 4,
  float_big = 5
};
enum class ConversionType : std::uint8_t { identity = 0, linear = 1, rational = 2 };

}  // namespace hotfire::mdf4
