// SPDX-License-Identifier: Apache-2.0
#include "tools/export/archive.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <memory>

#include "tools/files/text/error.hpp"
#include "tools/files/text/whole_file.hpp"

namespace hotfire {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view problem) {
  throw FileError(fmt::format("{}: cannot be written as a zip archive: {}", path.string(), problem));
}

}  // namespace

void write_archive(const std::filesystem::path& path, const std::map<std::string, std::string>& files) {
  zip_error_t error;
  zip_error_init(&error);
  // In memory first, so that a file is whole or absent.
  zip_source_t* buffer = zip_source_buffer_create(nullptr, 0, 0, &error);
  zip_t* archive = buffer != nullptr ? zip_open_from_source(buffer, ZIP_TRUNCATE, &error) : nullptr;
  if (archive == nullptr) {
    fail(path, zip_error_strerror(&error));
  }
  zip_source_keep(buffer);
  constexpr zip_uint16_t kDate = (1 << 5) | 1;  // 1980-01-01: the same files give the same bytes
  constexpr zip_uint32_t kEffort = 6;  // of deflate; its most, 9, takes twice the time for half a per cent of the size
  for (const auto& [name, content] : files) {
    zip_source_t* source = zip_source_buffer(archive, content.data(), content.size(), 0);
    const zip_int64_t index = source != nullptr ? zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8) : -1;
    const auto place = static_cast<zip_uint64_t>(index);
    if (index < 0 || zip_file_set_dostime(archive, place, 0, kDate, 0) != 0 ||
        zip_set_file_compression(archive, place, ZIP_CM_DEFLATE, kEffort) != 0) {
      fail(path, zip_strerror(archive));
    }
  }
  if (zip_close(archive) != 0) {
    fail(path, zip_strerror(archive));
  }
  zip_stat_t size;
  zip_stat_init(&size);
  std::string bytes;
  if (zip_source_stat(buffer, &size) == 0 && zip_source_open(buffer) == 0) {
    bytes.resize(size.size);
    const zip_int64_t read = zip_source_read(buffer, bytes.data(), bytes.size());
    zip_source_close(buffer);
    bytes.resize(read > 0 ? static_cast<std::size_t>(read) : 0);
  }
  zip_source_free(buffer);
  if (bytes.empty()) {
    fail(path, "its bytes cannot be read back");
  }
  write_whole_file(path, bytes);
}

}  // namespace hotfire
