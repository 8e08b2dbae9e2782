// SPDX-License-Identifier: Apache-2.0
// The board support of the example: vector table, start-up, semihosting, and what is measured. ARMv7-M Architecture
// Reference Manual (DDI 0403E) for the core; Semihosting for AArch32 and AArch64 (Arm IHI 0103) for the calls; Arm AN500 for
// the board.
#include "board.hpp"

#include <cstring>

int main();

extern "C" {
// Set by board.ld; only their addresses mean anything.
extern std::uint32_t board_data_load[];
extern std::uint32_t board_data_begin[];
extern std::uint32_t board_data_end[];
extern std::uint32_t board_bss_begin[];
extern std::uint32_t board_bss_end[];
extern std::uint32_t board_stack_bottom[];
extern std::uint32_t board_stack_top[];

void board_reset();
void board_fault();
}

namespace {

enum Call : int { kOpen = 0x01, kClose = 0x02, kWriteText = 0x04, kWrite = 0x05, kRead = 0x06, kExit = 0x20 };

/// One call to the host: the operation in r0, its arguments in a block.
int host(Call call, const void* arguments) {
  register int operation asm("r0") = call;
  register const void* block asm("r1") = arguments;
  asm volatile("bkpt 0xab" : "+r"(operation) : "r"(block) : "memory");
  return operation;
}

[[noreturn]] void leave(std::uint32_t status) {
  constexpr std::uint32_t kApplicationExit = 0x20026;
  const std::uint32_t block[2] = {kApplicationExit, status};
  host(kExit, block);
  for (;;) {
  }
}

/// A register at an address of the board.
volatile std::uint32_t& at(std::uintptr_t address) { return *reinterpret_cast<volatile std::uint32_t*>(address); }

constexpr std::uintptr_t kTimerControl = 0x40000000;  // CMSDK timer 0: counts down from the reload value
constexpr std::uintptr_t kTimerValue = 0x40000004;
constexpr std::uintptr_t kTimerReload = 0x40000008;
constexpr std::uintptr_t kCoprocessorAccess = 0xE000ED88;

constexpr std::uint32_t kPaint = 0xA5A5A5A5;

void start_floating_point() {
  constexpr std::uint32_t kFullAccess = 0xFU << 20;
  at(kCoprocessorAccess) = at(kCoprocessorAccess) | kFullAccess;
  asm volatile("dsb\n isb" ::: "memory");
  // Denormal numbers are zero, as on the host and on the rig (FPSCR.FZ).
  asm volatile("vmrs r0, fpscr\n orr r0, r0, #0x01000000\n vmsr fpscr, r0" ::: "r0");
}

}  // namespace

extern "C" [[gnu::section(".vectors"), gnu::used]] const std::uintptr_t board_vectors[16] = {
    reinterpret_cast<std::uintptr_t>(board_stack_top), reinterpret_cast<std::uintptr_t>(board_reset),
    reinterpret_cast<std::uintptr_t>(board_fault),     reinterpret_cast<std::uintptr_t>(board_fault),
    reinterpret_cast<std::uintptr_t>(board_fault),     reinterpret_cast<std::uintptr_t>(board_fault),
    reinterpret_cast<std::uintptr_t>(board_fault)};

void board_reset() {
  start_floating_point();
  board::paint_stack();
  std::memcpy(board_data_begin, board_data_load,
              static_cast<std::size_t>(reinterpret_cast<char*>(board_data_end) - reinterpret_cast<char*>(board_data_begin)));
  std::memset(board_bss_begin, 0,
              static_cast<std::size_t>(reinterpret_cast<char*>(board_bss_end) - reinterpret_cast<char*>(board_bss_begin)));
  at(kTimerReload) = ~0U;
  at(kTimerControl) = 1;
  leave(static_cast<std::uint32_t>(main()));
}

void board_fault() {
  board::print("fault: an exception of the core\n");
  leave(1);
}

namespace board {

HostFile::HostFile(const char* name, Mode mode) noexcept {
  const std::uintptr_t block[3] = {reinterpret_cast<std::uintptr_t>(name), static_cast<std::uintptr_t>(mode),
                                   std::strlen(name)};
  handle_ = host(kOpen, block);
}

HostFile::~HostFile() {
  if (is_open()) {
    host(kClose, &handle_);
  }
}

std::size_t HostFile::read(std::span<std::byte> bytes) noexcept {
  const std::uintptr_t block[3] = {static_cast<std::uintptr_t>(handle_), reinterpret_cast<std::uintptr_t>(bytes.data()),
                                   bytes.size()};
  return bytes.size() - static_cast<std::size_t>(host(kRead, block));
}

bool HostFile::write(std::span<const std::byte> bytes) noexcept {
  const std::uintptr_t block[3] = {static_cast<std::uintptr_t>(handle_), reinterpret_cast<std::uintptr_t>(bytes.data()),
                                   bytes.size()};
  return host(kWrite, block) == 0;
}

void print(const char* text) noexcept { host(kWriteText, text); }

void print(std::uint32_t number) noexcept {
  char digits[11] = {};
  char* first = digits + sizeof digits - 1;
  do {
    *--first = static_cast<char>('0' + number % 10);
    number /= 10;
  } while (number != 0);
  print(first);
}

std::uint32_t now() noexcept { return ~at(kTimerValue); }

std::uint32_t instructions_since(std::uint32_t moment) noexcept {
  constexpr std::uint64_t kTick = 40;           // ns
  constexpr std::uint64_t kInstruction = 1024;  // ns
  const std::uint32_t ticks = now() - moment;
  return static_cast<std::uint32_t>((ticks * kTick + kInstruction / 2) / kInstruction);
}

void paint_stack() noexcept {
  constexpr std::ptrdiff_t kOwnFrame = 16;  // words, more than this function uses
  const std::uint32_t* here = nullptr;
  asm volatile("mov %0, sp" : "=r"(here));
  for (std::uint32_t* word = board_stack_bottom; word < here - kOwnFrame; ++word) {
    *word = kPaint;
  }
}

std::size_t deepest_stack() noexcept {
  const std::uint32_t* word = board_stack_bottom;
  while (word < board_stack_top && *word == kPaint) {
    ++word;
  }
  return static_cast<std::size_t>(board_stack_top - word) * sizeof *word;
}

std::size_t static_memory() noexcept {
  return static_cast<std::size_t>(board_bss_end - board_data_begin) * sizeof(std::uint32_t);
}

std::size_t flash() noexcept {
  const std::size_t variables = static_cast<std::size_t>(board_data_end - board_data_begin) * sizeof(std::uint32_t);
  return reinterpret_cast<std::uintptr_t>(board_data_load) + variables;
}

}  // namespace board
