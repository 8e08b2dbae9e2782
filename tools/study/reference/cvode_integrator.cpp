// SPDX-License-Identifier: Apache-2.0
#include "tools/study/reference/cvode_integrator.hpp"

#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <stdexcept>
#include <string>

namespace hotfire::study {
namespace {

void require(int flag, const char* what) {
  if (flag < 0) {
    throw std::runtime_error(std::string("CVODE: ").append(what).append(" failed with ").append(std::to_string(flag)));
  }
}

}  // namespace

CvodeIntegrator::CvodeIntegrator(Derivative derivative, void* user, const std::vector<double>& scale, double tolerance) {
  const auto count = static_cast<sunindextype>(scale.size());
  SUNContext_Create(nullptr, &context_);
  state_ = N_VNew_Serial(count, context_);
  tolerance_ = N_VNew_Serial(count, context_);
  N_VConst(0.0, state_);
  for (std::size_t i = 0; i < scale.size(); ++i) {
    N_VGetArrayPointer(tolerance_)[i] = 0.1 * tolerance * scale[i];
  }
  matrix_ = SUNDenseMatrix(count, count, context_);
  solver_ = SUNLinSol_Dense(state_, matrix_, context_);
  memory_ = CVodeCreate(CV_BDF, context_);
  require(CVodeInit(memory_, derivative, 0.0, state_), "CVodeInit");
  require(CVodeSVtolerances(memory_, tolerance, tolerance_), "CVodeSVtolerances");
  require(CVodeSetUserData(memory_, user), "CVodeSetUserData");
  require(CVodeSetLinearSolver(memory_, solver_, matrix_), "CVodeSetLinearSolver");
  require(CVodeSetMaxNumSteps(memory_, 100'000), "CVodeSetMaxNumSteps");
  // advance() handles a failure, and throws if it cannot.
  require(CVodeSetErrFile(memory_, nullptr), "CVodeSetErrFile");
}

CvodeIntegrator::~CvodeIntegrator() {
  CVodeFree(&memory_);
  SUNLinSolFree(solver_);
  SUNMatDestroy(matrix_);
  N_VDestroy(tolerance_);
  N_VDestroy(state_);
  SUNContext_Free(&context_);
}

void CvodeIntegrator::use_jacobian(Jacobian jacobian) { require(CVodeSetJacFn(memory_, jacobian), "CVodeSetJacFn"); }

void CvodeIntegrator::count() {
  long since_start = 0;
  require(CVodeGetNumRhsEvals(memory_, &since_start), "CVodeGetNumRhsEvals");
  evaluations_ += since_start;
}

void CvodeIntegrator::start(double end) {
  require(CVodeReInit(memory_, time_, state_), "CVodeReInit");
  require(CVodeSetStopTime(memory_, end), "CVodeSetStopTime");
}

void CvodeIntegrator::advance(double end) {
  start(end);
  int restarts = 0;
  while (time_ < end) {
    const int flag = CVode(memory_, end, state_, &time_, CV_NORMAL);
    // A corner can defeat the error test, or hold the steps at next to nothing where a play is just not taken up; from there
    // itself it goes on.
    if ((flag == CV_ERR_FAILURE || flag == CV_CONV_FAILURE || flag == CV_TOO_MUCH_WORK) && ++restarts <= 20) {
      count();
      start(end);
    } else {
      require(flag, "CVode");
    }
  }
  count();
}

}  // namespace hotfire::study
