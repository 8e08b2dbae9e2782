// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "tools/files/text/error.hpp"

namespace hotfire::fuzz {

/// A file in memory that holds one input after the other, for parsers that take a path.
class InputFile {
 public:
  explicit InputFile(const char* name) : file_(memfd_create(name, 0)), path_("/proc/self/fd/" + std::to_string(file_)) {
    if (file_ < 0) {
      std::perror("memfd_create");
      std::exit(1);
    }
  }

  const std::string& holding(std::string_view content) const {
    if (ftruncate(file_, 0) != 0 ||
        pwrite(file_, content.data(), content.size(), 0) != static_cast<ssize_t>(content.size())) {
      std::perror("memfd");
      std::exit(1);
    }
    return path_;
  }

 private:
  int file_;
  std::string path_;
};

inline std::string_view text_of(const std::uint8_t* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

/// Reads; a refusal with a reason is as good as a result. Any other exception ends the run.
template <class Parse>
void read_or_refuse(Parse&& parse) {
  try {
    parse();
  } catch (const FileError& refusal) {
    if (std::string_view(refusal.what()).empty()) {
      std::abort();
    }
  }
}

}  // namespace hotfire::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);
