#include "tools/study/reference_axis.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/study/cvode_integrator.hpp"
#include "tools/study/reference_equations.hpp"

namespace hotfire::study {
namespace {

StateVector unpacked(const std::vector<ReferenceState>& states, const double* values) {
  StateVector y{};
  for (std::size_t i = 0; i < states.size(); ++i) {
    y[states[i]] = values[i];
  }
  return y;
}

int right_hand_side(double t, N_Vector state, N_Vector result, void* user) {
  const ReferenceProblem& problem = *static_cast<const ReferenceProblem*>(user);
  const StateVector d = derivative(problem, t, unpacked(problem.states, N_VGetArrayPointer(state)));
  double* values = N_VGetArrayPointer(result);
  for (std::size_t i = 0; i < problem.states.size(); ++i) {
    values[i] = d[problem.states[i]];
  }
  return 0;
}

/// The axis' states within CVODE's.
class Integrator {
 public:
  Integrator(ReferenceProblem& problem, double relative)
      : problem_(problem), cvode_(right_hand_side, &problem, scales_of(problem.states), relative) {}

  StateVector state() { return unpacked(problem_.states, cvode_.state()); }

  /// Sets one of the states the axis has.
  void set(ReferenceState state, double value) {
    const auto at = std::find(problem_.states.begin(), problem_.states.end(), state);
    cvode_.state()[at - problem_.states.begin()] = value;
  }

  /// Goes on to `end` with the command of the problem, started afresh.
  void advance(double end) { cvode_.advance(end); }

  double time() const { return cvode_.time(); }
  long evaluations() const { return cvode_.evaluations(); }

 private:
  static std::vector<double> scales_of(const std::vector<ReferenceState>& states) {
    std::vector<double> scales;
    scales.reserve(states.size());
    for (const ReferenceState state : states) {
      scales.push_back(kStateScale[state]);
    }
    return scales;
  }

  ReferenceProblem& problem_;
  CvodeIntegrator cvode_;
};

/// Changes the command at the present time. A jump moves the torque motor at once, and with it the play.
void set_command(ReferenceProblem& problem, Integrator& integrator, double command) {
  const ReferenceAxis& axis = problem.axis;
  problem.command_start = std::isinf(axis.rate_limit) ? command : command_at(problem, integrator.time());
  problem.start_time = integrator.time();
  if (axis.play > 0.0) {
    const double moved = integrator.state()[kPlay] + axis.position_gain * axis.arm * (command - problem.command);
    integrator.set(kPlay, std::clamp(moved, -axis.play, axis.play));
  }
  problem.command = command;
}

}  // namespace

ReferenceRows integrate_reference(const ReferenceAxis& axis, const std::vector<double>& commands, double sample,
                                  double settling, double tolerance, long* evaluations) {
  if (axis.play > 0.0 && !std::isinf(axis.rate_limit)) {
    throw std::invalid_argument("the reference axis has no play behind a rate limit: its play follows jumps of the command");
  }
  ReferenceProblem problem{axis, states_of(axis)};
  problem.first_row = settling;
  Integrator integrator(problem, tolerance);
  if (settling > 0.0) {
    integrator.advance(settling);
  }
  const auto earlier = [&](std::ptrdiff_t i) { return i < 0 ? 0.0 : commands[static_cast<std::size_t>(i)]; };
  ReferenceRows rows;
  for (std::ptrdiff_t i = 0; i < std::ssize(commands); ++i) {
    const double start = settling + static_cast<double>(i) * sample;
    // The delayed command has its edges `offset` after the samples, and is `late` samples behind.
    const double delay = axis.delay + axis.unlisted.dead_time * std::abs(earlier(i));
    const auto late = static_cast<std::ptrdiff_t>(delay / sample);
    const double offset = delay - static_cast<double>(late) * sample;
    if (offset > 0.0) {
      set_command(problem, integrator, earlier(i - late - 1));
      integrator.advance(start + offset);
    }
    set_command(problem, integrator, earlier(i - late));
    integrator.advance(settling + static_cast<double>(i + 1) * sample);
    rows.push_back(readings(axis, integrator.state()));
  }
  if (evaluations != nullptr) {
    *evaluations += integrator.evaluations();
  }
  return rows;
}

}  // namespace hotfire::study
