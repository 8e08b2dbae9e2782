#include "tests/model/reference_axis.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/model/cvode_integrator.hpp"
#include "tests/model/reference_parts.hpp"

namespace hotfire::test {
namespace {

enum Y {
  kSpool = kReferenceSpool,
  kSpoolRate = kReferenceSpoolRate,
  kPressure = kReferencePressure,
  kWashout = kReferenceWashout,
  kPiston = kReferencePiston,
  kPistonRate = kReferencePistonRate,
  kAngle = kReferenceAngle,
  kAngleRate = kReferenceAngleRate,
  kPlay,
  kSeal,
  kCoulomb,
  kBristle,
  kSealBristle,
  kMode,
  kModeRate,
  kCount
};

/// What a state is measured in; tolerances are a tiny part of it.
constexpr std::array<double, kCount> kScale{0.01, 1.0,  1e6,  1e6,  0.01, 0.1, 0.01, 0.1,
                                            0.01, 1e-5, 1e-5, 1e-4, 1e-5, 0.1, 1.0};

/// Rate at which the play between valve command and spool gives way beyond its width [1/s].
constexpr double kPlayGivesWay = 1e7;

struct Friction {
  double force = 0.0;
  double rate = 0.0;  ///< of the bristle
};

Friction lugre(const ReferenceAxis::Bristle& law, double velocity, double z) {
  if (law.level == 0.0) {
    return {};
  }
  const double level = stribeck(law.level, law.static_ratio, law.stribeck, velocity);
  const double rate = velocity - law.stiffness * std::abs(velocity) * z / level;
  const double fading = std::exp(-(velocity / law.damping_dies_at) * (velocity / law.damping_dies_at));
  return {law.stiffness * z + law.damping * fading * rate, rate};
}

Friction elastic_slip(const ReferenceAxis::Slip& law, double velocity, double stretch) {
  if (law.stiffness == 0.0) {
    return {};
  }
  const double level = stribeck(law.level, law.static_ratio, law.stribeck, velocity);
  return {law.stiffness * stretch, velocity - law.gives_way * beyond(stretch, level / law.stiffness)};
}

/// What the right-hand side needs besides time and state.
struct Problem {
  const ReferenceAxis* axis = nullptr;
  double command = 0.0;        ///< what is asked for in this interval [rad]
  double command_start = 0.0;  ///< where a limited command stands at its beginning
  double start_time = 0.0;
};

double command_at(const Problem& problem, double t) {
  const double reach = problem.axis->rate_limit * (t - problem.start_time);
  return t > problem.start_time ? problem.command_start + clamp_to(problem.command - problem.command_start, reach)
                                : problem.command_start;
}

int derivative(double t, N_Vector state, N_Vector result, void* user) {
  const Problem& problem = *static_cast<Problem*>(user);
  const ReferenceAxis& a = *problem.axis;
  const double* y = N_VGetArrayPointer(state);
  double* d = N_VGetArrayPointer(result);

  // A limit of infinity makes the command jump at the start of the interval.
  const double angle = std::isinf(a.rate_limit) ? problem.command : command_at(problem, t);
  const double torque_motor =
      a.position_gain * (a.arm * angle - y[kPiston]) - a.pressure_gain * (y[kPressure] - y[kWashout]);
  const double valve_command = clamp_to(torque_motor, 1.0) - (a.play > 0.0 ? clamp_to(y[kPlay], a.play) : 0.0);
  reference_hydraulics(a, valve_command, y, d);

  const double v = y[kPistonRate];
  const double w = y[kAngleRate];
  const double beta = y[kAngle];
  const double stroke = a.arm * beta * (1.0 + beta * (a.arm_linear / 2.0 + a.arm_quadratic * beta / 3.0));
  const double arm = a.arm * (1.0 + beta * (a.arm_linear + a.arm_quadratic * beta));
  const double force = reference_spring_force(a, y[kPiston] - stroke - a.mode_shape * y[kMode]);

  d[kPiston] = v;
  const Friction seal = elastic_slip(a.seal, v, y[kSeal]);
  const Friction seal_bristle = lugre(a.seal_bristle, v, y[kSealBristle]);
  d[kPistonRate] = (a.area * y[kPressure] - force - a.piston_damping * v - seal.force - seal_bristle.force) / a.piston_mass;

  const Friction coulomb = elastic_slip(a.coulomb, w, y[kCoulomb]);
  const Friction bristle = lugre(a.bristle, w, y[kBristle]);
  d[kAngle] = w;
  d[kAngleRate] = (arm * force - a.damping * w - a.duct_stiffness * beta - a.duct_cubic * beta * beta * beta -
                   a.torque_offset - coulomb.force - bristle.force) /
                  a.inertia;

  const double torque_motor_rate = -a.position_gain * v - a.pressure_gain * (d[kPressure] - d[kWashout]);
  d[kPlay] = (std::abs(torque_motor) < 1.0 ? torque_motor_rate : 0.0) - kPlayGivesWay * beyond(y[kPlay], a.play);
  d[kSeal] = seal.rate;
  d[kSealBristle] = seal_bristle.rate;
  d[kCoulomb] = coulomb.rate;
  d[kBristle] = bristle.rate;
  const double natural = 2.0 * std::numbers::pi * a.mode_frequency;
  d[kMode] = y[kModeRate];
  d[kModeRate] = a.mode_shape * force - 2.0 * a.mode_damping * natural * y[kModeRate] - natural * natural * y[kMode];
  return 0;
}

/// Changes the command at the present time. A jump moves the torque motor at once, and with it the play.
void set_command(const ReferenceAxis& axis, Problem& problem, CvodeIntegrator& integrator, double command) {
  problem.command_start = std::isinf(axis.rate_limit) ? command : command_at(problem, integrator.time());
  problem.start_time = integrator.time();
  if (axis.play > 0.0) {
    double& play = integrator.state()[kPlay];
    play = clamp_to(play + axis.position_gain * axis.arm * (command - problem.command), axis.play);
  }
  problem.command = command;
}

}  // namespace

std::vector<std::array<double, 3>> integrate_reference(const ReferenceAxis& axis, const std::vector<double>& commands,
                                                       double sample, double settling) {
  Problem problem{&axis};
  CvodeIntegrator integrator(derivative, &problem, {kScale.begin(), kScale.end()});
  if (settling > 0.0) {
    integrator.advance(settling);
  }
  // The delayed command has its edges `offset` after the samples, and is `late` samples behind.
  const auto late = static_cast<std::ptrdiff_t>(axis.delay / sample);
  const double offset = axis.delay - static_cast<double>(late) * sample;
  const auto delayed = [&](std::ptrdiff_t i) { return i < 0 ? 0.0 : commands[static_cast<std::size_t>(i)]; };
  std::vector<std::array<double, 3>> rows;
  for (std::ptrdiff_t i = 0; i < std::ssize(commands); ++i) {
    const double start = settling + static_cast<double>(i) * sample;
    if (offset > 0.0) {
      set_command(axis, problem, integrator, delayed(i - late - 1));
      integrator.advance(start + offset);
    }
    set_command(axis, problem, integrator, delayed(i - late));
    integrator.advance(settling + static_cast<double>(i + 1) * sample);
    const double* y = integrator.state();
    rows.push_back({y[kPiston], y[kAngle], y[kPressure]});
  }
  return rows;
}

}  // namespace hotfire::test
