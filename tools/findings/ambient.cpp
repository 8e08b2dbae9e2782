#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/effects/soft_stiffness.hpp"
#include "tools/analysis/free_decay.hpp"
#include "tools/analysis/step_response.hpp"
#include "tools/findings/one_axis.hpp"
#include "tools/findings/rows.hpp"
#include "tools/simulate/simulate.hpp"
#include "tools/trials/disturbed.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/profiles.hpp"

namespace hotfire::findings {

namespace {

ModelFile without_softness(ModelFile model) {
  set_active<model::SoftStiffness>(axis_of(model), false);
  return model;
}

}  // namespace

Outcome locked_pendulum(const Sets& sets) {
  const trials::Hammer blow{40.0, 1.0};
  const Record soft = trials::hammer(sets.ambient, blow);
  const Record linear = trials::hammer(without_softness(sets.ambient), blow);
  const auto frequency = [&](const Record& record) {
    const auto decay = analysis::free_decay(record.find("engine")->values, record.period, blow.seconds);
    return decay ? decay->frequency : kNone;
  };
  Outcome outcome;
  outcome.figures.push_back({"pendulum with linear stiffness", frequency(linear), 7.5, 8.0, "Hz"});
  outcome.figures.push_back(near("pendulum with soft stiffness", frequency(soft), 6.75, 0.01, "Hz"));
  outcome.picture = trials::time_chart("F3: swing of the engine after a blow, actuator locked", soft, "");
  outcome.note =
      "A blow of 40 N m s; the frequency of the first second. A harder blow rings higher: the actuator is stiffer "
      "under load.";
  return outcome;
}

Outcome quiescent_peaks(const Sets& sets) {
  Outcome outcome;
  std::vector<std::string> labels;
  std::vector<analysis::Spectrum> spectra;
  for (const double density : {1.0, 1e3, 1e5, 1e6}) {
    trials::Quiescence ambient;
    ambient.torque_density = density;
    const Record record = trials::quiescent(sets.ambient, ambient);
    spectra.push_back(analysis::welch_spectrum(record.find("piston")->values, record.period, {16000}));
    labels.push_back(fmt::format("{:g} (N m)^2/Hz", density));
    const auto peak = analysis::find_peak(spectra.back(), 3.0, 12.0);
    outcome.figures.push_back(
        {fmt::format("largest peak under {}", labels.back()), peak ? peak->frequency : kNone, 5.9, 8.2, "Hz"});
  }
  outcome.picture = trials::spectrum_chart("F4: quiescent piston", labels, spectra, 3.0, 12.0);
  outcome.note = "The excitation of the measured records is not published: random torque on the engine of four strengths.";
  return outcome;
}

Outcome ambient_sweep(const Sets& sets) {
  const GreenRun run = green_run(sets.ambient);
  Outcome outcome;
  outcome.figures.push_back(
      near("load resonance of the engine", run.engine.peak ? run.engine.peak->frequency : kNone, 6.5, 0.05, "Hz"));
  outcome.picture = trials::bode_chart("F5: Green Run profile, ambient", {run.piston, run.engine});
  outcome.note = fmt::format(
      "The resonance is the engine's, on oil and springs; the piston's notch, which the oil does not move, is at {:.2f} Hz. "
      "The "
      "profile's gap from 6.25 to 7 Hz, where the amplitude changes, lies on the resonance.",
      run.piston.notch ? run.piston.notch->frequency : kNone);
  return outcome;
}

Outcome ambient_step(const Sets& sets) {
  const std::vector<double> amplitudes{trials::radians(0.6), trials::radians(0.4), trials::radians(0.2)};
  const Record command = trials::command_record(trials::steps(amplitudes, 2.0));
  const Record soft = simulate(sets.ambient, command);
  const Record linear = simulate(without_softness(sets.ambient), command);
  const auto steps = [&](const Record& record) {
    return analysis::step_responses(command.find("command")->values, record.find("engine")->values, record.period, 1.0);
  };
  const auto of_soft = steps(soft);
  const auto of_linear = steps(linear);
  Outcome outcome;
  for (std::size_t k = 0; k < of_soft.size(); k += 4) {
    const std::string name = fmt::format("{:.1f} deg", trials::degrees(of_soft[k].to));
    outcome.figures.push_back(
        {fmt::format("overshoot of the engine at {}", name), 100.0 * of_soft[k].overshoot, 10.0, 40.0, "%"});
    outcome.figures.push_back({fmt::format("over that with linear stiffness at {}", name),
                               of_soft[k].overshoot / of_linear[k].overshoot, 1.005, 2.0, ""});
  }
  outcome.picture = trials::time_chart("F6: steps, ambient", soft, "");
  return outcome;
}

}  // namespace hotfire::findings
