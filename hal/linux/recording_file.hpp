#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/realtime.hpp"
#include "hal/recording/sink.hpp"

namespace hotfire::hal {

/// A recording on a disk, of at most `most_bytes`. An older file of its name is refused unless it may `overwrite` that one.
class RecordingFile final : public RecordingSink {
 public:
  RecordingFile(std::string path, std::uint64_t most_bytes, bool overwrite = false)
      : path_(std::move(path)), most_bytes_(most_bytes), overwrite_(overwrite) {}
  ~RecordingFile() override;

  /// Makes the file with its header. It has its name only once the header is on the disk, so that a file of that name can
  /// always be opened.
  std::optional<Failure> create(std::string_view header);

  std::string append(std::span<const std::byte> head, std::span<const std::byte> content) override;
  void sync() override;

 private:
  std::string path_;
  std::uint64_t most_bytes_;
  bool overwrite_;
  std::uint64_t bytes_ = 0;
  int file_ = -1;
};

}  // namespace hotfire::hal
