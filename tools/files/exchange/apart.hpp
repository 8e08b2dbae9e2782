// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

namespace hotfire {

/// What work in a process of its own may use.
struct ApartLimits {
  std::size_t memory_mib = 0;         ///< address space
  std::size_t processor_seconds = 0;  ///< user and system together
  std::size_t seconds = 0;            ///< until all of the result is there: of work that waits and takes no processor
  std::size_t result_bytes = 0;
};

/// What the process may use in which a library reads somebody else's file: 4 GiB, since a column of as many rows as a record
/// may have is 80 MB and the library holds it twice; 60 s of processor, within 600 s on a machine that has a tenth of a
/// processor for it.
constexpr ApartLimits limits_of_a_reader(std::size_t result_bytes) { return {4096, 60, 600, result_bytes}; }

/// Why work in a process of its own gave no result: a crash with its signal, or the limit it went beyond.
struct ApartError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs `work` in a child process and returns its result. What the work does to memory, however wrong, stays in the child.
/// It prints nothing: its standard output and error lead nowhere. To be called while no other thread runs.
///
/// Throws the FileError that `work` throws, and ApartError for a crash, an abort, another exception or a limit. A build with
/// the address sanitizer, which reserves terabytes, does not limit the memory.
std::string run_apart(const std::function<std::string()>& work, const ApartLimits& limits);

}  // namespace hotfire
