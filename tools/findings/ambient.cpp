// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/effects/load/soft_stiffness.hpp"
#include "tools/analysis/free_decay.hpp"
#include "tools/findings/parameters.hpp"
#include "tools/findings/rows.hpp"
#include "tools/simulate/simulate_vehicle.hpp"
#include "tools/trials/disturbed.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/profiles.hpp"

namespace hotfire::findings {

namespace {

VehicleFile linear_actuator(const Bench& bench) { return without(bench, Physics::soft_stiffness).ambient(); }

VehicleFile softer_actuator(const Bench& bench) {
  VehicleFile stage = bench.ambient();
  for (auto& axis : std::get<TaosParameters>(stage.parameters).axes) {
    effect_of<model::SoftStiffness>(axis).low_stiffness = 4.5e7;
  }
  return stage;
}

/// Width of a spectrum's peak at half of its density [Hz].
double half_power_width(const analysis::Spectrum& spectrum, double frequency) {
  const auto top = static_cast<std::size_t>(std::lround(frequency / spectrum.resolution));
  std::size_t first = top;
  std::size_t last = top;
  while (first > 0 && spectrum.density[first] > 0.5 * spectrum.density[top]) {
    --first;
  }
  while (last + 1 < spectrum.density.size() && spectrum.density[last] > 0.5 * spectrum.density[top]) {
    ++last;
  }
  return static_cast<double>(last - first) * spectrum.resolution;
}

}  // namespace

Outcome locked_pendulum(const Bench& bench) {
  const trials::Hammer blow{168.0, 1.0};
  const auto frequency = [&](const Record& record) {
    const auto decay = analysis::free_decay(trials::swing(record, "engine.pitch"), record.period, blow.seconds);
    return decay ? decay->frequency : kNone;
  };
  const Record soft = trials::hammer(bench.ambient(), kPitch, blow);
  Outcome outcome;
  outcome.figures.push_back({"pendulum with linear stiffness of the actuator",
                             frequency(trials::hammer(linear_actuator(bench), kPitch, blow)), 7.5, 8.0, "Hz"});
  outcome.figures.push_back(near("pendulum with soft stiffness", frequency(soft), 6.75, 0.01, "Hz"));
  outcome.figures.push_back({"a tenth of the blow: higher by",
                             frequency(trials::hammer(bench.ambient(), kPitch, {0.1 * blow.impulse, 1.0})) / frequency(soft),
                             1.1, 1.4, ""});
  outcome.figures.push_back(near("softer actuator (4.5e7 N/m) under a smaller blow (160 N m s)",
                                 frequency(trials::hammer(softer_actuator(bench), kPitch, {160.0, blow.seconds})), 6.75,
                                 0.01, "Hz"));
  outcome.picture = trials::time_chart("F3: swing of the engine after a blow, actuators locked", soft, kPitch);
  outcome.note =
      "The blow is 168 N m s, about that of a sledgehammer at the nozzle, and the frequency is that of the first"
      " second. The blow is not published: it is tuned to 6.75 Hz. A weaker blow does not break the friction of "
      "the bearing under the weight of the engine. The bristles then stiffen the swing. They also raise the "
      "linear figure, which the paper has from finite elements without friction. The last row shows that 6.75 Hz"
      " does not determine the softness as well.";
  return outcome;
}

Outcome quiescent_peaks(const Bench& bench) {
  Outcome outcome;
  std::vector<std::string> labels;
  std::vector<analysis::Spectrum> spectra;
  std::vector<double> peaks;
  double widest = 0.0;
  struct Excitation {
    double density;
    double lowest;  ///< frequency of the peak
    double highest;
  };
  // The weakest and the strongest are the published peaks within a resolution of the spectrum; between them it may be
  // anywhere.
  for (const auto& [density, lowest, highest] :
       {Excitation{1.0, 8.0, 8.4}, {1e3, 5.7, 8.4}, {1e4, 5.7, 8.4}, {1e5, 5.7, 6.1}}) {
    trials::Quiescence quiet;
    quiet.torque_density = density;
    const Record record = trials::quiescent(bench.ambient(), kPitch, quiet);
    spectra.push_back(analysis::welch_spectrum(record.find("piston.pitch")->values, record.period, {16000}));
    labels.push_back(fmt::format("{:g} (N m)^2/Hz", density));
    const auto peak = analysis::find_peak(spectra.back(), 3.0, 12.0);
    peaks.push_back(peak ? peak->frequency : kNone);
    widest = peak ? std::max(widest, half_power_width(spectra.back(), peak->frequency)) : kNone;
    outcome.figures.push_back({fmt::format("largest peak under {}", labels.back()), peaks.back(), lowest, highest, "Hz"});
  }
  const double moved = peaks.front() - peaks.back();
  outcome.figures.push_back({"the peak moves down with the excitation by", moved, 1.5, 2.5, "Hz"});
  outcome.figures.push_back({"over the widest peak at half power", moved / widest, 1.0, 20.0, ""});
  outcome.picture = trials::spectrum_chart("F4: quiescent piston", labels, spectra, 3.0, 12.0);
  outcome.note =
      "Random torque of four strengths acts on both axes. The excitation of the measured records is not "
      "published. The bearing sticks under the weakest torque and slides under the strongest. The peaks span the"
      " published 5.9 to 8.2 Hz. Nothing is tuned to them.";
  return outcome;
}

Outcome ambient_sweep(const Bench& bench) {
  Outcome outcome;
  std::vector<trials::ChannelSweep> drawn;
  for (const double amplitude : {0.1, 0.2, 0.4}) {
    const auto command = trials::stepped_sines({{trials::radians(amplitude), trials::spaced(5.2, 10.5, 90)}});
    const auto sweeps = swept(bench.ambient(), kPitch, command, 5.2, 10.5);
    drawn.push_back(*trials::find_sweep(sweeps, "piston", trials::radians(amplitude)));
    outcome.figures.push_back(
        near(fmt::format("notch of the piston at {:g} deg", amplitude), notch_of(drawn.back()), 6.5, 0.03, "Hz"));
    outcome.figures.push_back({fmt::format("its depth at {:g} deg", amplitude),
                               drawn.back().notch ? drawn.back().notch->depth : kNone, 6.0, 20.0, "dB"});
  }
  outcome.figures.push_back(
      {"notch at 0.4 deg over that at 0.1 deg", notch_of(drawn[2]) / notch_of(drawn[0]), 1.005, 1.05, ""});
  outcome.picture = trials::bode_chart("F5: stepped sines, ambient", drawn);
  outcome.note =
      "The piston is read at one amplitude at a time, at 90 frequencies 0.8 % apart. The amplitude of the "
      "measured sweep is not published. With springs that only stiffen under load, a sweep with large angles "
      "cannot show a lower frequency (6.5 Hz) than a hammer test (6.75 Hz). Friction explains it: the sweep "
      "breaks the bearing loose, and the hammer hardly does.";
  return outcome;
}

Outcome ambient_step(const Bench& bench) {
  const Record command = pitch_steps();
  const Record soft = simulate(bench.ambient(), command);
  const auto of_soft = engine_steps(command, soft);
  const auto of_linear = engine_steps(command, simulate(linear_actuator(bench), command));
  Outcome outcome;
  for (std::size_t k = 0; k < of_soft.size(); k += 4) {
    const std::string name = fmt::format("{:.1f} deg", trials::degrees(of_soft[k].to));
    outcome.figures.push_back(
        {fmt::format("overshoot of the engine at {}", name), 100.0 * of_soft[k].overshoot, 10.0, 40.0, "%"});
    outcome.figures.push_back({fmt::format("over that with linear stiffness at {}", name),
                               of_soft[k].overshoot / of_linear[k].overshoot, 1.005, 2.0, ""});
  }
  outcome.picture = trials::time_chart("F6: steps, ambient", soft, kPitch);
  return outcome;
}

}  // namespace hotfire::findings
