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

namespace {

class Digest {
 public:
  Digest()
      : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free), good_(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1) {}

  void add(std::string_view bytes) { good_ = good_ && EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1; }

  /// In hexadecimal; empty if the library has failed.
  std::string text() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    if (!good_ || EVP_DigestFinal_ex(context_.get(), digest.data(), &length) != 1) {
      return {};
    }
    return fmt::format("{:02x}", fmt::join(digest.begin(), digest.begin() + length, ""));
  }

 private:
  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_;
  bool good_;
};

}  // namespace

std::string sha256_of(const std::filesystem::path& path) {
  constexpr std::size_t kBlock = 1U << 16U;
  std::ifstream file(path, std::ios::binary);
  bool good = file.good();
  Digest digest;
  std::vector<char> block(kBlock);
  while (good && file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    good = !file.bad();
    digest.add({block.data(), static_cast<std::size_t>(file.gcount())});
  }
  std::string text = good ? digest.text() : std::string{};
  if (text.empty()) {
    throw FileError(fmt::format("{}: cannot be read for its SHA-256", path.string()));
  }
  return text;
}

std::string sha256_of_text(std::string_view text) {
  Digest digest;
  digest.add(text);
  return digest.text();
}

}  // namespace hotfire
