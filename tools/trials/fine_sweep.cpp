// SPDX-License-Identifier: Apache-2.0
#include "tools/trials/fine_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>
#include <variant>

namespace hotfire::trials {

namespace {

constexpr double kResidue = 1e-3;  // what may be left of a free motion, relative to its part of the response

/// A free motion of the structure.
struct Mode {
  double frequency;  ///< [Hz]
  double rate;       ///< its amplitude fades as e^{-rate t} [1/s]
};

/// Half a dwell for a motion that fades at `rate`; without damping it never does.
double half_dwell_for(double rate) {
  constexpr double kLongest = 0.5 * kLongestEngineDwell;
  return rate > 0.0 ? std::min(-std::log(kResidue) / rate, kLongest) : kLongest;
}

double half_dwell_for(const model::Engine<double>& engine) {
  return half_dwell_for(0.5 * engine.viscous_damping / engine.inertia);
}

double half_dwell_for(const SimplexParameters& axis) { return half_dwell_for(axis.engine); }

double half_dwell_for(const DirectParameters& direct) {
  return half_dwell_for(0.5 * direct.mass.damping / direct.mass.inertia);
}

double half_dwell_for(const ImposedMotionParameters&) { return half_dwell_for(0.0); }

double half_dwell_for(const ModalParameters&) { return half_dwell_for(0.0); }

double half_dwell_for(const ElectromechanicalParameters&) { return half_dwell_for(0.0); }

/// What a fit of a sine of `frequency` over the second half of a dwell takes from a mode that began with it.
double taken_from(const Mode& mode, double frequency, double half) {
  const double overlap = std::numbers::pi * half * std::abs(frequency - mode.frequency);
  return std::exp(-mode.rate * half) / std::max(1.0, overlap);
}

/// Half a dwell at `frequency` for a mode.
double half_dwell_for(const Mode& mode, double frequency) {
  double shortest = 0.0;
  double longest = 0.5 * kLongestDwell;
  constexpr int kHalvings = 24;  // to 1e-4 s
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (shortest + longest);
    (taken_from(mode, frequency, middle) > kResidue ? shortest : longest) = middle;
  }
  return longest;
}

LeastDwell dwell_of(double half, std::vector<Mode> modes) {
  return [half, modes = std::move(modes)](double frequency) {
    double longest = std::max(half, 0.5 * kShortestDwell);
    for (const Mode& mode : modes) {
      longest = std::max(longest, half_dwell_for(mode, frequency));
    }
    return 2.0 * longest;
  };
}

}  // namespace

LeastDwell settled_dwell(const ModelFile& model) {
  return dwell_of(std::visit([](const auto& parameters) { return half_dwell_for(parameters); }, model.parameters), {});
}

LeastDwell settled_dwell(const VehicleFile& model, double lowest, double highest) {
  return std::visit(
      [&](const auto& parameters) {
        double half = 0.0;
        for (const auto& axis : parameters.axes) {
          half = std::max(half, half_dwell_for(axis.engine));
        }
        std::vector<Mode> modes;
        for (int k = 0; k < parameters.modes.modes; ++k) {
          const auto mode = static_cast<std::size_t>(k);
          const double frequency = parameters.modes.frequency[mode];
          if (frequency >= lowest && frequency <= highest) {
            modes.push_back({frequency, 2.0 * std::numbers::pi * frequency * parameters.modes.damping_ratio[mode]});
          }
        }
        return dwell_of(half, std::move(modes));
      },
      model.parameters);
}

std::vector<double> fine_sines(const std::vector<SineBand>& bands, const std::vector<ChannelSweep>& coarse,
                               const LeastDwell& dwell) {
  constexpr double kReach = 1.0 + 25 * 0.0025;
  constexpr int kFrequencies = 51;
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
