// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/live_file.hpp"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace hotfire::hal {
namespace {

constexpr const char* kPlace = "name a file below /dev/shm or /run";

Failure failure(const std::string& path, int error) { return failed_call("no live view: " + path, error, kPlace); }

/// A lock of the open file, which ends with the program however that ends, and which a reader can look at without taking it.
bool lock(int file) noexcept {
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  return fcntl(file, F_OFD_SETLK, &whole) == 0;
}

bool is_locked(int file) noexcept {
  struct flock whole {};
  whole.l_type = F_RDLCK;
  whole.l_whence = SEEK_SET;
  return fcntl(file, F_OFD_GETLK, &whole) != 0 || whole.l_type != F_UNLCK;
}

bool is_in_memory(int file) noexcept {
  struct statfs system {};
  return fstatfs(file, &system) == 0 && (system.f_type == TMPFS_MAGIC || system.f_type == RAMFS_MAGIC);
}

}  // namespace

LiveFile::~LiveFile() {
  if (is_named_) {
    unlink(path_.c_str());
  }
  if (!memory_.empty()) {
    munmap(memory_.data(), memory_.size_bytes());
  }
  if (file_ >= 0) {
    close(file_);
  }
}

std::optional<Failure> LiveFile::refuse_what_is_there() const {
  const int file = open(path_.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) {
    return errno == ENOENT ? std::nullopt : std::optional(failure(path_, errno));
  }
  struct stat status {};
  std::uint64_t magic = 0;
  const bool is_live_view = fstat(file, &status) == 0 && S_ISREG(status.st_mode) &&
                            pread(file, &magic, sizeof magic, 0) == sizeof magic && magic == LiveShape::kMagic;
  const bool is_in_use = is_locked(file);
  close(file);
  if (!is_live_view) {
    return Failure{"no live view: " + path_ + " is something else", kPlace};
  }
  if (is_in_use) {
    return Failure{"no live view: " + path_ + " is that of another program, which runs", "name another file"};
  }
  return std::nullopt;
}

bool LiveFile::map() noexcept {
  const std::size_t bytes = shape_.words() * sizeof(LiveWord);
  if (posix_fallocate(file_, 0, static_cast<off_t>(bytes)) != 0) {
    errno = ENOSPC;
    return false;
  }
  void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, file_, 0);
  if (memory == MAP_FAILED) {
    return false;
  }
  auto* const words = static_cast<LiveWord*>(memory);
  std::uninitialized_value_construct_n(words, shape_.words());
  memory_ = {words, shape_.words()};
  return true;
}

std::optional<Failure> LiveFile::create(const std::string& description, std::size_t slot_words, std::size_t slots) {
  if (auto refused = refuse_what_is_there()) {
    return refused;
  }
  shape_ = {description.size(), slot_words, slots};
  const std::string unnamed = path_ + "." + std::to_string(getpid()) + ".part";
  constexpr mode_t kMode = 0440;
  file_ = open(unnamed.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kMode);
  if (file_ < 0) {
    return failure(path_, errno);
  }
  const auto give_up = [&](const Failure& why) {
    unlink(unnamed.c_str());
    return why;
  };
  if (!is_in_memory(file_)) {
    return give_up({"no live view: " + path_ + " is on a disk, for which the loop would wait", kPlace});
  }
  if (!shape_.is_possible()) {
    return give_up({"no live view: it has more values than a live view has room for", "run it without --watch"});
  }
  if (!lock(file_) || !map()) {
    return give_up(failure(path_, errno));
  }
  memory_[LiveShape::kTextBytesAt] = shape_.text_bytes;
  memory_[LiveShape::kSlotWordsAt] = shape_.slot_words;
  memory_[LiveShape::kSlotsAt] = shape_.slots;
  for (std::size_t i = 0; i < shape_.text_words(); ++i) {
    std::uint64_t word = 0;
    const std::string part = description.substr(i * sizeof word, sizeof word);
    std::memcpy(&word, part.data(), part.size());
    memory_[LiveShape::kHeadWords + i] = word;
  }
  memory_[LiveShape::kMagicAt] = LiveShape::kMagic;
  if (std::rename(unnamed.c_str(), path_.c_str()) != 0) {
    return give_up(failure(path_, errno));
  }
  is_named_ = true;
  return std::nullopt;
}

}  // namespace hotfire::hal
