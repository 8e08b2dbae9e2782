// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/interface/plant/plant.hpp"

namespace hotfire {

/// What an FMU is called.
struct FmuIdentity {
  int version = 3;         ///< of FMI: 2 or 3
  std::string name;        ///< of the model
  std::string identifier;  ///< of its binary and its functions: a C identifier
  std::string token;       ///< instantiationToken, guid
};

/// modelDescription.xml of a plant [FMI 3.0 section 2.4; FMI 2.0 section 2.2]. Value references: 0 is time, then the tables
/// of inputs, outputs and parameters, as interface/fmu/slave.hpp reads them.
std::string model_description(const plant::Plant& plant, const FmuIdentity& identity);

/// sources/buildDescription.xml of FMI 3.0.
std::string build_description(const FmuIdentity& identity);

}  // namespace hotfire
