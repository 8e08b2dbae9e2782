// SPDX-License-Identifier: Apache-2.0
#include "tools/trials/fine_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace hotfire::trials {

namespace {

constexpr double kSettled = 6.907755;  // ln 1000

/// Of an amplitude that fades as e^{-rate t}; without damping it never does.
double time_to_settle(double rate) { return rate > 0.0 ? kSettled / rate : kLongestDwell; }

}  // namespace

double settling_time(const ModelFile& model) {
  if (const auto* direct = std::get_if<DirectParameters>(&model.parameters)) {
    return time_to_settle(0.5 * direct->mass.damping / direct->mass.inertia);
  }
  const auto& engine = std::get<SimplexParameters>(model.parameters).engine;
  return time_to_settle(0.5 * engine.viscous_damping / engine.inertia);
}

double settling_time(const VehicleFile& model, double lowest, double highest) {
  return std::visit(
      [&](const auto& parameters) {
        double longest = 0.0;
        for (const auto& axis : parameters.axes) {
          longest = std::max(longest, time_to_settle(0.5 * axis.engine.viscous_damping / axis.engine.inertia));
        }
        for (int k = 0; k < parameters.modes.modes; ++k) {
          const auto mode = static_cast<std::size_t>(k);
          const double frequency = parameters.modes.frequency[mode];
          if (frequency >= lowest && frequency <= highest) {
            const double rate = 2.0 * std::numbers::pi * frequency * parameters.modes.damping_ratio[mode];
            longest = std::max(longest, time_to_settle(rate));
          }
        }
        return longest;
      },
      model.parameters);
}

double settled_dwell(double settling) { return std::clamp(2.0 * settling, kShortestDwell, kLongestDwell); }

std::vector<double> fine_sines(const std::vector<SineBand>& bands, const std::vector<ChannelSweep>& coarse,
                               double settling) {
  constexpr double kReach = 1.0 + 25 * 0.0025;
  constexpr int kFrequencies = 51;
  const double dwell = settled_dwell(settling);
  std::vector<double> command;
  const auto append = [&command](const std::vector<double>& more) {
    // A sweep ends in a row at rest, where the next begins.
    if (!command.empty()) {
      command.pop_back();
    }
    command.insert(command.end(), more.begin(), more.end());
  };
  for (const SineBand& band : bands) {
    const ChannelSweep* piston = find_sweep(coarse, "piston", band.amplitude);
    const double notch = piston != nullptr && piston->notch ? piston->notch->frequency : 0.0;
    SineBand rest{band.amplitude, {}};
    std::copy_if(band.frequencies.begin(), band.frequencies.end(), std::back_inserter(rest.frequencies),
                 [&](double frequency) { return frequency < notch / kReach || frequency > notch * kReach; });
    append(stepped_sines({rest}, dwell));
    if (notch > 0.0) {
      append(stepped_sines({{band.amplitude, spaced(notch / kReach, notch * kReach, kFrequencies)}}, dwell));
    }
  }
  return command;
}

}  // namespace hotfire::trials
