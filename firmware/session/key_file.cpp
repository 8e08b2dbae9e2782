// SPDX-License-Identifier: Apache-2.0
#include "firmware/session/key_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>

#include "firmware/text/text.hpp"

namespace hotfire::firmware {
namespace {

constexpr std::size_t kDigits = 2 * std::tuple_size_v<can::AuthenticationKey>;

hal::Failure refusal(const std::string& path, const std::string& why) {
  return {"key " + path + ": " + why,
          text("a file of %zu hexadecimal digits with mode 0600: 'umask 077; openssl rand -hex %zu >FILE'", kDigits,
               kDigits / 2)};
}

/// Reads what `file` is open on.
ReadKey read_open(int file, const std::string& path) {
  struct stat about {};
  if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode)) {
    return {{}, refusal(path, "not a file")};
  }
  if ((about.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return {{}, refusal(path, text("its mode is %04o: others may use it", about.st_mode & 07777U))};
  }
  // One more than a key and its end of line: a longer file is none.
  std::array<char, kDigits + 2> digits{};
  const ssize_t size = read(file, digits.data(), digits.size());
  const bool has_end = size == static_cast<ssize_t>(kDigits + 1) && digits[kDigits] == '\n';
  ReadKey result;
  bool good = size == static_cast<ssize_t>(kDigits) || has_end;
  for (std::size_t i = 0; good && i < result.key.size(); ++i) {
    const char* const from = digits.data() + 2 * i;
    const auto [end, error] = std::from_chars(from, from + 2, result.key[i], 16);
    good = error == std::errc{} && end == from + 2;
  }
  explicit_bzero(digits.data(), digits.size());
  if (!good) {
    result.refused = refusal(path, "not a key");
  }
  return result;
}

}  // namespace

ReadKey read_key(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) {
    return {{}, refusal(path, std::strerror(errno))};
  }
  ReadKey result = read_open(file, path);
  close(file);
  return result;
}

}  // namespace hotfire::firmware
