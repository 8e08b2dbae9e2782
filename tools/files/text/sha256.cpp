// SPDX-License-Identifier: Apache-2.0
#include "tools/files/text/sha256.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <memory>
#include <vector>

#include "tools/files/text/error.hpp"

namespace hotfire {

std::string sha256_of(const std::filesystem::path& path) {
  constexpr std::size_t kBlock = 1U << 16U;
  std::ifstream file(path, std::ios::binary);
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  bool good = file.good() && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
  std::vector<char> block(kBlock);
  while (good && file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    good = !file.bad() && EVP_DigestUpdate(context.get(), block.data(), static_cast<std::size_t>(file.gcount())) == 1;
  }
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  if (!good || EVP_DigestFinal_ex(context.get(), digest.data(), &length) != 1) {
    throw FileError(fmt::format("{}: cannot be read for its SHA-256", path.string()));
  }
  return fmt::format("{:02x}", fmt::join(digest.begin(), digest.begin() + length, ""));
}

}  // namespace hotfire
