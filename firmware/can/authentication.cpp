// SPDX-License-Identifier: Apache-2.0
#include "firmware/can/authentication.hpp"

#include <algorithm>

#include "firmware/can/codec.hpp"

namespace hotfire::firmware::can {
namespace {

constexpr std::size_t kFreshnessBytes = 4;

template <std::size_t count>
std::array<std::uint8_t, count> bytes_of(std::uint64_t number) noexcept {
  std::array<std::uint8_t, count> bytes{};
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(number);
    number >>= 8;
  }
  return bytes;
}

std::uint32_t number_in(const std::uint8_t* bytes) noexcept {
  std::uint32_t number = 0;
  for (std::size_t i = kFreshnessBytes; i > 0; --i) {
    number = number << 8 | bytes[i - 1];
  }
  return number;
}

}  // namespace

Authentication::Authentication(const AuthenticationKey& key, std::int64_t tolerance_ns, RealTime real_time) noexcept
    : tolerance_us_(static_cast<std::uint64_t>(tolerance_ns / 1000)), real_time_(real_time) {
  cmac_aes128_set_key(&context_, key.data());
  // The first call of a library's function binds it and faults its pages in: here, not in the loop.
  Code code{};
  cmac_aes128_update(&context_, key.size(), key.data());
  cmac_aes128_digest(&context_, code.size(), code.data());
}

std::uint64_t Authentication::now_us() const noexcept { return static_cast<std::uint64_t>(real_time_() / 1000); }

Authentication::Code Authentication::code_of(const Message& message, std::uint64_t freshness_us,
                                             const hal::CanFrame& frame) noexcept {
  const auto data_id = bytes_of<sizeof message.data_id>(message.data_id);
  const auto freshness = bytes_of<sizeof freshness_us>(freshness_us);
  const std::size_t from = message.crc_bits / 8U;
  const std::size_t end = message.length - kCodeBytes - kFreshnessBytes;
  cmac_aes128_update(&context_, data_id.size(), data_id.data());
  cmac_aes128_update(&context_, freshness.size(), freshness.data());
  cmac_aes128_update(&context_, end - from, frame.data.data() + from);
  Code code{};
  cmac_aes128_digest(&context_, code.size(), code.data());
  return code;
}

void Authentication::seal(const Message& message, hal::CanFrame& frame) noexcept {
  last_us_ = std::max(now_us(), last_us_ + 1);
  const auto freshness = bytes_of<kFreshnessBytes>(last_us_);
  const Code code = code_of(message, last_us_, frame);
  std::uint8_t* const end = frame.data.data() + message.length;
  std::copy(freshness.begin(), freshness.end(), end - kCodeBytes - kFreshnessBytes);
  std::copy(code.begin(), code.end(), end - kCodeBytes);
  put_check(message, frame);
}

bool Authentication::accepts(const Message& message, const hal::CanFrame& frame, std::uint64_t& newest_us) noexcept {
  const std::uint8_t* const end = frame.data.data() + message.length;
  const std::uint64_t now = now_us();
  // The lower half that was sent belongs to the time that is nearest to now.
  const auto ahead =
      static_cast<std::int32_t>(number_in(end - kCodeBytes - kFreshnessBytes) - static_cast<std::uint32_t>(now));
  const std::uint64_t freshness_us = now + static_cast<std::uint64_t>(std::int64_t{ahead});
  const Code right = code_of(message, freshness_us, frame);
  // Every byte is looked at, so that the time it takes says nothing about where the first wrong one is.
  unsigned different = 0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    different |= static_cast<unsigned>(right[i] ^ (end - kCodeBytes)[i]);
  }
  const std::uint64_t distance = freshness_us > now ? freshness_us - now : now - freshness_us;
  if (different != 0 || distance > tolerance_us_ || freshness_us <= newest_us) {
    return false;
  }
  newest_us = freshness_us;
  return true;
}

}  // namespace hotfire::firmware::can
