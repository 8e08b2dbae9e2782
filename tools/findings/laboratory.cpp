// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "tools/findings/parameters.hpp"
#include "tools/findings/rows.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/profiles.hpp"
#include "tools/trials/stiffness.hpp"

namespace hotfire::findings {

Outcome piston_zeros(const Bench& bench) {
  const ModelFile linear = without_effects(bench.lab);
  const double zero = trials::asymptote(trials::load_spring_of(linear));
  // Small, so that valve and flow law stay linear; the analysis is that of any amplitude.
  const auto sweeps =
      swept(linear, trials::stepped_sines({{trials::radians(0.02), trials::spaced(4.0, 13.0, 60)}}), 4.0, 13.0);
  Outcome outcome;
  outcome.figures.push_back(near("notch of the piston",
                                 notch_of(*trials::find_sweep(sweeps, "piston", trials::radians(0.02))), zero, 0.005, "Hz"));
  const trials::ChannelSweep* engine = trials::find_sweep(sweeps, "engine", trials::radians(0.02));
  const auto of_engine = analysis::find_notch(engine->response, 0.9 * zero, 1.1 * zero);
  outcome.figures.push_back({"notches of the engine within 10 % of it", of_engine ? 1.0 : 0.0, 0.0, 0.0, ""});
  outcome.picture = trials::bode_chart("F1: the notch is in the piston and not in the engine", sweeps);
  return outcome;
}

Outcome laboratory_notch(const Bench& bench) {
  const trials::LoadSpring spring = trials::load_spring_of(bench.lab);
  std::vector<trials::SineBand> bands;
  for (const double amplitude : {0.02, 0.05, 0.1, 0.2, 0.4}) {
    bands.push_back({trials::radians(amplitude), trials::spaced(6.0, 13.0, 60)});
  }
  const auto stiffnesses = trials::sine_stiffnesses(swept(bench.lab, trials::stepped_sines(bands), 6.0, 13.0), spring);
  Outcome outcome;
  double first = kNone;
  double before = 0.0;
  double rises = 1.0;
  for (const trials::SineStiffness& own : stiffnesses) {
    const double notch = own.test ? own.test->frequency : kNone;
    outcome.figures.push_back(near(fmt::format("notch at {:.3g} deg, against eq. 7", trials::degrees(own.amplitude)), notch,
                                   own.expected.frequency, 0.05, "Hz"));
    rises = notch > before ? rises : 0.0;
    first = before > 0.0 ? first : notch;
    before = notch;
  }
  outcome.figures.push_back({"rises with every amplitude (1: yes)", rises, 1.0, 1.0, ""});
  outcome.figures.push_back({"notch at the largest over that at the smallest", before / first, 1.08, 1.25, ""});
  outcome.figures.push_back(
      near("notch at the largest, against the linear asymptote", before, trials::asymptote(spring), 0.02, "Hz"));
  outcome.picture = trials::stiffness_chart("F2: load resonance and actuator stiffness over amplitude", stiffnesses, spring);
  outcome.note = "The peak force of eq. 5 is computed from the commanded amplitude, as in the paper.";
  return outcome;
}

}  // namespace hotfire::findings
