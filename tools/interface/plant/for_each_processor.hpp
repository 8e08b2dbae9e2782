// SPDX-License-Identifier: Apache-2.0
#pragma once

// A function that is compiled twice, for any x86_64 and for AVX2; the processor that runs it chooses. Both give the same
// bits. Two versions of a function need a compiler and a C library that choose between them at load time. The functions that
// sanitizers add are not there yet when that happens.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define HOTFIRE_FOR_EACH_PROCESSOR __attribute__((target_clones("default", "avx2"), flatten, aligned(64)))
#else
#define HOTFIRE_FOR_EACH_PROCESSOR
#endif
