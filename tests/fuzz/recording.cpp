// SPDX-License-Identifier: Apache-2.0
// libFuzzer harness of the readers of recordings. The first byte says which checksums are put right, or the fuzzer would
// rarely come past them: 1 of the header, 2 of the model, 4 of the blocks.

#include <cstdint>
#include <cstdio>
#include <cstring>

#include "firmware/image/plant_image.hpp"
#include "firmware/lab/lab_image.hpp"
#include "hal/recording/header.hpp"
#include "hal/recording/reader.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tools/files/record/recording.hpp"

namespace hotfire::fuzz {
namespace {

constexpr std::size_t kDigits = 16;

void put_hash(std::string& text, const std::string& key, std::uint64_t hash) {
  const std::size_t at = text.find(key);
  if (at == std::string::npos || at + key.size() + kDigits > text.size()) {
    return;
  }
  char digits[kDigits + 1];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
  text.replace(at + key.size(), kDigits, digits);
}

std::string model_of(const std::string& text) {
  constexpr std::string_view kKey = "\nmodel ";
  std::string model;
  for (std::size_t at = text.find(kKey); at != std::string::npos; at = text.find(kKey, at + 1)) {
    const std::size_t from = at + kKey.size();
    model += text.substr(from, std::min(text.find('\n', from), text.size()) - from) + "\n";
  }
  return model;
}

/// Puts the checksums of all blocks right from where the header ends; `cycle_bytes` is what it says.
void put_block_sums(std::string& text, std::size_t at, std::size_t cycle_bytes) {
  hal::BlockHead head;
  while (at + sizeof head <= text.size()) {
    std::memcpy(&head, text.data() + at, sizeof head);
    const std::size_t size = head.cycles * cycle_bytes;
    if (head.cycles > hal::kMostCyclesOfBlock || at + sizeof head + size > text.size()) {
      return;
    }
    head.magic = hal::BlockHead::kMagic;
    head.checksum = head.checksum_with(std::as_bytes(std::span(text).subspan(at + sizeof head, size)));
    std::memcpy(text.data() + at, &head, sizeof head);
    at += sizeof head + size;
  }
}

std::string with_right_sums(std::string text, unsigned which) {
  const std::size_t end = text.find(hal::kLastHeaderLine);
  if (end == std::string::npos) {
    return text;
  }
  std::string header = text.substr(0, end);
  if ((which & 2U) != 0) {
    put_hash(header, "\nmodel_hash ", hal::model_hash(model_of(header)));
  }
  if (const std::size_t at = header.rfind("header_hash "); (which & 1U) != 0 && at != std::string::npos) {
    hal::Fnv1a hash;
    hash.add(std::as_bytes(std::span(header)).first(at));
    put_hash(header, "\nheader_hash ", hash.value());
  }
  text.replace(0, end, header);
  const hal::ParsedHeader parsed = hal::parse_header(text);
  if ((which & 4U) != 0 && parsed.error.empty()) {
    put_block_sums(text, parsed.bytes, hal::cycle_bytes(parsed.header.actuators, parsed.header.start.size()));
  }
  return text;
}

void read_all(const std::string& path) {
  hal::RecordingReader reader(path);
  hal::RecordedCycle cycle;
  while (reader.error().empty() && reader.next(cycle)) {
  }
  if (!reader.error().empty()) {
    return;
  }
  const std::string& model = reader.header().model;
  const double period = static_cast<double>(reader.header().period_ns) * 1e-9;
  if (reader.header().topology == "lab") {
    firmware::parse_lab_image(model, "input", period);
  } else {
    firmware::parse_plant_image(model, "input");
  }
}

}  // namespace
}  // namespace hotfire::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace hotfire;
  static const fuzz::InputFile file("recording");
  if (size == 0) {
    return 0;
  }
  const std::string& path = file.holding(fuzz::with_right_sums(std::string(fuzz::text_of(bytes + 1, size - 1)), bytes[0]));
  fuzz::read_all(path);
  fuzz::read_or_refuse([&] { load_recording(path); });
  fuzz::read_or_refuse([&] { load_recording(path, {2, 1, true}); });
  return 0;
}
