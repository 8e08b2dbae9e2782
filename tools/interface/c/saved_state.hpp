// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "tools/interface/plant/plant.hpp"

namespace hotfire::interface {

/// Bytes of a state with a header: a mark, the plant's identity, the size and a fingerprint of what follows, so that bytes
/// of another model, of another build or damaged ones are refused.
std::size_t saved_size(const plant::Plant& plant) noexcept;
void save(const plant::Plant& plant, bool started, std::byte* bytes) noexcept;

/// Why these bytes are no state of the plant; empty if they are.
std::string_view broken_state(const plant::Plant& plant, std::span<const std::byte> bytes) noexcept;

/// FNV-1a over words of eight bytes, begun with `start`: a damaged byte changes it. What does not fill a word is left as it
/// is with zeros.
std::uint64_t fingerprint_of(std::uint64_t start, std::span<const std::byte> bytes) noexcept;

/// Loads what `broken_state` has found good. True if the plant had been started.
bool load(plant::Plant& plant, const std::byte* bytes) noexcept;

}  // namespace hotfire::interface
