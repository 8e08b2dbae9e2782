// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <matio.h>

#include <memory>

namespace hotfire {

struct CloseMat {
  void operator()(mat_t* file) const noexcept { Mat_Close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const noexcept { Mat_VarFree(variable); }
};

/// A MATLAB file that matio has open, and a variable of one.
using MatFile = std::unique_ptr<mat_t, CloseMat>;
using MatVariable = std::unique_ptr<matvar_t, FreeVariable>;

}  // namespace hotfire
