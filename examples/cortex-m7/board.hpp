// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

/// What the example needs of a board, and no more. `board.cpp` has it for the MPS2 with the image AN500, a Cortex-M7, which
/// QEMU runs. For another board, write these functions and the memory map in `board.ld`.
namespace board {

/// A file on the host of a debugger or of QEMU (semihosting). A board in a rig has its bus in its place.
class HostFile {
 public:
  enum class Mode { read = 1, write = 5 };  ///< "rb", "wb" in the numbering of semihosting

  HostFile(const char* name, Mode mode) noexcept;
  ~HostFile();
  HostFile(const HostFile&) = delete;
  HostFile& operator=(const HostFile&) = delete;

  bool is_open() const noexcept { return handle_ >= 0; }
  /// How many bytes were read; fewer than asked for at the end of the file.
  std::size_t read(std::span<std::byte> bytes) noexcept;
  bool write(std::span<const std::byte> bytes) noexcept;

 private:
  int handle_;
};

/// Text on the host's console.
void print(const char* text) noexcept;
void print(std::uint32_t number) noexcept;

/// A moment, in ticks of the board's timer.
std::uint32_t now() noexcept;

/// The instructions since a moment at most 160 million instructions ago, if QEMU runs with `-icount shift=10`: it then gives
/// each instruction 1024 ns, and the timer of the MPS2 counts them at 25 MHz. On silicon this is a time, not a count.
std::uint32_t instructions_since(std::uint32_t moment) noexcept;

/// Paints the stack that is free, and how deep it has been since [bytes].
void paint_stack() noexcept;
std::size_t deepest_stack() noexcept;

/// Bytes of variables, the stack apart, and bytes that the program takes in flash.
std::size_t static_memory() noexcept;
std::size_t flash() noexcept;

}  // namespace board
