// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#include "tools/interface/fmu/slave.hpp"

namespace hotfire::fmu {

/// A state of an FMU as both standards hand it out: an opaque pointer.
struct SavedBlock {
  std::vector<std::byte> bytes;
};

/// Saves into a new block, or into the one that an earlier call gave.
inline Status get_state(Slave& slave, void** state) noexcept {
  if (state == nullptr) {
    return slave.refuse(Status::error, "GetFMUState", "a place for the state is missing");
  }
  try {
    auto* block = static_cast<SavedBlock*>(*state);
    if (block == nullptr) {
      block = new SavedBlock{std::vector<std::byte>(slave.saved_size())};
      *state = block;
    }
    return slave.save(block->bytes);
  } catch (const std::bad_alloc&) {
    return slave.refuse(Status::error, "GetFMUState", "no memory for the state");
  }
}

inline Status set_state(Slave& slave, void* state) noexcept {
  return state != nullptr ? slave.load(static_cast<SavedBlock*>(state)->bytes)
                          : slave.refuse(Status::error, "SetFMUState", "the state is missing");
}

/// A missing state is no error, as the standards say.
inline void free_state(void** state) noexcept {
  if (state != nullptr) {
    delete static_cast<SavedBlock*>(*state);
    *state = nullptr;
  }
}

inline Status state_size(Slave& slave, void* state, std::size_t* size) noexcept {
  if (state == nullptr || size == nullptr) {
    return slave.refuse(Status::error, "SerializedFMUStateSize", "the state is missing");
  }
  *size = static_cast<SavedBlock*>(state)->bytes.size();
  return Status::ok;
}

template <class Byte>
Status serialize(Slave& slave, void* state, Byte* bytes, std::size_t size) noexcept {
  if (state == nullptr || bytes == nullptr || size < static_cast<SavedBlock*>(state)->bytes.size()) {
    return slave.refuse(Status::error, "SerializeFMUState", "a state and as many bytes as its size are allowed");
  }
  const std::vector<std::byte>& from = static_cast<SavedBlock*>(state)->bytes;
  for (std::size_t i = 0; i < from.size(); ++i) {
    bytes[i] = static_cast<Byte>(from[i]);
  }
  return Status::ok;
}

template <class Byte>
Status deserialize(Slave& slave, const Byte* bytes, std::size_t size, void** state) noexcept {
  if (bytes == nullptr || state == nullptr || size != slave.saved_size()) {
    return slave.refuse(Status::error, "DeSerializeFMUState", "the bytes of a state of this FMU are allowed");
  }
  try {
    auto* block = static_cast<SavedBlock*>(*state);
    if (block == nullptr) {
      block = new SavedBlock{std::vector<std::byte>(size)};
      *state = block;
    }
    for (std::size_t i = 0; i < size; ++i) {
      block->bytes[i] = static_cast<std::byte>(bytes[i]);
    }
    return Status::ok;
  } catch (const std::bad_alloc&) {
    return slave.refuse(Status::error, "DeSerializeFMUState", "no memory for the state");
  }
}

}  // namespace hotfire::fmu
