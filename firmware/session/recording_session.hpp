// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware/recording/recorder.hpp"
#include "firmware/session/options.hpp"
#include "hal/linux/recording_file.hpp"

namespace hotfire::firmware {

/// The properties of a plant that its recording contains.
struct RecordedPlant {
  std::string topology;
  hal::RecordedChannel input;
  std::vector<hal::RecordedChannel> channels;
  std::vector<double> start;  ///< what its sensors read before the first cycle
  int steps_per_cycle = 1;
  std::string image;

  template <class Plant>
  static RecordedPlant of(const Plant& plant, const std::string& image) {
    const auto unit = [](std::string_view own) { return std::string(own.empty() ? "1" : own); };
    RecordedPlant result;
    result.topology = Plant::topology;
    result.input = {std::string(Plant::input_channel), unit(Plant::input_unit)};
    for (std::size_t i = 0; i < Plant::channels.size(); ++i) {
      result.channels.push_back({std::string(Plant::channels[i]), unit(Plant::channel_units[i])});
    }
    result.start.assign(plant.measured().begin(), plant.measured().end());
    result.steps_per_cycle = plant.steps_per_cycle();
    result.image = image;
    return result;
  }
};

/// The origin of a run and the meaning of its numbers.
hal::RecordingHeader recording_header(const RunOptions& options, const RecordedPlant& plant);

/// A file, and the recorder that writes it.
class RecordingSession {
 public:
  RecordingSession(const RunOptions& run, const ImageOptions& options, const RecordedPlant& plant);
  /// Of the options of a mode that records.
  template <class Recorded>
  RecordingSession(const Recorded& options, const RecordedPlant& plant) : RecordingSession(options, options, plant) {}

  /// Makes the file and starts the thread. To be called before the real-time set-up of the calling thread.
  std::optional<hal::Failure> start();

  Recorder& recorder() noexcept { return recorder_; }
  const RecorderAccount& close() { return account_ = recorder_.close(); }

 private:
  hal::RecordingFile file_;
  std::string header_;
  Recorder recorder_;
  RecorderAccount account_;
};

}  // namespace hotfire::firmware
