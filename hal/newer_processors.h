#pragma once

/// Before a function: compiled twice, with what it calls, and the better version for the processor
/// is taken when the program starts. Neither contracts products and sums: both give the same bits.
/// The thread sanitizer cannot have it: it would look at the choice before it has begun itself.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define LUMIBOX_FOR_NEWER_PROCESSORS [[gnu::target_clones("default", "avx2"), gnu::flatten]]
#else
#define LUMIBOX_FOR_NEWER_PROCESSORS
#endif
