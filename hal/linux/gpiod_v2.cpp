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

constexpr std::size_t kEdgeQueue = 16 * kMaxGpioLines;

/// What the library makes and frees, freed by `Free`.
template <class Thing, void (*Free)(Thing*)>
struct Freed {
  void operator()(Thing* thing) const noexcept { Free(thing); }
};
template <class Thing, void (*Free)(Thing*)>
using Owned = std::unique_ptr<Thing, Freed<Thing, Free>>;

using Chip = Owned<gpiod_chip, gpiod_chip_close>;
using ChipInfo = Owned<gpiod_chip_info, gpiod_chip_info_free>;
using LineSettings = Owned<gpiod_line_settings, gpiod_line_settings_free>;
using LineConfig = Owned<gpiod_line_config, gpiod_line_config_free>;
using RequestConfig = Owned<gpiod_request_config, gpiod_request_config_free>;
using LineRequest = Owned<gpiod_line_request, gpiod_line_request_release>;
using EdgeBuffer = Owned<gpiod_edge_event_buffer, gpiod_edge_event_buffer_free>;

gpiod_line_bias bias_of(GpioBias bias) {
  switch (bias) {
    case GpioBias::pull_up:
      return GPIOD_LINE_BIAS_PULL_UP;
    case GpioBias::pull_down:
      return GPIOD_LINE_BIAS_PULL_DOWN;
    case GpioBias::disabled:
      return GPIOD_LINE_BIAS_DISABLED;
    case GpioBias::as_is:
      break;
  }
  return GPIOD_LINE_BIAS_AS_IS;
}

gpiod_line_value value_of(bool active) { return active ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE; }

Chip open_chip(const std::string& wanted) {
  for (const std::string& place : places_of_chip(wanted)) {
    Chip chip(gpiod_chip_open(place.c_str()));
    const ChipInfo info(chip ? gpiod_chip_get_info(chip.get()) : nullptr);
    if (info && (place == wanted || wanted == gpiod_chip_info_get_name(info.get()) ||
                 wanted == gpiod_chip_info_get_label(info.get()))) {
      return chip;
    }
  }
  return nullptr;
}

/// Lines requested together, in the order of the settings.
struct Lines {
  LineRequest request;
  std::array<unsigned, kMaxGpioLines> offsets{};
  std::size_t count = 0;
};

}  // namespace

struct GpiodLines::Request {
  Lines inputs;
  Lines outputs;
  EdgeBuffer buffer;
  std::array<unsigned long, kMaxGpioLines> edges_seen{};
  std::uint64_t lost = 0;

  bool take_inputs(gpiod_chip* chip, const GpioSettings& settings) noexcept;
  bool take_outputs(gpiod_chip* chip, const GpioSettings& settings) noexcept;
};

namespace {

/// Requests the lines of `into`; `set(line, i)` makes the settings of the i-th of them.
template <class Set>
bool request(gpiod_chip* chip, const std::string& consumer, Lines& into, Set&& set) {
  const LineConfig lines(gpiod_line_config_new());
  const LineSettings line(gpiod_line_settings_new());
  const RequestConfig config(gpiod_request_config_new());
  if (!lines || !line || !config) {
    return false;
  }
  for (std::size_t i = 0; i < into.count; ++i) {
    set(line.get(), i);
    if (gpiod_line_config_add_line_settings(lines.get(), &into.offsets[i], 1, line.get()) != 0) {
      return false;
    }
  }
  gpiod_request_config_set_consumer(config.get(), consumer.c_str());
  gpiod_request_config_set_event_buffer_size(config.get(), kEdgeQueue);
  into.request.reset(gpiod_chip_request_lines(chip, config.get(), lines.get()));
  return into.request != nullptr;
}

}  // namespace

bool GpiodLines::Request::take_inputs(gpiod_chip* chip, const GpioSettings& settings) noexcept {
  const auto set = [&](gpiod_line_settings* line, std::size_t i) {
    const GpioInput& input = settings.inputs[i];
    gpiod_line_settings_set_direction(line, GPIOD_LINE_DIRECTION_INPUT);
    gpiod_line_settings_set_bias(line, bias_of(settings.bias));
    gpiod_line_settings_set_active_low(line, input.active_low);
    gpiod_line_settings_set_edge_detection(line, input.edges ? GPIOD_LINE_EDGE_BOTH : GPIOD_LINE_EDGE_NONE);
    gpiod_line_settings_set_event_clock(line, GPIOD_LINE_CLOCK_MONOTONIC);
  };
  if (!request(chip, settings.consumer, inputs, set)) {
    return false;
  }
  buffer.reset(gpiod_edge_event_buffer_new(kEdgeQueue));
  const int file = gpiod_line_request_get_fd(inputs.request.get());
  return buffer != nullptr && fcntl(file, F_SETFL, fcntl(file, F_GETFL) | O_NONBLOCK) == 0;
}

bool GpiodLines::Request::take_outputs(gpiod_chip* chip, const GpioSettings& settings) noexcept {
  return request(chip, settings.consumer, outputs, [&](gpiod_line_settings* line, std::size_t i) {
    const GpioOutput& output = settings.outputs[i];
    gpiod_line_settings_set_direction(line, GPIOD_LINE_DIRECTION_OUTPUT);
    gpiod_line_settings_set_active_low(line, output.active_low);
    gpiod_line_settings_set_output_value(line, value_of(output.safe));
  });
}

GpiodLines::GpiodLines(GpioSettings settings) : settings_(std::move(settings)), request_(std::make_unique<Request>()) {}

GpiodLines::~GpiodLines() {
  GpioLevels safe = 0;
  for (std::size_t i = 0; i < settings_.outputs.size(); ++i) {
    safe |= settings_.outputs[i].safe ? GpioLevels{1} << i : 0;
  }
  if (request_->outputs.request) {
    try_write(safe);
  }
}

std::optional<Failure> GpiodLines::open() noexcept {
  if (auto refused = refuse_line_count(settings_)) {
    return refused;
  }
  errno = 0;
  const Chip chip = open_chip(settings_.chip);
  if (!chip) {
    return no_chip(settings_.chip, errno == 0 ? ENOENT : errno);
  }
  const auto find = [&](const auto& wanted, Lines& lines) -> std::optional<Failure> {
    for (const auto& line : wanted) {
      const int offset = gpiod_chip_get_line_offset_from_name(chip.get(), line.line.c_str());
      if (offset < 0) {
        return no_line(settings_.chip, line.line);
      }
      lines.offsets[lines.count++] = static_cast<unsigned>(offset);
    }
    return std::nullopt;
  };
  if (auto refused = find(settings_.inputs, request_->inputs)) {
    return refused;
  }
  if (auto refused = find(settings_.outputs, request_->outputs)) {
    return refused;
  }
  if (request_->inputs.count > 0 && !request_->take_inputs(chip.get(), settings_)) {
    return not_requested(settings_.chip, "inputs", errno);
  }
  if (request_->outputs.count > 0 && !request_->take_outputs(chip.get(), settings_)) {
    return not_requested(settings_.chip, "outputs", errno);
  }
  return std::nullopt;
}

bool GpiodLines::try_read(GpioLevels& levels) noexcept {
  const Lines& inputs = request_->inputs;
  std::array<gpiod_line_value, kMaxGpioLines> values{};
  if (inputs.count > 0 &&
      gpiod_line_request_get_values_subset(inputs.request.get(), inputs.count, inputs.offsets.data(), values.data()) != 0) {
    return false;
  }
  levels = 0;
  for (std::size_t i = 0; i < inputs.count; ++i) {
    levels |= values[i] == GPIOD_LINE_VALUE_ACTIVE ? GpioLevels{1} << i : 0;
  }
  return true;
}

bool GpiodLines::try_write(GpioLevels levels) noexcept {
  const Lines& outputs = request_->outputs;
  std::array<gpiod_line_value, kMaxGpioLines> values{};
  for (std::size_t i = 0; i < outputs.count; ++i) {
    values[i] = value_of(((levels >> i) & 1U) != 0);
  }
  return outputs.count == 0 || gpiod_line_request_set_values_subset(outputs.request.get(), outputs.count,
                                                                    outputs.offsets.data(), values.data()) == 0;
}

std::size_t GpiodLines::read_edges(std::span<GpioEdge> edges) noexcept {
  const Lines& inputs = request_->inputs;
  if (!inputs.request) {
    return 0;
  }
  const int count =
      gpiod_line_request_read_edge_events(inputs.request.get(), request_->buffer.get(), std::min(edges.size(), kEdgeQueue));
  for (int i = 0; i < count; ++i) {
    gpiod_edge_event* event = gpiod_edge_event_buffer_get_event(request_->buffer.get(), static_cast<unsigned long>(i));
    const auto* const end = inputs.offsets.begin() + inputs.count;
    const auto* const at = std::find(inputs.offsets.begin(), end, gpiod_edge_event_get_line_offset(event));
    const auto input = static_cast<std::size_t>(at - inputs.offsets.begin());
    const unsigned long number = gpiod_edge_event_get_line_seqno(event);
    request_->lost += number - request_->edges_seen[input] - 1;
    request_->edges_seen[input] = number;
    edges[static_cast<std::size_t>(i)] = {input, gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_RISING_EDGE,
                                          static_cast<std::int64_t>(gpiod_edge_event_get_timestamp_ns(event))};
  }
  return static_cast<std::size_t>(std::max(count, 0));
}

std::uint64_t GpiodLines::lost_edges() const noexcept { return request_->lost; }

}  // namespace hotfire::hal
