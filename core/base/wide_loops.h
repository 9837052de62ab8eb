#pragma once

#include <cstddef>  // __GLIBC__

/// Before a function whose loops do the same to many numbers: compiled for several widths of
/// vectors, of which the processor's is called. Which one that is is found out while the program is
/// loaded, before the thread sanitizer can run.
///
/// Figures are the same for every width where multiplications and additions are not contracted
/// (-ffp-contract=off).
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__)
#define RELEVO_WIDE_LOOPS [[gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define RELEVO_WIDE_LOOPS
#endif
