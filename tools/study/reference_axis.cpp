#include "tools/study/reference_axis.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "tools/study/reference_equations.hpp"

namespace hotfire::study {
namespace {

void require(int flag, const char* what) {
  if (flag < 0) {
    throw std::runtime_error(std::string("CVODE: ").append(what).append(" failed with ").append(std::to_string(flag)));
  }
}

StateVector unpacked(const std::vector<ReferenceState>& states, N_Vector packed) {
  StateVector y{};
  const double* values = N_VGetArrayPointer(packed);
  for (std::size_t i = 0; i < states.size(); ++i) {
    y[states[i]] = values[i];
  }
  return y;
}

int right_hand_side(double t, N_Vector state, N_Vector result, void* user) {
  const ReferenceProblem& problem = *static_cast<const ReferenceProblem*>(user);
  const StateVector d = derivative(problem, t, unpacked(problem.states, state));
  double* values = N_VGetArrayPointer(result);
  for (std::size_t i = 0; i < problem.states.size(); ++i) {
    values[i] = d[problem.states[i]];
  }
  return 0;
}

/// CVODE's objects, released together.
class Integrator {
 public:
  Integrator(ReferenceProblem& problem, double relative) : problem_(problem) {
    const auto size = static_cast<sunindextype>(problem.states.size());
    SUNContext_Create(nullptr, &context_);
    state_ = N_VNew_Serial(size, context_);
    tolerance_ = N_VNew_Serial(size, context_);
    N_VConst(0.0, state_);
    for (std::size_t i = 0; i < problem.states.size(); ++i) {
      N_VGetArrayPointer(tolerance_)[i] = 0.1 * relative * kStateScale[problem.states[i]];
    }
    matrix_ = SUNDenseMatrix(size, size, context_);
    solver_ = SUNLinSol_Dense(state_, matrix_, context_);
    memory_ = CVodeCreate(CV_BDF, context_);
    require(CVodeInit(memory_, right_hand_side, 0.0, state_), "CVodeInit");
    require(CVodeSVtolerances(memory_, relative, tolerance_), "CVodeSVtolerances");
    require(CVodeSetUserData(memory_, &problem_), "CVodeSetUserData");
    require(CVodeSetLinearSolver(memory_, solver_, matrix_), "CVodeSetLinearSolver");
    require(CVodeSetMaxNumSteps(memory_, 1'000'000), "CVodeSetMaxNumSteps");
    // A failure is answered in advance(), and told by an exception if that is no help.
    require(CVodeSetErrFile(memory_, nullptr), "CVodeSetErrFile");
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

  StateVector state() const { return unpacked(problem_.states, state_); }

  /// Sets one of the states the axis has.
  void set(ReferenceState state, double value) {
    const auto at = std::find(problem_.states.begin(), problem_.states.end(), state);
    N_VGetArrayPointer(state_)[at - problem_.states.begin()] = value;
  }

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
  ReferenceProblem& problem_;
  SUNContext context_ = nullptr;
  N_Vector state_ = nullptr;
  N_Vector tolerance_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  void* memory_ = nullptr;
  double time_ = 0.0;
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
                                  double settling, double tolerance) {
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
  return rows;
}

}  // namespace hotfire::study
