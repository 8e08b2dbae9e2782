#include "tests/model/reference_axis.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace hotfire::test {
namespace {

enum Y {
  kSpool,
  kSpoolRate,
  kPressure,
  kWashout,
  kPiston,
  kPistonRate,
  kAngle,
  kAngleRate,
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

double clamp_to(double x, double limit) { return std::clamp(x, -limit, limit); }
double sign(double x) { return (x > 0.0) - (x < 0.0); }
double beyond(double x, double limit) { return x - clamp_to(x, limit); }

double stribeck(double level, double ratio, double at, double v) {
  return level * (1.0 + (ratio - 1.0) * std::exp(-(v / at) * (v / at)));
}

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

/// Deflection of actuator and load in series under a force F >= 0.
double soft_deflection(const ReferenceAxis& axis, double force) {
  const double k = axis.actuator_stiffness;
  const double low = axis.low_stiffness;
  const double scale = axis.load_scale;
  double own = 0.0;
  if (axis.soft == ReferenceAxis::Soft::compliance) {
    own = force / k + (1.0 / low - 1.0 / k) * scale * -std::expm1(-force / scale);
  } else if (axis.soft == ReferenceAxis::Soft::stiffness) {
    own = scale / k * std::log((k * std::exp(force / scale) - (k - low)) / low);
  } else if (axis.soft == ReferenceAxis::Soft::saturation) {
    own = force / k + (1.0 / low - 1.0 / k) * scale * std::tanh(force / scale);
  } else {
    for (std::size_t i = 0; i < axis.stiffness_table.size(); ++i) {
      const bool last = i + 1 == axis.stiffness_table.size();
      const double from = axis.stiffness_table[i][0];
      const double to = last ? std::numeric_limits<double>::infinity() : axis.stiffness_table[i + 1][0];
      const double here = 1.0 / axis.stiffness_table[i][1];
      const double next = last ? here : 1.0 / axis.stiffness_table[i + 1][1];
      own += std::clamp(force - from, 0.0, to - from) * 0.5 * (here + next);
    }
  }
  return own + force / axis.load_stiffness;
}

double spring_force(const ReferenceAxis& axis, double deflection) {
  const double total = 1.0 / (1.0 / axis.actuator_stiffness + 1.0 / axis.load_stiffness);
  const double played = beyond(deflection, axis.backlash);
  if (axis.soft == ReferenceAxis::Soft::none) {
    return total * played;
  }
  // Bisection: the force lies between none and that of the stiff branch.
  const double wanted = std::abs(played);
  double low = 0.0;
  double high = total * wanted;
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) {
      break;
    }
    (soft_deflection(axis, middle) < wanted ? low : high) = middle;
  }
  return sign(played) * high;
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
  d[kSpool] = y[kSpoolRate];
  d[kSpoolRate] = a.valve_frequency * a.valve_frequency * (valve_command - y[kSpool]) -
                  2.0 * a.valve_damping * a.valve_frequency * y[kSpoolRate];

  const double lapped = beyond(y[kSpool], a.deadband);
  const double opening = lapped * (1.0 + a.asymmetry * sign(lapped));
  const double p = y[kPressure];
  const double turbulent = a.orifice_leak * p * std::sqrt(a.supply / (std::abs(p) + 1e-3 * a.supply));
  const double flow = a.rated_flow * opening * std::sqrt(std::max(0.0, 1.0 - sign(opening) * p / a.supply));
  d[kPressure] =
      4.0 * a.bulk_modulus / a.volume * (flow - a.area * y[kPistonRate] - (a.leakage + a.laminar_leak) * p - turbulent);
  d[kWashout] = a.pressure_corner * (p - y[kWashout]);

  const double v = y[kPistonRate];
  const double w = y[kAngleRate];
  const double beta = y[kAngle];
  const double stroke = a.arm * beta * (1.0 + beta * (a.arm_linear / 2.0 + a.arm_quadratic * beta / 3.0));
  const double arm = a.arm * (1.0 + beta * (a.arm_linear + a.arm_quadratic * beta));
  const double force = spring_force(a, y[kPiston] - stroke - a.mode_shape * y[kMode]);

  d[kPiston] = v;
  const Friction seal = elastic_slip(a.seal, v, y[kSeal]);
  const Friction seal_bristle = lugre(a.seal_bristle, v, y[kSealBristle]);
  d[kPistonRate] = (a.area * p - force - a.piston_damping * v - seal.force - seal_bristle.force) / a.piston_mass;

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

void require(int flag, const char* what) {
  if (flag < 0) {
    throw std::runtime_error(std::string("CVODE: ").append(what).append(" failed with ").append(std::to_string(flag)));
  }
}

/// CVODE's objects, released together.
class Integrator {
 public:
  explicit Integrator(Problem& problem) : problem_(problem) {
    SUNContext_Create(nullptr, &context_);
    state_ = N_VNew_Serial(kCount, context_);
    tolerance_ = N_VNew_Serial(kCount, context_);
    N_VConst(0.0, state_);
    for (int i = 0; i < kCount; ++i) {
      N_VGetArrayPointer(tolerance_)[i] = 1e-11 * kScale[static_cast<std::size_t>(i)];
    }
    matrix_ = SUNDenseMatrix(kCount, kCount, context_);
    solver_ = SUNLinSol_Dense(state_, matrix_, context_);
    memory_ = CVodeCreate(CV_BDF, context_);
    require(CVodeInit(memory_, derivative, 0.0, state_), "CVodeInit");
    require(CVodeSVtolerances(memory_, 1e-10, tolerance_), "CVodeSVtolerances");
    require(CVodeSetUserData(memory_, &problem_), "CVodeSetUserData");
    require(CVodeSetLinearSolver(memory_, solver_, matrix_), "CVodeSetLinearSolver");
    require(CVodeSetMaxNumSteps(memory_, 1'000'000), "CVodeSetMaxNumSteps");
  }
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;
  ~Integrator() {
    CVodeFree(&memory_);
    SUNLinSolFree(solver_);
    SUNMatDestroy(matrix_);
    N_VDestroy(tolerance_);
    N_VDestroy(state_);
    SUNContext_Free(&context_);
  }

  double* state() { return N_VGetArrayPointer(state_); }

  /// Goes on to `end` with the command of the problem, started afresh.
  void advance(double end) {
    require(CVodeReInit(memory_, time_, state_), "CVodeReInit");
    require(CVodeSetStopTime(memory_, end), "CVodeSetStopTime");
    int restarts = 0;
    while (time_ < end) {
      const int flag = CVode(memory_, end, state_, &time_, CV_NORMAL);
      // A corner can defeat the error test; from the corner itself it goes on.
      if ((flag == CV_ERR_FAILURE || flag == CV_CONV_FAILURE) && ++restarts <= 20) {
        require(CVodeReInit(memory_, time_, state_), "CVodeReInit");
        require(CVodeSetStopTime(memory_, end), "CVodeSetStopTime");
      } else {
        require(flag, "CVode");
      }
    }
  }

  double time() const { return time_; }

 private:
  Problem& problem_;
  SUNContext context_ = nullptr;
  N_Vector state_ = nullptr;
  N_Vector tolerance_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  void* memory_ = nullptr;
  double time_ = 0.0;
};

/// Changes the command at the present time. A jump moves the torque motor at once, and with it the play.
void set_command(const ReferenceAxis& axis, Problem& problem, Integrator& integrator, double command) {
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
  Integrator integrator(problem);
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
