// SPDX-License-Identifier: Apache-2.0
#include "tools/interface/c/saved_state.hpp"

#include <cstring>

namespace hotfire::interface {

namespace {

struct Header {
  char mark[8];  // NOLINT(modernize-avoid-c-arrays): its bytes are the format
  std::uint64_t identity;
  std::uint64_t size;
  std::uint64_t fingerprint;
  std::uint64_t started;
};

constexpr std::string_view kMark = "hotfire1";

}  // namespace

std::uint64_t fingerprint_of(std::uint64_t start, std::span<const std::byte> bytes) noexcept {
  std::uint64_t value = 0xcbf29ce484222325U ^ start;
  for (std::size_t at = 0; at < bytes.size(); at += sizeof value) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, bytes.size() - at < sizeof word ? bytes.size() - at : sizeof word);
    value = (value ^ word) * 0x100000001b3U;
    value ^= value >> 32;  // FNV alone never carries downwards
  }
  return value;
}

std::size_t saved_size(const plant::Plant& plant) noexcept { return sizeof(Header) + plant.state_size(); }

void save(const plant::Plant& plant, bool started, std::byte* bytes) noexcept {
  const std::span<std::byte> body(bytes + sizeof(Header), plant.state_size());
  plant.save(body);
  Header header{{}, plant.identity(), body.size(), 0, started ? 1U : 0U};
  std::memcpy(header.mark, kMark.data(), sizeof header.mark);
  header.fingerprint = fingerprint_of(header.started, body);
  std::memcpy(bytes, &header, sizeof header);
}

std::string_view broken_state(const plant::Plant& plant, std::span<const std::byte> bytes) noexcept {
  Header header{};
  if (bytes.size() < sizeof header) {
    return "too few bytes for a state; give all that hotfire_save wrote";
  }
  std::memcpy(&header, bytes.data(), sizeof header);
  if (std::memcmp(header.mark, kMark.data(), sizeof header.mark) != 0) {
    return "not a state; give what hotfire_save wrote";
  }
  if (header.identity != plant.identity() || header.size != plant.state_size()) {
    return "a state of another model or another version; allowed: one of this model";
  }
  if (bytes.size() < saved_size(plant)) {
    return "too few bytes for a state; give all that hotfire_save wrote";
  }
  if (header.started > 1 ||
      header.fingerprint != fingerprint_of(header.started, bytes.subspan(sizeof header, plant.state_size()))) {
    return "a damaged state; give what hotfire_save wrote";
  }
  return {};
}

bool load(plant::Plant& plant, const std::byte* bytes) noexcept {
  Header header{};
  std::memcpy(&header, bytes, sizeof header);
  plant.load({bytes + sizeof header, plant.state_size()});
  return header.started == 1;
}

}  // namespace hotfire::interface
