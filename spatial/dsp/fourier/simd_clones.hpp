// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over plain numbers, compiled twice: for every processor and for wider vectors.
#pragma once

/// Attribute for a function: on x86-64 it also exists with AVX2, and the loader selects the variant for the
/// processor. Both give the same numbers to the bit, because nothing is contracted (-ffp-contract=off) and no
/// sum is reordered. Functions that it calls must be TACTO_SIMD_INLINE to be compiled with it. Only with GCC,
/// because clang 16 loses inline functions that only clones call; and not under sanitizers, whose runtime is
/// not ready when the loader selects.
#if defined(__x86_64__) && defined(__ELF__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TACTO_SIMD_CLONES __attribute__((target_clones("avx2", "default")))
#define TACTO_SIMD_INLINE inline __attribute__((always_inline))
#else
#define TACTO_SIMD_CLONES
#define TACTO_SIMD_INLINE inline
#endif
