// SPDX-License-Identifier: Apache-2.0
#include "firmware/replay/replay.hpp"

#include <bit>
#include <cstdio>

#include "firmware/image/image_plant.hpp"
#include "firmware/replay/lab_replay.hpp"
#include "firmware/service/status.hpp"
#include "firmware/text/json.hpp"
#include "firmware/text/text.hpp"
#include "hal/arithmetic/denormals.hpp"

namespace hotfire::firmware {
namespace {

using Reader = hal::RecordingReader;

/// The first of the recorded readings that is not the replayed one; empty if none.
std::string differing(const hal::RecordingHeader& header, std::span<const double> recorded,
                      std::span<const double> replayed) {
  std::string what;
  const std::size_t channels = header.channels.size();
  for (std::size_t i = 0; i < recorded.size() && what.empty(); ++i) {
    what = firmware::differing(header.channels[i % channels], i / channels, recorded[i], replayed[i]);
  }
  return what;
}

template <class Plant>
Replay replay_plant(Reader& reader, Plant& plant) {
  const hal::RecordingHeader& header = reader.header();
  Replay result;
  if (plant.actuators() != header.actuators || plant.measured().size() != header.start.size()) {
    result.error = "its actuators and channels are not those of topology " + std::string(Plant::topology);
    return result;
  }
  const std::string at_start = differing(header, header.start, plant.measured());
  if (!at_start.empty()) {
    result.difference = {0, "before the first cycle, " + at_start};
  }
  hal::Fnv1a hash;
  hal::Command command;
  replay_cycles(reader, result, [&](const hal::RecordedCycle& cycle) {
    std::copy(cycle.commands.begin(), cycle.commands.end(), command.values.begin());
    plant.step(command);
    plant.add_to(hash);
    const std::string what = differing(header, cycle.readings, plant.measured());
    return what.empty() && hash.value() != cycle.head.hash ? "the state behind equal readings" : what;
  });
  return result;
}

const char* name_of(Reader::End end) {
  switch (end) {
    case Reader::End::closed:
      return "closed";
    case Reader::End::cut_off:
      return "cut off: its writer was killed, or is still running";
    case Reader::End::damaged:
      break;
  }
  return "damaged: what follows the last readable block was not read";
}

std::string sentence(const Replay& result) {
  if (result.difference) {
    return text("cycle %llu is the first that differs: %s", whole(result.difference->cycle),
                result.difference->what.c_str());
  }
  if (result.gap) {
    return text("the same bits up to cycle %llu, which was dropped: what follows cannot be proved", whole(*result.gap));
  }
  return "every recorded cycle has the same bits";
}

std::string as_text(const std::string& path, const hal::RecordingHeader& header, const Replay& result) {
  std::string report =
      text("%s: %s, %u %s, period %g us, %s %016llx\n", path.c_str(), header.topology.c_str(), header.actuators,
           header.actuators == 1 ? "actuator" : "actuators", static_cast<double>(header.period_ns) * 1e-3,
           header.topology == kLabTopology ? "profile" : "model", whole(hal::model_hash(header.model)));
  report += text("  recorded      %s on %s by hotfire %s%s\n", header.started.c_str(), header.host.c_str(),
                 header.version.c_str(), header.version == HOTFIRE_VERSION ? "" : ", replayed by " HOTFIRE_VERSION);
  report += text("  cycles        %llu recorded, %llu dropped; %s\n", whole(result.recorded), whole(result.dropped),
                 name_of(result.end));
  report += text("  replayed      %llu cycles with the same bits\n", whole(result.proved));
  return report;
}

std::string as_json(const std::string& path, const hal::RecordingHeader& header, const Replay& result, bool good) {
  Json json;
  json.open();
  json.add("recording", path);
  json.add("verdict", good ? "good" : "bad");
  json.add("reason", sentence(result));
  json.add("topology", header.topology);
  json.add("actuators", header.actuators);
  json.add("period_us", static_cast<double>(header.period_ns) * 1e-3);
  json.add("model", text("%016llx", whole(hal::model_hash(header.model))));
  json.add("started", header.started);
  json.add("host", header.host);
  json.add("kernel", header.kernel);
  json.add("version", header.version);
  json.add("command_line", header.command_line);
  json.add("recorded_cycles", result.recorded);
  json.add("dropped_cycles", result.dropped);
  json.add("end", result.end == Reader::End::closed ? "closed" : result.end == Reader::End::cut_off ? "cut-off" : "damaged");
  json.add("proved_cycles", result.proved);
  if (result.difference) {
    json.add("first_difference", result.difference->cycle);
  }
  json.close();
  return json.text() + "\n";
}

}  // namespace

std::string differing(const hal::RecordedChannel& channel, std::size_t actuator, double recorded, double replayed) {
  if (std::bit_cast<std::uint64_t>(recorded) == std::bit_cast<std::uint64_t>(replayed)) {
    return {};
  }
  return text("%s of actuator %zu: recorded %.17g, replayed %.17g %s", channel.name.c_str(), actuator + 1, recorded,
              replayed, channel.unit.c_str());
}

void replay_cycles(Reader& reader, Replay& result,
                   const std::function<std::string(const hal::RecordedCycle&)>& difference_in) {
  hal::RecordedCycle cycle;
  while (reader.next(cycle)) {
    if (cycle.dropped_before > 0 && !result.gap) {
      result.gap = cycle.head.cycle - cycle.dropped_before;
    }
    if (result.gap || result.difference) {
      continue;
    }
    const std::string what = difference_in(cycle);
    if (what.empty()) {
      ++result.proved;
    } else {
      result.difference = {cycle.head.cycle, what};
    }
  }
  result.recorded = reader.cycles();
  result.dropped = reader.dropped();
  result.end = reader.end();
}

Replay replay(Reader& reader) {
  if (reader.header().topology == kLabTopology) {
    return replay_lab(reader);
  }
  const PlantImage image = parse_plant_image(reader.header().model, "the model in the header");
  const double period = static_cast<double>(reader.header().period_ns) * 1e-9;
  Replay refused;
  refused.error = image.parameters ? refused_record(image, period) : image.error;
  if (!refused.error.empty()) {
    return refused;
  }
  const hal::FlushDenormals flush;
  return with_plant(image, period, reader.header().actuators,
                    [&](const auto& plant) { return replay_plant(reader, *plant); });
}

int run_replay(const std::string& path, bool json) {
  Reader reader(path);
  if (!reader.error().empty()) {
    std::fprintf(stderr, "hotfire-rt: %s\n", reader.error().c_str());
    return kBadData;
  }
  const Replay result = replay(reader);
  if (!result.error.empty()) {
    std::fprintf(stderr, "hotfire-rt: %s: %s\n", path.c_str(), result.error.c_str());
    return kBadData;
  }
  const bool good = !result.difference && !result.gap && result.end != Reader::End::damaged;
  std::string report = json ? as_json(path, reader.header(), result, good) : as_text(path, reader.header(), result);
  if (!json) {
    report += text("\nverdict: %s (%s)\n", good ? "good" : "BAD", sentence(result).c_str());
  }
  std::fputs(report.c_str(), stdout);
  if (result.end == Reader::End::damaged) {
    return kBadData;
  }
  return good ? kGood : kBadVerdict;
}

}  // namespace hotfire::firmware
