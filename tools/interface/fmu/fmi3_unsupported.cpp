// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "tools/interface/fmu/export_names.hpp"
#include "tools/interface/fmu/fmi3_types.hpp"

// The functions of FMI 3.0 for capabilities that the FMU does not have: variables of other types than Float64, clocks and
// events, model exchange, scheduled execution. The standard wants them exported; they return fmi3Error and log why.

fmi3Status hotfire_fmi3_refuse(fmi3Instance instance, const char* function, const char* problem);

namespace {

fmi3Status unsupported(fmi3Instance instance, const char* function) {
  return hotfire_fmi3_refuse(instance, function, "is not supported; see the capabilities in modelDescription.xml");
}

/// Variables of another type than Float64: the FMU has none.
fmi3Status none(fmi3Instance instance, const char* function, std::size_t count) {
  return count == 0 && instance != nullptr ? fmi3OK
                                           : hotfire_fmi3_refuse(instance, function, "the FMU has no variable of this type");
}

}  // namespace

// NOLINTBEGIN(readability-identifier-naming): the names are the standard's.

HOTFIRE_FMU_API fmi3Instance FMI3(fmi3InstantiateModelExchange)(fmi3String, fmi3String, fmi3String, fmi3Boolean, fmi3Boolean,
                                                                fmi3InstanceEnvironment environment,
                                                                fmi3LogMessageCallback log) {
  if (log != nullptr) {
    log(environment, fmi3Error, "logStatusError", "fmi3InstantiateModelExchange: the FMU is for co-simulation only");
  }
  return nullptr;
}
HOTFIRE_FMU_API fmi3Instance FMI3(fmi3InstantiateScheduledExecution)(fmi3String, fmi3String, fmi3String, fmi3Boolean,
                                                                     fmi3Boolean, fmi3InstanceEnvironment environment,
                                                                     fmi3LogMessageCallback log, fmi3ClockUpdateCallback,
                                                                     fmi3LockPreemptionCallback,
                                                                     fmi3UnlockPreemptionCallback) {
  if (log != nullptr) {
    log(environment, fmi3Error, "logStatusError", "fmi3InstantiateScheduledExecution: the FMU is for co-simulation only");
  }
  return nullptr;
}

HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetFloat32)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                                fmi3Float32[], std::size_t) {
  return none(instance, "fmi3GetFloat32", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetFloat32)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                                const fmi3Float32[], std::size_t) {
  return none(instance, "fmi3SetFloat32", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetInt8)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                             fmi3Int8[], std::size_t) {
  return none(instance, "fmi3GetInt8", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetInt8)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                             const fmi3Int8[], std::size_t) {
  return none(instance, "fmi3SetInt8", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetUInt8)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                              fmi3UInt8[], std::size_t) {
  return none(instance, "fmi3GetUInt8", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetUInt8)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                              const fmi3UInt8[], std::size_t) {
  return none(instance, "fmi3SetUInt8", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetInt16)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                              fmi3Int16[], std::size_t) {
  return none(instance, "fmi3GetInt16", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetInt16)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                              const fmi3Int16[], std::size_t) {
  return none(instance, "fmi3SetInt16", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetUInt16)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                               fmi3UInt16[], std::size_t) {
  return none(instance, "fmi3GetUInt16", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetUInt16)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                               const fmi3UInt16[], std::size_t) {
  return none(instance, "fmi3SetUInt16", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetInt32)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                              fmi3Int32[], std::size_t) {
  return none(instance, "fmi3GetInt32", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetInt32)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                              const fmi3Int32[], std::size_t) {
  return none(instance, "fmi3SetInt32", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetUInt32)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                               fmi3UInt32[], std::size_t) {
  return none(instance, "fmi3GetUInt32", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetUInt32)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                               const fmi3UInt32[], std::size_t) {
  return none(instance, "fmi3SetUInt32", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetInt64)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                              fmi3Int64[], std::size_t) {
  return none(instance, "fmi3GetInt64", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetInt64)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                              const fmi3Int64[], std::size_t) {
  return none(instance, "fmi3SetInt64", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetUInt64)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                               fmi3UInt64[], std::size_t) {
  return none(instance, "fmi3GetUInt64", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetUInt64)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                               const fmi3UInt64[], std::size_t) {
  return none(instance, "fmi3SetUInt64", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetBoolean)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                                fmi3Boolean[], std::size_t) {
  return none(instance, "fmi3GetBoolean", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetBoolean)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                                const fmi3Boolean[], std::size_t) {
  return none(instance, "fmi3SetBoolean", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetString)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                               fmi3String[], std::size_t) {
  return none(instance, "fmi3GetString", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetString)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                               const fmi3String[], std::size_t) {
  return none(instance, "fmi3SetString", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetBinary)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                               std::size_t[], fmi3Binary[], std::size_t) {
  return none(instance, "fmi3GetBinary", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetBinary)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                               const std::size_t[], const fmi3Binary[], std::size_t) {
  return none(instance, "fmi3SetBinary", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetClock)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                              fmi3Clock[]) {
  return none(instance, "fmi3GetClock", count);
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetClock)(fmi3Instance instance, const fmi3ValueReference[], std::size_t count,
                                              const fmi3Clock[]) {
  return none(instance, "fmi3SetClock", count);
}

HOTFIRE_FMU_API fmi3Status FMI3(fmi3EnterEventMode)(fmi3Instance instance) {
  return unsupported(instance, "fmi3EnterEventMode");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetNumberOfVariableDependencies)(fmi3Instance instance, fmi3ValueReference,
                                                                     std::size_t*) {
  return unsupported(instance, "fmi3GetNumberOfVariableDependencies");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetVariableDependencies)(fmi3Instance instance, fmi3ValueReference, std::size_t[],
                                                             fmi3ValueReference[], std::size_t[], fmi3DependencyKind[],
                                                             std::size_t) {
  return unsupported(instance, "fmi3GetVariableDependencies");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetAdjointDerivative)(fmi3Instance instance, const fmi3ValueReference[], std::size_t,
                                                          const fmi3ValueReference[], std::size_t, const fmi3Float64[],
                                                          std::size_t, fmi3Float64[], std::size_t) {
  return unsupported(instance, "fmi3GetAdjointDerivative");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3EnterConfigurationMode)(fmi3Instance instance) {
  return unsupported(instance, "fmi3EnterConfigurationMode");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3ExitConfigurationMode)(fmi3Instance instance) {
  return unsupported(instance, "fmi3ExitConfigurationMode");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetIntervalDecimal)(fmi3Instance instance, const fmi3ValueReference[], std::size_t,
                                                        fmi3Float64[], fmi3IntervalQualifier[]) {
  return unsupported(instance, "fmi3GetIntervalDecimal");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetIntervalFraction)(fmi3Instance instance, const fmi3ValueReference[], std::size_t,
                                                         fmi3UInt64[], fmi3UInt64[], fmi3IntervalQualifier[]) {
  return unsupported(instance, "fmi3GetIntervalFraction");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetShiftDecimal)(fmi3Instance instance, const fmi3ValueReference[], std::size_t,
                                                     fmi3Float64[]) {
  return unsupported(instance, "fmi3GetShiftDecimal");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetShiftFraction)(fmi3Instance instance, const fmi3ValueReference[], std::size_t,
                                                      fmi3UInt64[], fmi3UInt64[]) {
  return unsupported(instance, "fmi3GetShiftFraction");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetIntervalDecimal)(fmi3Instance instance, const fmi3ValueReference[], std::size_t,
                                                        const fmi3Float64[]) {
  return unsupported(instance, "fmi3SetIntervalDecimal");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetIntervalFraction)(fmi3Instance instance, const fmi3ValueReference[], std::size_t,
                                                         const fmi3UInt64[], const fmi3UInt64[]) {
  return unsupported(instance, "fmi3SetIntervalFraction");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetShiftDecimal)(fmi3Instance instance, const fmi3ValueReference[], std::size_t,
                                                     const fmi3Float64[]) {
  return unsupported(instance, "fmi3SetShiftDecimal");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetShiftFraction)(fmi3Instance instance, const fmi3ValueReference[], std::size_t,
                                                      const fmi3UInt64[], const fmi3UInt64[]) {
  return unsupported(instance, "fmi3SetShiftFraction");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3EvaluateDiscreteStates)(fmi3Instance instance) {
  return unsupported(instance, "fmi3EvaluateDiscreteStates");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3UpdateDiscreteStates)(fmi3Instance instance, fmi3Boolean*, fmi3Boolean*, fmi3Boolean*,
                                                          fmi3Boolean*, fmi3Boolean*, fmi3Float64*) {
  return unsupported(instance, "fmi3UpdateDiscreteStates");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3EnterContinuousTimeMode)(fmi3Instance instance) {
  return unsupported(instance, "fmi3EnterContinuousTimeMode");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3CompletedIntegratorStep)(fmi3Instance instance, fmi3Boolean, fmi3Boolean*,
                                                             fmi3Boolean*) {
  return unsupported(instance, "fmi3CompletedIntegratorStep");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetTime)(fmi3Instance instance, fmi3Float64) {
  return unsupported(instance, "fmi3SetTime");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3SetContinuousStates)(fmi3Instance instance, const fmi3Float64[], std::size_t) {
  return unsupported(instance, "fmi3SetContinuousStates");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetContinuousStateDerivatives)(fmi3Instance instance, fmi3Float64[], std::size_t) {
  return unsupported(instance, "fmi3GetContinuousStateDerivatives");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetEventIndicators)(fmi3Instance instance, fmi3Float64[], std::size_t) {
  return unsupported(instance, "fmi3GetEventIndicators");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetContinuousStates)(fmi3Instance instance, fmi3Float64[], std::size_t) {
  return unsupported(instance, "fmi3GetContinuousStates");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetNominalsOfContinuousStates)(fmi3Instance instance, fmi3Float64[], std::size_t) {
  return unsupported(instance, "fmi3GetNominalsOfContinuousStates");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetNumberOfEventIndicators)(fmi3Instance instance, std::size_t*) {
  return unsupported(instance, "fmi3GetNumberOfEventIndicators");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetNumberOfContinuousStates)(fmi3Instance instance, std::size_t*) {
  return unsupported(instance, "fmi3GetNumberOfContinuousStates");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3EnterStepMode)(fmi3Instance instance) {
  return unsupported(instance, "fmi3EnterStepMode");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3GetOutputDerivatives)(fmi3Instance instance, const fmi3ValueReference[], std::size_t,
                                                          const fmi3Int32[], fmi3Float64[], std::size_t) {
  return unsupported(instance, "fmi3GetOutputDerivatives");
}
HOTFIRE_FMU_API fmi3Status FMI3(fmi3ActivateModelPartition)(fmi3Instance instance, fmi3ValueReference, fmi3Float64) {
  return unsupported(instance, "fmi3ActivateModelPartition");
}

// NOLINTEND(readability-identifier-naming)
