// SPDX-License-Identifier: Apache-2.0
#include "hal/recording/reader.hpp"

#include <cerrno>
#include <cstring>

#include "hal/recording/header.hpp"

namespace hotfire::hal {
namespace {

/// About the header of a plant; the profile of a lab makes it longer.
constexpr std::size_t kHeaderPiece = 1 << 14;

/// Up to `wanted` bytes.
std::size_t read_bytes(std::ifstream& file, void* into, std::size_t wanted) {
  file.read(static_cast<char*>(into), static_cast<std::streamsize>(wanted));
  return static_cast<std::size_t>(file.gcount());
}

/// The beginning of a file up to where its header ends, or as much of it as a header may have; its first line, if that is
/// not a recording's.
std::string read_header_text(std::ifstream& file) {
  std::string text(kRecordingMark.size(), '\0');
  std::size_t read = read_bytes(file, text.data(), text.size());
  text.resize(read);
  std::size_t searched = 0;
  for (read = kHeaderPiece; text.starts_with(kRecordingMark) && read == kHeaderPiece && text.size() < kLongestHeader &&
                            text.find(kLastHeaderLine, searched) == std::string::npos;) {
    const std::size_t before = text.size();
    searched = before - kLastHeaderLine.size();
    text.resize(before + kHeaderPiece);
    read = read_bytes(file, text.data() + before, kHeaderPiece);
    text.resize(before + read);
  }
  return text;
}

}  // namespace

RecordingReader::RecordingReader(const std::string& path) : file_(path, std::ios::binary) {
  std::string start;
  if (file_.is_open()) {
    errno = 0;
    start = read_header_text(file_);
  }
  if (errno != 0) {
    error_ = path + ": cannot be read: " + std::strerror(errno);
    return;
  }
  ParsedHeader parsed = parse_header(start);
  if (!parsed.error.empty()) {
    error_ = path + ": not a recording of this version: " + parsed.error;
    return;
  }
  header_ = std::move(parsed.header);
  cycle_bytes_ = cycle_bytes(header_.actuators, header_.start.size());
  values_.resize(header_.actuators + header_.start.size());
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(parsed.bytes));
}

bool RecordingReader::no_more(End end) {
  end_ = end;
  in_block_ = next_in_block_ = 0;
  file_.close();
  return false;
}

bool RecordingReader::read_block() {
  BlockHead head;
  if (read_bytes(file_, &head, sizeof head) < sizeof head) {
    return no_more(End::cut_off);
  }
  if (head.magic != BlockHead::kMagic || head.cycles > kMostCyclesOfBlock || head.kind > BlockHead::kEnd) {
    return no_more(End::damaged);
  }
  block_.resize(head.cycles * cycle_bytes_);
  if (read_bytes(file_, block_.data(), block_.size()) < block_.size()) {
    return no_more(End::cut_off);
  }
  if (head.checksum != head.checksum_with(block_)) {
    return no_more(file_.peek() == std::ifstream::traits_type::eof() ? End::cut_off : End::damaged);
  }
  if (head.kind == BlockHead::kEnd) {
    dropped_at_end_ = head.dropped;
    return no_more(End::closed);
  }
  next_in_block_ = 0;
  in_block_ = head.cycles;
  return true;
}

bool RecordingReader::next(RecordedCycle& cycle) {
  while (next_in_block_ == in_block_) {
    if (!file_.is_open() || !read_block()) {
      return false;
    }
  }
  const std::byte* const start = block_.data() + next_in_block_++ * cycle_bytes_;
  std::memcpy(&cycle.head, start, sizeof cycle.head);
  std::memcpy(values_.data(), start + sizeof cycle.head, values_.size() * sizeof(double));
  cycle.commands = std::span(values_).first(header_.actuators);
  cycle.readings = std::span(values_).subspan(header_.actuators);
  cycle.skipped_before = cycle.head.skipped_before();
  cycle.dropped_before = cycle.head.cycle - expected_ - cycle.skipped_before;
  dropped_ += cycle.dropped_before;
  expected_ = cycle.head.cycle + 1;
  ++cycles_;
  return true;
}

}  // namespace hotfire::hal
