#include "hal/linux/recording_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace hotfire::hal {
namespace {

/// Writes all of both; false with errno if it cannot.
bool write_all(int file, std::span<const std::byte> head, std::span<const std::byte> content) {
  while (!head.empty() || !content.empty()) {
    // writev only reads what it is given.
    const std::array<iovec, 2> parts{iovec{const_cast<std::byte*>(head.data()), head.size()},
                                     iovec{const_cast<std::byte*>(content.data()), content.size()}};
    const ssize_t written = writev(file, parts.data(), parts.size());
    if (written < 0) {
      if (errno == EINTR) {
        continue;
      }
      return false;
    }
    const auto of_head = std::min(static_cast<std::size_t>(written), head.size());
    head = head.subspan(of_head);
    content = content.subspan(static_cast<std::size_t>(written) - of_head);
  }
  return true;
}

}  // namespace

RecordingFile::~RecordingFile() {
  if (file_ >= 0) {
    close(file_);
  }
}

std::optional<Failure> RecordingFile::create(std::string_view header) {
  const auto failure = [this] {
    return Failure{"no recording: " + path_ + ": " + std::strerror(errno),
                   "name a file in a folder that this user may write to, on a disk with room"};
  };
  struct stat status {};
  if (stat(path_.c_str(), &status) == 0) {
    if (!S_ISREG(status.st_mode)) {
      errno = EEXIST;
      return failure();
    }
    if (!overwrite_) {
      return Failure{"no recording: " + path_ + " exists, and no test can be recorded again",
                     "name another file, or give --overwrite to replace it"};
    }
  }
  const std::string unnamed = path_ + ".part";
  file_ = open(unnamed.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file_ < 0 || !write_all(file_, std::as_bytes(std::span(header)), {}) || fsync(file_) != 0 ||
      std::rename(unnamed.c_str(), path_.c_str()) != 0) {
    const Failure why = failure();
    unlink(unnamed.c_str());
    return why;
  }
  bytes_ = header.size();
  return std::nullopt;
}

std::string RecordingFile::append(std::span<const std::byte> head, std::span<const std::byte> content) {
  const std::uint64_t more = head.size() + content.size();
  if (bytes_ + more > most_bytes_) {
    return path_ + " has reached its limit of " + std::to_string(most_bytes_ >> 20) + " MiB (--record-max-mib)";
  }
  if (!write_all(file_, head, content)) {
    std::string why = path_ + ": " + std::strerror(errno);
    // A block that is not whole would end the recording for a reader, were another to follow it.
    if (ftruncate(file_, static_cast<off_t>(bytes_)) == 0) {
      lseek(file_, static_cast<off_t>(bytes_), SEEK_SET);
    }
    return why;
  }
  bytes_ += more;
  return {};
}

void RecordingFile::sync() { fdatasync(file_); }

}  // namespace hotfire::hal
