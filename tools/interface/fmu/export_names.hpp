// SPDX-License-Identifier: Apache-2.0
#pragma once

// How the functions of an FMU are exported. In a shared library their names are those of the standard. Who links several
// FMUs statically compiles each with -DFMI2_FUNCTION_PREFIX=name_ or -DFMI3_FUNCTION_PREFIX=name_, as the standard says.

#define HOTFIRE_JOIN(a, b) a##b
#define HOTFIRE_JOIN_VALUES(a, b) HOTFIRE_JOIN(a, b)

#if defined(FMI2_FUNCTION_PREFIX) && !defined(FMI2_OVERRIDE_FUNCTION_PREFIX)
#define FMI2(name) HOTFIRE_JOIN_VALUES(FMI2_FUNCTION_PREFIX, name)
#else
#define FMI2(name) name
#endif

#if defined(FMI3_FUNCTION_PREFIX) && !defined(FMI3_OVERRIDE_FUNCTION_PREFIX)
#define FMI3(name) HOTFIRE_JOIN_VALUES(FMI3_FUNCTION_PREFIX, name)
#else
#define FMI3(name) name
#endif

#if defined(_WIN32)
#define HOTFIRE_FMU_API extern "C" __declspec(dllexport)
#else
#define HOTFIRE_FMU_API extern "C" __attribute__((visibility("default")))
#endif
