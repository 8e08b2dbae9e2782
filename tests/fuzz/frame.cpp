// SPDX-License-Identifier: Apache-2.0
// libFuzzer harness of the frame decoder, run by tools/fuzz: no crash, and no frame is taken whose check is wrong.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "firmware/can/can_map.hpp"
#include "firmware/can/codec.hpp"
#include "tools/files/can/can_crc.hpp"

namespace hotfire::firmware::can {
namespace {

[[noreturn]] void fail(const Message& message, const char* what) {
  std::fprintf(stderr, "%s: %s\n", message.name.data(), what);
  std::abort();
}

std::uint16_t right_check(const Message& message, const hal::CanFrame& frame) {
  return can_crc(message.crc_bits).of_frame(frame.bytes(), message.data_id);
}

/// The frame that the fuzzer's bytes stand for: flags, length, message, data. Half of them get the right check, or the
/// fuzzer would rarely come past it.
hal::CanFrame frame_of(const std::uint8_t* bytes, std::size_t size, const Message& message) {
  hal::CanFrame frame;
  const unsigned flags = bytes[0];
  frame.id = {message.id ^ ((flags & 1U) != 0 ? bytes[1] : 0U), (flags & 2U) != 0};
  frame.fd = message.fd != ((flags & 4U) != 0);
  frame.length = (flags & 8U) != 0 ? bytes[1] % (hal::kMaxCanData + 1) : message.length;
  for (std::size_t i = 0; i < frame.length && i + 3 < size; ++i) {
    frame.data[i] = bytes[i + 3];
  }
  if ((flags & 16U) != 0 && frame.length >= 2) {
    const std::uint16_t check = right_check(message, frame);
    frame.data[0] = static_cast<std::uint8_t>(check);
    if (message.crc_bits == 16) {
      frame.data[1] = static_cast<std::uint8_t>(check >> 8);
    }
  }
  return frame;
}

void check_good(const Message& message, const hal::CanFrame& frame, std::span<const double> values, std::uint8_t counter) {
  const unsigned check = message.crc_bits == 8 ? frame.data[0] : frame.data[0] | frame.data[1] << 8;
  if (frame.id != hal::CanId{message.id, false} || frame.fd != message.fd || frame.length != message.length) {
    fail(message, "taken under another id, format or length");
  }
  if (check != right_check(message, frame)) {
    fail(message, "taken with a wrong check");
  }
  hal::CanFrame again;
  std::array<double, 32> values_again{};
  std::uint8_t counter_again = 0;
  if (!encode(message, values, counter, again) || decode(message, again, values_again, counter_again) != Decoding::good ||
      counter_again != counter) {
    fail(message, "what it says cannot be said again");
  }
  for (std::size_t i = 0; i < message.signals.size(); ++i) {
    if (values[i] != values_again[i]) {
      fail(message, "a value changes when it is said again");
    }
  }
}

}  // namespace
}  // namespace hotfire::firmware::can

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace hotfire::firmware::can;
  if (size < 3) {
    return 0;
  }
  const Message& message = *kMessages[bytes[2] % kMessages.size()];
  const hotfire::hal::CanFrame frame = frame_of(bytes, size, message);
  std::array<double, 32> values{};
  std::uint8_t counter = 0;
  if (decode(message, frame, values, counter) == Decoding::good) {
    check_good(message, frame, values, counter);
  }
  return 0;
}
