#include <fmt/format.h>

#include <cmath>

#include "model/effects/soft_stiffness.hpp"
#include "tools/analysis/equivalent_stiffness.hpp"
#include "tools/files/error.hpp"
#include "tools/findings/one_axis.hpp"
#include "tools/findings/rows.hpp"
#include "tools/trials/pictures.hpp"
#include "tools/trials/profiles.hpp"

namespace hotfire::findings {

namespace {

/// Force over deflection of the actuator alone: the model's own law, behind a structure that does not give.
analysis::SpringCurve actuator_curve(SimplexParameters& axis) {
  using Soft = model::SoftStiffness;
  const Soft::Params<double> law = effect_of<Soft>(axis);
  const double stiffness = axis.actuator.stiffness;
  return [law, stiffness](double deflection) {
    constexpr double kRigid = 1e30;
    const model::Spring<double> spring{deflection, 0.0, 1.0, 1.0, stiffness, stiffness, kRigid, 1e-3};
    Soft::State<double> state;
    // The law's search starts at its last force: a second call starts at the root.
    Soft::step(law, state, spring);
    return Soft::step(law, state, spring).deflection * stiffness;
  };
}

/// A notch that a row stands or falls with.
double notch_of(const trials::ChannelSweep* sweep) {
  return sweep != nullptr && sweep->notch ? sweep->notch->frequency : kNone;
}

}  // namespace

Outcome piston_zeros(const Sets& sets) {
  ModelFile linear = without_effects(sets.ambient);
  const double zero = load_frequency(axis_of(linear));
  // Small, so that valve and flow law stay linear; the analysis is that of any amplitude.
  const auto sweeps =
      swept(linear, trials::stepped_sines({{trials::radians(0.02), trials::spaced(4.0, 13.0, 60)}}), 4.0, 13.0);
  Outcome outcome;
  outcome.figures.push_back(
      near("notch of the piston", notch_of(trials::find_sweep(sweeps, "piston", trials::radians(0.02))), zero, 0.005, "Hz"));
  const trials::ChannelSweep* engine = trials::find_sweep(sweeps, "engine", trials::radians(0.02));
  outcome.figures.push_back({"notches of the engine", engine->notch ? 1.0 : 0.0, 0.0, 0.0, ""});
  outcome.picture = trials::bode_chart("F1: the notch is in the piston and not in the engine", sweeps);
  return outcome;
}

Outcome laboratory_notch(const Sets& sets) {
  ModelFile lab = sets.lab;
  SimplexParameters& axis = axis_of(lab);
  const analysis::SpringCurve curve = actuator_curve(axis);
  const analysis::LoadResonance load{axis.engine.inertia, axis.actuator.moment_arm, axis.structure.stiffness,
                                     axis.engine.duct_stiffness, axis.actuator.stiffness};
  Outcome outcome;
  analysis::Curve simulated{"simulated", {}, {}, true};
  analysis::Curve worked_out{"eq. 7", {}, {}};
  double before = load.duct_stiffness;
  double rises = 1.0;
  for (const double amplitude : {0.02, 0.05, 0.1, 0.2, 0.4}) {
    const double angle = trials::radians(amplitude);
    const auto sweeps = swept(lab, trials::stepped_sines({{angle, trials::spaced(6.0, 13.0, 60)}}), 6.0, 13.0);
    const double notch = notch_of(trials::find_sweep(sweeps, "piston", angle));
    const double expected = analysis::load_resonance(load, curve, angle);
    outcome.figures.push_back(near(fmt::format("notch at {} deg, against eq. 7", amplitude), notch, expected, 0.05, "Hz"));
    rises = notch > before ? rises : 0.0;
    before = notch;
    simulated.x.push_back(amplitude);
    simulated.y.push_back(notch);
    worked_out.x.push_back(amplitude);
    worked_out.y.push_back(expected);
  }
  outcome.figures.push_back({"rises with every amplitude (1: yes)", rises, 1.0, 1.0, ""});
  outcome.figures.push_back(
      near("notch at the largest, against the linear asymptote", before, load_frequency(axis), 0.02, "Hz"));
  const double asymptote = load_frequency(axis);
  outcome.picture = {"F2: load resonance over amplitude",
                     "amplitude of the command [deg]",
                     true,
                     {{"frequency [Hz]", {simulated, worked_out, {"asymptote", {0.02, 0.4}, {asymptote, asymptote}}}}}};
  outcome.note = "The peak force of eq. 5 is worked out with the commanded amplitude, as in the paper.";
  return outcome;
}

}  // namespace hotfire::findings
