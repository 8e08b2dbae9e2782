// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

// Types of FMI 2.0 as the standard's text declares them (Modelica Association, FMI 2.0, sections 2.1 and 4.2) for the
// platform "default": own declarations of the names and layouts that its binary interface fixes. The standard's own headers,
// under the 2-clause BSD licence, declare the same and are not part of this project.

// NOLINTBEGIN(readability-identifier-naming): the names are the standard's.
using fmi2Component = void*;
using fmi2ComponentEnvironment = void*;
using fmi2FMUstate = void*;
using fmi2ValueReference = unsigned int;
using fmi2Real = double;
using fmi2Integer = int;
using fmi2Boolean = int;
using fmi2String = const char*;
using fmi2Byte = char;

enum fmi2Status { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending };
enum fmi2Type { fmi2ModelExchange, fmi2CoSimulation };
enum fmi2StatusKind { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated };

using fmi2CallbackLogger = void (*)(fmi2ComponentEnvironment, fmi2String instance, fmi2Status, fmi2String category,
                                    fmi2String message, ...);
struct fmi2CallbackFunctions {
  fmi2CallbackLogger logger;
  void* (*allocateMemory)(std::size_t count, std::size_t size);
  void (*freeMemory)(void* block);
  void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
  fmi2ComponentEnvironment componentEnvironment;
};
// NOLINTEND(readability-identifier-naming)
