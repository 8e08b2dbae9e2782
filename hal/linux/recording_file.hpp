// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "hal/realtime.hpp"
#include "hal/recording/sink.hpp"

namespace hotfire::hal {

/// A recording on a disk, of at most `most_bytes`, readable for its user and group (mode 0640). The file is locked while it
/// is written: the name belongs to one program.
///
/// An older file of its name is refused. A recorder that may `overwrite` takes the name of an older recording that no
/// program writes any more. It follows no symbolic link.
class RecordingFile final : public RecordingSink {
 public:
  RecordingFile(std::string path, std::uint64_t most_bytes, bool overwrite = false)
      : path_(std::move(path)), most_bytes_(most_bytes), overwrite_(overwrite) {}
  ~RecordingFile() override;

  /// Makes the file with its header. It gets its name only when the header is on the disk, so a file of that name can always
  /// be opened. It takes the name only if no other program has it.
  std::optional<Failure> create(std::string_view header);

  std::optional<SinkRefusal> append(std::span<const std::byte> head, std::span<const std::byte> content) override;
  std::optional<SinkRefusal> sync() override;

 private:
  std::optional<Failure> refuse_what_stands_there();
  bool take_name(const std::string& unnamed) const;

  std::string path_;
  std::uint64_t most_bytes_;
  bool overwrite_;
  std::uint64_t bytes_ = 0;
  int file_ = -1;
  int older_ = -1;        ///< what is overwritten, locked until it is
  bool is_torn_ = false;  ///< a block that is not whole ends it
};

}  // namespace hotfire::hal
