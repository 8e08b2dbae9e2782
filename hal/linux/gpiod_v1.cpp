// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gpiod.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "hal/linux/gpio_refusals.hpp"
#include "hal/linux/gpiod_lines.hpp"

namespace hotfire::hal {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::size_t kKernelQueue = 16;  ///< edges that the kernel keeps for a line

int flags_of(GpioBias bias) {
  switch (bias) {
    case GpioBias::pull_up:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
    case GpioBias::pull_down:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
    case GpioBias::disabled:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
    case GpioBias::as_is:
      break;
  }
  return 0;
}

gpiod_chip* open_chip(const std::string& wanted) {
  for (const std::string& place : places_of_chip(wanted)) {
    if (gpiod_chip* chip = gpiod_chip_open(place.c_str())) {
      if (place == wanted || wanted == gpiod_chip_name(chip) || wanted == gpiod_chip_label(chip)) {
        return chip;
      }
      gpiod_chip_close(chip);
    }
  }
  return nullptr;
}

/// Lines requested together, and the place of each in the settings.
struct Bulk {
  gpiod_line_bulk lines = GPIOD_LINE_BULK_INITIALIZER;
  std::array<std::size_t, kMaxGpioLines> places{};

  void add(gpiod_line* line, std::size_t place) {
    places[lines.num_lines] = place;
    gpiod_line_bulk_add(&lines, line);
  }

  /// Puts the levels that the lines carry into `levels`.
  bool read(GpioLevels& levels) noexcept {
    std::array<int, GPIOD_LINE_BULK_MAX_LINES> values{};
    if (lines.num_lines > 0 && gpiod_line_get_value_bulk(&lines, values.data()) != 0) {
      return false;
    }
    for (std::size_t i = 0; i < lines.num_lines; ++i) {
      levels |= values[i] != 0 ? GpioLevels{1} << places[i] : 0;
    }
    return true;
  }
};

}  // namespace

/// One request has one set of flags in this version, so that active-low is done here, line by line.
struct GpiodLines::Request {
  gpiod_chip* chip = nullptr;
  Bulk plain;
  Bulk with_edges;
  Bulk outputs;
  GpioLevels low_inputs = 0;
  GpioLevels low_outputs = 0;
  GpioLevels safe = 0;
  bool drives = false;

  std::optional<Failure> find(const GpioSettings& settings);
  std::optional<Failure> take(const GpioSettings& settings) noexcept;

  int set_outputs(GpioLevels levels) noexcept {
    std::array<int, GPIOD_LINE_BULK_MAX_LINES> values{};
    for (std::size_t i = 0; i < outputs.lines.num_lines; ++i) {
      values[i] = static_cast<int>(((levels ^ low_outputs) >> i) & 1U);
    }
    return outputs.lines.num_lines == 0 ? 0 : gpiod_line_set_value_bulk(&outputs.lines, values.data());
  }
};

std::optional<Failure> GpiodLines::Request::find(const GpioSettings& settings) {
  chip = open_chip(settings.chip);
  if (chip == nullptr) {
    return no_chip(settings.chip, errno == 0 ? ENOENT : errno);
  }
  for (std::size_t i = 0; i < settings.inputs.size(); ++i) {
    const GpioInput& input = settings.inputs[i];
    gpiod_line* line = gpiod_chip_find_line(chip, input.line.c_str());
    if (line == nullptr) {
      return no_line(settings.chip, input.line);
    }
    (input.edges ? with_edges : plain).add(line, i);
    low_inputs |= input.active_low ? GpioLevels{1} << i : 0;
  }
  for (std::size_t i = 0; i < settings.outputs.size(); ++i) {
    const GpioOutput& output = settings.outputs[i];
    gpiod_line* line = gpiod_chip_find_line(chip, output.line.c_str());
    if (line == nullptr) {
      return no_line(settings.chip, output.line);
    }
    outputs.add(line, i);
    low_outputs |= output.active_low ? GpioLevels{1} << i : 0;
    safe |= output.safe ? GpioLevels{1} << i : 0;
  }
  return std::nullopt;
}

std::optional<Failure> GpiodLines::Request::take(const GpioSettings& settings) noexcept {
  const char* consumer = settings.consumer.c_str();
  const int flags = flags_of(settings.bias);
  if ((plain.lines.num_lines > 0 && gpiod_line_request_bulk_input_flags(&plain.lines, consumer, flags) != 0) ||
      (with_edges.lines.num_lines > 0 &&
       gpiod_line_request_bulk_both_edges_events_flags(&with_edges.lines, consumer, flags) != 0)) {
    return not_requested(settings.chip, "inputs", errno);
  }
  for (std::size_t i = 0; i < with_edges.lines.num_lines; ++i) {
    const int file = gpiod_line_event_get_fd(with_edges.lines.lines[i]);
    const int flags_of_file = fcntl(file, F_GETFL);
    // The loop would wait for an edge else.
    if (flags_of_file < 0 || fcntl(file, F_SETFL, flags_of_file | O_NONBLOCK) != 0) {
      return not_requested(settings.chip, "edges", errno);
    }
  }
  std::array<int, GPIOD_LINE_BULK_MAX_LINES> values{};
  for (std::size_t i = 0; i < outputs.lines.num_lines; ++i) {
    values[i] = static_cast<int>(((safe ^ low_outputs) >> i) & 1U);
  }
  if (outputs.lines.num_lines > 0 && gpiod_line_request_bulk_output(&outputs.lines, consumer, values.data()) != 0) {
    return not_requested(settings.chip, "outputs", errno);
  }
  drives = true;
  return std::nullopt;
}

GpiodLines::GpiodLines(GpioSettings settings) : settings_(std::move(settings)), request_(std::make_unique<Request>()) {}

GpiodLines::~GpiodLines() {
  if (request_->drives) {
    request_->set_outputs(request_->safe);
  }
  if (request_->chip != nullptr) {
    gpiod_chip_close(request_->chip);  // releases its lines
  }
}

std::optional<Failure> GpiodLines::open() noexcept {
  errno = 0;
  if (auto refused = refuse_line_count(settings_)) {
    return refused;
  }
  if (auto refused = request_->find(settings_)) {
    return refused;
  }
  return request_->take(settings_);
}

bool GpiodLines::try_read(GpioLevels& levels) noexcept {
  GpioLevels carried = 0;
  if (!request_->plain.read(carried) || !request_->with_edges.read(carried)) {
    return false;
  }
  levels = carried ^ request_->low_inputs;
  return true;
}

bool GpiodLines::try_write(GpioLevels levels) noexcept { return request_->set_outputs(levels) == 0; }

std::size_t GpiodLines::read_edges(std::span<GpioEdge> edges) noexcept {
  std::size_t taken = 0;
  Bulk& bulk = request_->with_edges;
  for (std::size_t i = 0; i < bulk.lines.num_lines && taken < edges.size(); ++i) {
    std::array<gpiod_line_event, kKernelQueue> events{};
    const auto room = static_cast<unsigned>(std::min(events.size(), edges.size() - taken));
    const int count = gpiod_line_event_read_multiple(bulk.lines.lines[i], events.data(), room);
    const bool low = ((request_->low_inputs >> bulk.places[i]) & 1U) != 0;
    for (int event = 0; event < count; ++event) {
      const gpiod_line_event& seen = events[static_cast<std::size_t>(event)];
      const bool rising = seen.event_type == GPIOD_LINE_EVENT_RISING_EDGE;
      edges[taken++] = {bulk.places[i], rising != low, seen.ts.tv_sec * kSecond + seen.ts.tv_nsec};
    }
  }
  return taken;
}

std::uint64_t GpiodLines::lost_edges() const noexcept { return 0; }

}  // namespace hotfire::hal
