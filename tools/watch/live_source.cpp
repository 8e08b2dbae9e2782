// SPDX-License-Identifier: Apache-2.0
#include "tools/watch/live_source.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>

namespace hotfire::watch {
namespace {

/// Whether the program that fills the file still runs: it holds a lock that ends with it.
bool is_locked(int file) {
  struct flock whole {};
  whole.l_type = F_RDLCK;
  whole.l_whence = SEEK_SET;
  return fcntl(file, F_OFD_GETLK, &whole) == 0 && whole.l_type != F_UNLCK;
}

}  // namespace

void LiveSource::close_view() {
  if (!memory_.empty()) {
    munmap(const_cast<hal::LiveWord*>(memory_.data()), memory_.size_bytes());
    memory_ = {};
  }
  if (file_ >= 0) {
    close(file_);
    file_ = -1;
  }
}

bool LiveSource::refuse(const std::string& why) {
  close_view();
  state_ = State::refused;
  why_ = path_ + ": " + why;
  return false;
}

bool LiveSource::map(std::size_t bytes) {
  void* const memory = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file_, 0);
  if (memory == MAP_FAILED) {
    return refuse(std::strerror(errno));
  }
  memory_ = {static_cast<const hal::LiveWord*>(memory), bytes / sizeof(hal::LiveWord)};
  return true;
}

bool LiveSource::open_view() {
  using Shape = hal::LiveShape;
  close_view();
  file_ = open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  struct stat status {};
  if (file_ < 0 || fstat(file_, &status) != 0) {
    return refuse(std::strerror(errno));
  }
  device_ = status.st_dev;
  inode_ = status.st_ino;
  const auto bytes = static_cast<std::size_t>(status.st_size);
  if (!S_ISREG(status.st_mode) || bytes < Shape::kHeadWords * sizeof(hal::LiveWord)) {
    return refuse("no live view; a program makes one with --watch");
  }
  if (!map(bytes)) {
    return false;
  }
  const auto head = [this](Shape::Head at) { return memory_[at].load(std::memory_order_acquire); };
  const Shape shape{head(Shape::kTextBytesAt), head(Shape::kSlotWordsAt), head(Shape::kSlotsAt)};
  if (head(Shape::kMagicAt) != Shape::kMagic || !shape.is_possible() || shape.words() != memory_.size()) {
    return refuse("no live view, or one of another version; a program makes one with --watch");
  }
  const std::string_view text(reinterpret_cast<const char*>(memory_.data() + Shape::kHeadWords), shape.text_bytes);
  hal::ParsedDescription parsed = hal::parse_description(text);
  if (!parsed.error.empty() || parsed.description.slot_words() != shape.slot_words) {
    return refuse("its description: " + (parsed.error.empty() ? "not that of its cycles" : parsed.error));
  }
  description_ = std::move(parsed.description);
  reader_ = {memory_, shape};
  words_.resize(shape.slot_words);
  values_.resize(description_.header.actuators + description_.header.start.size());
  next_ = reader_.oldest();
  missed_ = 0;
  return true;
}

bool LiveSource::refresh() {
  struct stat status {};
  const bool is_there = stat(path_.c_str(), &status) == 0;
  const bool is_another = is_there && (status.st_dev != device_ || status.st_ino != inode_ || state_ == State::absent ||
                                       state_ == State::refused);
  const bool is_new = is_another && open_view();
  if (memory_.empty()) {
    state_ = is_there ? state_ : State::absent;
    return false;
  }
  if (const std::uint64_t ending = reader_.ended(); ending != 0) {
    const auto found = std::find_if(description_.endings.begin(), description_.endings.end(),
                                    [ending](const hal::LiveWordMeaning& word) { return word.number == ending; });
    state_ = State::ended;
    why_ = found == description_.endings.end() ? "" : found->name;
  } else {
    state_ = is_locked(file_) ? State::running : State::died;
    why_.clear();
  }
  return is_new;
}

bool LiveSource::next(LiveCycle& cycle) {
  if (memory_.empty()) {
    return false;
  }
  const std::uint64_t oldest = reader_.oldest();
  if (next_ < oldest) {
    missed_ += oldest - next_;
    next_ = oldest;
  }
  for (const std::uint64_t published = reader_.published(); next_ < published;) {
    if (!reader_.read(next_++, words_)) {
      ++missed_;
      continue;
    }
    constexpr std::size_t kHeadWords = sizeof cycle.head / sizeof(std::uint64_t);
    std::array<std::uint64_t, kHeadWords> head{};
    std::copy_n(words_.begin(), kHeadWords, head.begin());
    cycle.head = std::bit_cast<hal::CycleHead>(head);
    std::memcpy(values_.data(), words_.data() + kHeadWords, values_.size() * sizeof(double));
    const std::size_t actuators = description_.header.actuators;
    cycle.commands = std::span(values_).first(actuators);
    cycle.readings = std::span(values_).subspan(actuators);
    cycle.counters = std::span(words_).subspan(kHeadWords + values_.size());
    return true;
  }
  return false;
}

}  // namespace hotfire::watch
