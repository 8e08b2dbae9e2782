// SPDX-License-Identifier: Apache-2.0
#pragma once

// How the functions of an FMU are exported, as the standards' headers do it. FMI2_FUNCTION_PREFIX or FMI3_FUNCTION_PREFIX,
// which the sources of an FMU define as its model identifier, precedes each name. With FMI2_OVERRIDE_FUNCTION_PREFIX or
// FMI3_OVERRIDE_FUNCTION_PREFIX the prefix is FMI2_ACTUAL_FUNCTION_PREFIX or FMI3_ACTUAL_FUNCTION_PREFIX instead, or none: a
// shared library has the standard's names.

#define HOTFIRE_JOIN(a, b) a##b
#define HOTFIRE_JOIN_VALUES(a, b) HOTFIRE_JOIN(a, b)

#if !defined(FMI2_OVERRIDE_FUNCTION_PREFIX) && defined(FMI2_FUNCTION_PREFIX)
#define FMI2_ACTUAL_FUNCTION_PREFIX FMI2_FUNCTION_PREFIX
#endif
#if defined(FMI2_ACTUAL_FUNCTION_PREFIX)
#define FMI2(name) HOTFIRE_JOIN_VALUES(FMI2_ACTUAL_FUNCTION_PREFIX, name)
#else
#define FMI2(name) name
#endif

#if !defined(FMI3_OVERRIDE_FUNCTION_PREFIX) && defined(FMI3_FUNCTION_PREFIX)
#define FMI3_ACTUAL_FUNCTION_PREFIX FMI3_FUNCTION_PREFIX
#endif
#if defined(FMI3_ACTUAL_FUNCTION_PREFIX)
#define FMI3(name) HOTFIRE_JOIN_VALUES(FMI3_ACTUAL_FUNCTION_PREFIX, name)
#else
#define FMI3(name) name
#endif

#if defined(_WIN32)
#define HOTFIRE_FMU_API extern "C" __declspec(dllexport)
#else
#define HOTFIRE_FMU_API extern "C" __attribute__((visibility("default")))
#endif
