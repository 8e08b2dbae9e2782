// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/recording_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
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

/// Whether the name is still that of the open file.
bool is_still(int file, const std::string& path) {
  struct stat open_one {};
  struct stat named {};
  return fstat(file, &open_one) == 0 && lstat(path.c_str(), &named) == 0 && open_one.st_dev == named.st_dev &&
         open_one.st_ino == named.st_ino;
}

/// The folder knows the name after a loss of power.
bool sync_folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) {
    return false;
  }
  const bool good = fsync(file) == 0;
  const int why = errno;
  close(file);
  errno = why;
  return good;
}

Failure failure(const std::string& path) {
  return {"no recording: " + path + ": " + std::strerror(errno),
          "name a file in a folder that this user may write to, on a disk with room"};
}

}  // namespace

RecordingFile::~RecordingFile() {
  for (const int file : {file_, older_}) {
    if (file >= 0) {
      close(file);
    }
  }
}

std::optional<Failure> RecordingFile::refuse_what_stands_there() {
  struct stat status {};
  if (lstat(path_.c_str(), &status) != 0) {
    return errno == ENOENT ? std::nullopt : std::optional(failure(path_));
  }
  if (!S_ISREG(status.st_mode)) {
    return Failure{"no recording: " + path_ + " is a link, a folder or a device", "name a file"};
  }
  if (!overwrite_) {
    return Failure{"no recording: " + path_ + " exists, and no test can be recorded again",
                   "name another file, or give --overwrite to replace it"};
  }
  older_ = open(path_.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (older_ < 0) {
    return failure(path_);
  }
  const bool is_locked = flock(older_, LOCK_EX | LOCK_NB) == 0;
  if (!is_locked && errno != EWOULDBLOCK) {
    return failure(path_);
  }
  if (!is_locked || !is_still(older_, path_)) {
    return Failure{"no recording: " + path_ + " is being written by another program", "name another file"};
  }
  return std::nullopt;
}

bool RecordingFile::take_name(const std::string& unnamed) const {
  if (older_ >= 0) {
    return std::rename(unnamed.c_str(), path_.c_str()) == 0;
  }
  if (renameat2(AT_FDCWD, unnamed.c_str(), AT_FDCWD, path_.c_str(), RENAME_NOREPLACE) == 0) {
    return true;
  }
  // Not every file system has that; a link replaces nothing either.
  return errno == EINVAL && link(unnamed.c_str(), path_.c_str()) == 0 && unlink(unnamed.c_str()) == 0;
}

std::optional<Failure> RecordingFile::create(std::string_view header) {
  if (auto refused = refuse_what_stands_there()) {
    return refused;
  }
  const std::string unnamed = path_ + "." + std::to_string(getpid()) + ".part";
  constexpr mode_t kMode = 0640;
  file_ = open(unnamed.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kMode);
  if (file_ < 0) {
    return failure(errno == EEXIST ? unnamed : path_);
  }
  if (flock(file_, LOCK_EX | LOCK_NB) != 0 || !write_all(file_, std::as_bytes(std::span(header)), {}) || fsync(file_) != 0 ||
      !take_name(unnamed)) {
    const Failure why = failure(path_);
    unlink(unnamed.c_str());
    return why;
  }
  if (!sync_folder_of(path_)) {
    // The file would block its name for the next attempt.
    const Failure why = failure(path_);
    unlink(path_.c_str());
    return why;
  }
  if (older_ >= 0) {
    close(older_);
    older_ = -1;
  }
  bytes_ = header.size();
  return std::nullopt;
}

std::optional<SinkRefusal> RecordingFile::append(std::span<const std::byte> head, std::span<const std::byte> content) {
  const std::uint64_t more = head.size() + content.size();
  if (is_torn_) {
    return SinkRefusal{path_ + ": a block that is not whole ends it"};
  }
  if (bytes_ + more > most_bytes_) {
    return SinkRefusal{path_ + " has reached its limit of " + std::to_string(most_bytes_ >> 20) + " MiB (--record-max-mib)",
                       false};
  }
  if (!write_all(file_, head, content)) {
    std::string why = path_ + ": " + std::strerror(errno);
    // A block that is not whole would end the recording for a reader, were another to follow it.
    is_torn_ = ftruncate(file_, static_cast<off_t>(bytes_)) != 0 ||
               lseek(file_, static_cast<off_t>(bytes_), SEEK_SET) != static_cast<off_t>(bytes_);
    if (is_torn_) {
      why += "; the block that is not whole cannot be taken back: " + std::string(std::strerror(errno));
    }
    return SinkRefusal{std::move(why)};
  }
  bytes_ += more;
  return std::nullopt;
}

std::optional<SinkRefusal> RecordingFile::sync() {
  if (fdatasync(file_) == 0) {
    return std::nullopt;
  }
  return SinkRefusal{path_ + ": " + std::strerror(errno) + ": what was recorded since it was last made safe may be lost"};
}

}  // namespace hotfire::hal
