// SPDX-License-Identifier: Apache-2.0
#include "tools/files/text/whole_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

/// The file a link leads to, so that the link stays a link.
std::filesystem::path behind_links(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::path resolved = std::filesystem::canonical(path, ignored);
  return resolved.empty() ? path : resolved;
}

}  // namespace

WholeFile::WholeFile(const std::filesystem::path& path) : target_(path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw FileError(fmt::format("{}: cannot be written: it is not a regular file; name a file", path.string()));
  }
  target_ = behind_links(path);
  temporary_ = target_;
  temporary_ += fmt::format(".{}.part", getpid());
  file_ = std::fopen(temporary_.c_str(), "wb");
  if (file_ == nullptr) {
    fail();
  }
}

WholeFile::~WholeFile() {
  if (file_ != nullptr) {
    std::fclose(file_);
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }
}

void WholeFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) {
    fail();
  }
}

void WholeFile::write_block(std::string& text) {
  constexpr std::size_t block = 1 << 18;
  if (text.size() > block) {
    write(text);
    text.clear();
  }
}

void WholeFile::commit() {
  if (std::fflush(file_) != 0 || fsync(fileno(file_)) != 0 || std::rename(temporary_.c_str(), target_.c_str()) != 0) {
    fail();
  }
  std::fclose(file_);
  file_ = nullptr;
}

void WholeFile::fail() const {
  const std::string why = std::generic_category().message(errno);
  std::error_code ignored;
  const std::filesystem::path folder = target_.parent_path();
  const bool needs_folder = !folder.empty() && !std::filesystem::exists(folder, ignored);
  throw FileError(fmt::format("{}: cannot be written: {}{}", target_.string(), why,
                              needs_folder ? fmt::format("; make its folder: mkdir -p {}", folder.string()) : ""));
}

void write_whole_file(const std::filesystem::path& path, std::string_view text) {
  WholeFile file(path);
  file.write(text);
  file.commit();
}

void write_whole_file_by(const std::filesystem::path& path, const std::function<bool(const std::filesystem::path&)>& write) {
  WholeFile file(path);
  if (!write(file.temporary())) {
    throw FileError(
        fmt::format("{}: cannot be written: the library of its format failed; is the disk full?", path.string()));
  }
  file.commit();
}

}  // namespace hotfire
