// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>

#include <vector>

namespace hotfire::study {

/// SUNDIALS CVODE (BDF, dense) with a relative tolerance and an absolute one of a tenth of it of each state's scale.
class CvodeIntegrator {
 public:
  using Derivative = int (*)(double, N_Vector, N_Vector, void*);
  using Jacobian = int (*)(double, N_Vector, N_Vector, SUNMatrix, void*, N_Vector, N_Vector, N_Vector);

  /// Starts at time zero with every state zero. `user` is handed to `derivative`. Throws std::runtime_error if CVODE
  /// refuses.
  CvodeIntegrator(Derivative derivative, void* user, const std::vector<double>& scale, double tolerance = 1e-10);
  CvodeIntegrator(const CvodeIntegrator&) = delete;
  CvodeIntegrator& operator=(const CvodeIntegrator&) = delete;
  ~CvodeIntegrator();

  /// Takes the Jacobian of the derivative from a function instead of from differences.
  void use_jacobian(Jacobian jacobian);

  double* state() { return N_VGetArrayPointer(state_); }
  double time() const { return time_; }

  /// Goes on to `end`, started afresh: what drives the derivative may have jumped. Throws std::runtime_error if CVODE gives
  /// up.
  void advance(double end);

  /// Evaluations of the derivative so far, without those for the Jacobian's differences.
  long evaluations() const { return evaluations_; }

 private:
  void start(double end);
  void count();

  SUNContext context_ = nullptr;
  N_Vector state_ = nullptr;
  N_Vector tolerance_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  void* memory_ = nullptr;
  double time_ = 0.0;
  long evaluations_ = 0;
};

}  // namespace hotfire::study
