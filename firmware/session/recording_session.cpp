// SPDX-License-Identifier: Apache-2.0
#include "firmware/session/recording_session.hpp"

#include <cmath>
#include <ctime>

#include "hal/recording/format.hpp"

namespace hotfire::firmware {
namespace {

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
  return text;
}

std::size_t ring_slots(double seconds, std::int64_t period_ns) {
  return static_cast<std::size_t>(std::ceil(seconds * 1e9 / static_cast<double>(period_ns)));
}

}  // namespace

hal::RecordingHeader recording_header(const RunOptions& options, const RecordedPlant& plant) {
  const hal::SystemInfo system = hal::system_info();
  hal::RecordingHeader header;
  header.version = HOTFIRE_VERSION;
  header.started = now_utc();
  header.host = system.nodename;
  header.kernel = system.release + " " + system.version + " " + system.machine;
  header.command_line = options.command_line;
  header.topology = plant.topology;
  header.period_ns = options.loop.period_ns;
  header.steps_per_cycle = static_cast<unsigned>(plant.steps_per_cycle);
  header.actuators = static_cast<unsigned>(options.actuators);
  header.input = plant.input;
  header.channels = plant.channels;
  header.start = plant.start;
  header.model = plant.image;
  return header;
}

RecordingSession::RecordingSession(const RunOptions& run, const ImageOptions& options, const RecordedPlant& plant)
    : file_(options.recording, options.record_max_mib << 20, options.overwrite),
      header_(hal::header_text(recording_header(run, plant))),
      recorder_(file_, run.actuators, plant.start.size(), ring_slots(options.record_buffer_s, run.loop.period_ns)) {}

std::optional<hal::Failure> RecordingSession::start() {
  std::optional<hal::Failure> failure = file_.create(header_);
  return failure ? failure : recorder_.start();
}

}  // namespace hotfire::firmware
