// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over plain numbers, compiled once for every processor and once for wider vectors.
#pragma once

/// Before a function: on x86-64 it also exists with AVX2, and the loader takes what the processor has. The
/// numbers are the same to the bit on both, since nothing is contracted (-ffp-contract=off) and no sum is
/// reordered. What it calls must be TACTO_SIMD_INLINE to be compiled with it. By GCC only: clang 16 loses
/// inline functions that only clones call; and not under sanitizers, whose runtime isn't up when the loader
/// asks.
#if defined(__x86_64__) && defined(__ELF__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TACTO_SIMD_CLONES __attribute__((target_clones("avx2", "default")))
#define TACTO_SIMD_INLINE inline __attribute__((always_inline))
#else
#define TACTO_SIMD_CLONES
#define TACTO_SIMD_INLINE inline
#endif
