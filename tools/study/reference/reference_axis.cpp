// SPDX-License-Identifier: Apache-2.0
#include "tools/study/reference/reference_axis.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "tools/study/reference/cvode_integrator.hpp"
#include "tools/study/reference/reference_equations.hpp"

namespace hotfire::study {
namespace {

/// The axes that are integrated together, and where the states of each begin among all.
struct Problems {
  std::vector<ReferenceProblem> axes;
  std::vector<std::size_t> first;
  long evaluations_left = std::numeric_limits<long>::max();

  std::size_t size() const { return first.back() + axes.back().states.size(); }

  StateVector unpacked(std::size_t axis, const double* values) const {
    StateVector y{};
    for (std::size_t i = 0; i < axes[axis].states.size(); ++i) {
      y[axes[axis].states[i]] = values[first[axis] + i];
    }
    return y;
  }
};

int right_hand_side(double t, N_Vector state, N_Vector result, void* user) {
  Problems& problems = *static_cast<Problems*>(user);
  if (--problems.evaluations_left < 0) {
    return -1;
  }
  const double* values = N_VGetArrayPointer(state);
  double* rates = N_VGetArrayPointer(result);
  if (problems.axes.size() == 2) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const StateVector other = problems.unpacked(1 - axis, values);
      problems.axes[axis].other_angle = other[kAngle];
      problems.axes[axis].other_rate = other[kAngleRate];
    }
  }
  for (std::size_t axis = 0; axis < problems.axes.size(); ++axis) {
    const ReferenceProblem& problem = problems.axes[axis];
    const StateVector d = derivative(problem, t, problems.unpacked(axis, values));
    for (std::size_t i = 0; i < problem.states.size(); ++i) {
      rates[problems.first[axis] + i] = d[problem.states[i]];
    }
  }
  return 0;
}

/// The states of the axes within CVODE's.
class Integrator {
 public:
  Integrator(Problems& problems, double relative)
      : problems_(problems), cvode_(right_hand_side, &problems, scales_of(problems), relative) {}

  StateVector state(std::size_t axis) { return problems_.unpacked(axis, cvode_.state()); }

  /// Sets one of the states that an axis has.
  void set(std::size_t axis, ReferenceState state, double value) {
    const std::vector<ReferenceState>& states = problems_.axes[axis].states;
    const auto at = std::find(states.begin(), states.end(), state) - states.begin();
    cvode_.state()[problems_.first[axis] + static_cast<std::size_t>(at)] = value;
  }

  /// Goes on to `end` with the commands of the problems, started afresh.
  void advance(double end) { cvode_.advance(end); }

  double time() const { return cvode_.time(); }
  long evaluations() const { return cvode_.evaluations(); }

 private:
  static std::vector<double> scales_of(const Problems& problems) {
    std::vector<double> scales;
    scales.reserve(problems.size());
    for (const ReferenceProblem& problem : problems.axes) {
      for (const ReferenceState state : problem.states) {
        scales.push_back(kStateScale[state]);
      }
    }
    return scales;
  }

  Problems& problems_;
  CvodeIntegrator cvode_;
};

/// Changes the command of an axis at the present time. A jump moves the torque motor at once as far as it is not saturated,
/// and with it the play.
void set_command(Problems& problems, std::size_t which, Integrator& integrator, double command) {
  ReferenceProblem& problem = problems.axes[which];
  const ReferenceAxis& axis = problem.axis;
  problem.command_start = std::isinf(axis.rate_limit) ? command : command_at(problem, integrator.time());
  problem.start_time = integrator.time();
  if (axis.play > 0.0) {
    const StateVector y = integrator.state(which);
    const auto asked = [&](double angle) {
      return clamp_to(torque_motor(axis, angle, std::max(0.0, integrator.time() - problem.first_row), y), 1.0);
    };
    integrator.set(which, kPlay, clamp_to(y[kPlay] + asked(command) - asked(problem.command), axis.play));
  }
  problem.command = command;
}

/// A change of an axis's command: the delayed command has its edges after the samples.
struct Edge {
  double offset = 0.0;
  std::size_t axis = 0;
  double command = 0.0;
};

/// The changes of the axes' commands in row `i`, of what was sent until then, in order. The delayed command has its edges
/// `offset` after the samples, and is `late` samples behind.
std::vector<Edge> edges_of_row(const std::vector<const ReferenceAxis*>& axes, const std::vector<std::vector<double>>& sent,
                               std::ptrdiff_t i, double sample) {
  std::vector<Edge> edges;
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const auto earlier = [&](std::ptrdiff_t k) { return k < 0 ? 0.0 : sent[axis][static_cast<std::size_t>(k)]; };
    const double delay = axes[axis]->delay + axes[axis]->unlisted.dead_time * std::abs(earlier(i));
    const auto late = static_cast<std::ptrdiff_t>(delay / sample);
    const double offset = delay - static_cast<double>(late) * sample;
    if (offset > 0.0) {
      edges.push_back({0.0, axis, earlier(i - late - 1)});
    }
    edges.push_back({std::max(0.0, offset), axis, earlier(i - late)});
  }
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.offset < b.offset; });
  return edges;
}

/// Any number of axes together, each under its commands, or under what a controller makes of them.
std::vector<ReferenceRows> integrate(const std::vector<const ReferenceAxis*>& axes,
                                     const std::vector<const std::vector<double>*>& commands, double sample, double settling,
                                     double tolerance, long* evaluations, const Controller& controller = {},
                                     QuantityRows* quantities = nullptr) {
  Problems problems;
  for (const ReferenceAxis* axis : axes) {
    if (axis->play > 0.0 && !std::isinf(axis->rate_limit)) {
      throw std::invalid_argument(
          "the reference axis has no play behind a rate limit: its play follows jumps of the command");
    }
    problems.first.push_back(problems.axes.empty() ? 0 : problems.size());
    problems.axes.push_back({*axis, states_of(*axis)});
    problems.axes.back().first_row = settling;
  }
  if (std::any_of(axes.begin(), axes.end(), [](const ReferenceAxis* axis) { return axis->wild != nullptr; })) {
    problems.evaluations_left = kMostEvaluations * std::ssize(*commands.front());
  }
  Integrator integrator(problems, tolerance);
  if (settling > 0.0) {
    integrator.advance(settling);
  }
  std::vector<ReferenceRows> rows(axes.size());
  std::vector<std::vector<double>> sent(axes.size());
  for (std::ptrdiff_t i = 0; i < std::ssize(*commands.front()); ++i) {
    const double start = settling + static_cast<double>(i) * sample;
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      const double asked = (*commands[axis])[static_cast<std::size_t>(i)];
      const std::array<double, 3> last = rows[axis].empty() ? std::array<double, 3>{} : rows[axis].back();
      sent[axis].push_back(controller ? controller(asked, last) : asked);
    }
    const std::vector<Edge> edges = edges_of_row(axes, sent, i, sample);
    auto edge = edges.cbegin();
    for (; edge != edges.cend() && edge->offset == 0.0; ++edge) {
      set_command(problems, edge->axis, integrator, edge->command);
    }
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      begin_row(problems.axes[axis], integrator.time(), integrator.state(axis));
    }
    for (; edge != edges.cend(); ++edge) {
      integrator.advance(start + edge->offset);
      set_command(problems, edge->axis, integrator, edge->command);
    }
    integrator.advance(settling + static_cast<double>(i + 1) * sample);
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      rows[axis].push_back(readings(problems.axes[axis], integrator.time(), integrator.state(axis)));
    }
    if (quantities != nullptr) {
      quantities->push_back(quantities_at(problems.axes.front(), integrator.time(), integrator.state(0)));
    }
  }
  if (evaluations != nullptr) {
    *evaluations += integrator.evaluations();
  }
  return rows;
}

}  // namespace

ReferenceRows integrate_reference(const ReferenceAxis& axis, const std::vector<double>& commands, double sample,
                                  double settling, double tolerance, long* evaluations, const Controller& controller,
                                  QuantityRows* quantities) {
  return integrate({&axis}, {&commands}, sample, settling, tolerance, evaluations, controller, quantities).front();
}

std::array<ReferenceRows, 2> integrate_reference_pair(const std::array<ReferenceAxis, 2>& axes,
                                                      const std::array<std::vector<double>, 2>& commands, double sample,
                                                      double settling, double tolerance, long* evaluations) {
  auto rows = integrate({&axes[0], &axes[1]}, {&commands[0], &commands[1]}, sample, settling, tolerance, evaluations);
  return {std::move(rows[0]), std::move(rows[1])};
}

}  // namespace hotfire::study
