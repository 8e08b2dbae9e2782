// SPDX-License-Identifier: Apache-2.0
#include "tools/interface/fmu/slave.hpp"

// The binary of every FMU is the same and reads the plant from resources/; the sources of an FMU have a file of their own.
const char* const hotfire::fmu::kCompiledPlant = nullptr;
