// SPDX-License-Identifier: Apache-2.0
#include "tools/files/text/csv_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "tools/files/text/error.hpp"
#include "tools/files/text/near_file.hpp"

namespace hotfire {

namespace {

constexpr std::size_t kBlock = 1 << 18;
constexpr std::size_t kFirstBlock = 1 << 12;                 ///< enough for a small file
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // spreadsheets put it first

bool is_text(char letter) {
  const auto code = static_cast<unsigned char>(letter);
  return code >= 0x20 || code == '\t' || code == '\n' || code == '\r';
}

}  // namespace

CsvLines::CsvLines(const std::filesystem::path& path) : CsvLines(path, File(std::fopen(path.c_str(), "rb"), std::fclose)) {}

// In the mode "r" it is only read.
CsvLines::CsvLines(std::string_view text, std::filesystem::path name)
    : CsvLines(std::move(name), File(fmemopen(const_cast<char*>(text.data()), text.size(), "rb"), std::fclose)) {}

CsvLines::CsvLines(std::filesystem::path path, File file)
    : path_(std::move(path)), file_(std::move(file)), buffer_(kFirstBlock) {
  if (!file_) {
    const std::string why = std::generic_category().message(errno);
    throw FileError(fmt::format("{}: cannot be opened: {}{}", path_.string(), why, near_file(path_)));
  }
  if (fill() == 0) {
    throw FileError(
        fmt::format("{}:1: empty file; a record begins with a line like time[s],command[rad],piston[m]", path_.string()));
  }
  if (end_ == buffer_.size()) {
    buffer_.resize(kBlock);
    fill();
  }
  require_text();
  if (std::string_view(buffer_.data(), end_).starts_with(kByteOrderMark)) {
    begin_ = kByteOrderMark.size();
  }
}

void CsvLines::require_text() const {
  const auto first = std::find_if_not(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(end_), is_text);
  const auto at = static_cast<std::size_t>(first - buffer_.begin());
  if (at < end_) {
    throw FileError(
        fmt::format("{}:{}: not CSV: byte {} is 0x{:02X}, which is not text; a record is text like "
                    "time[s],command[rad],piston[m]",
                    path_.string(), 1 + std::count(buffer_.begin(), first, '\n'), at, static_cast<unsigned char>(*first)));
  }
}

std::size_t CsvLines::fill() {
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t got = std::fread(buffer_.data() + end_, 1, buffer_.size() - end_, file_.get());
  if (std::ferror(file_.get()) != 0) {
    throw FileError(fmt::format("{}: cannot be read: {}", path_.string(), std::generic_category().message(errno)));
  }
  end_ += got;
  return got;
}

bool CsvLines::next(std::string_view& line) {
  const void* found = std::memchr(buffer_.data() + begin_, '\n', end_ - begin_);
  if (found == nullptr) {
    fill();
    found = std::memchr(buffer_.data(), '\n', end_);
  }
  if (begin_ == end_) {
    return false;
  }
  ++number_;
  if (found == nullptr && end_ == buffer_.size()) {
    refuse(fmt::format("not CSV: a line of over {} characters; allowed: fewer", buffer_.size()));
  }
  const char* start = buffer_.data() + begin_;
  const std::size_t length =
      found == nullptr ? end_ - begin_ : static_cast<std::size_t>(static_cast<const char*>(found) - start);
  line = std::string_view(start, length);
  begin_ += std::min(length + 1, end_ - begin_);
  if (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  return true;
}

void CsvLines::refuse(std::string_view problem) const {
  throw FileError(fmt::format("{}:{}: {}", path_.string(), number_, problem));
}

}  // namespace hotfire
