// SPDX-License-Identifier: Apache-2.0
// The TOML library, compiled here so that the fuzzers see its branches and the sanitizers its memory.
#define TOML_IMPLEMENTATION
#include <toml++/toml.h>
