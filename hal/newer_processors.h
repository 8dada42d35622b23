#pragma once

/// Before a function: compiled twice, with what it calls, and the better version for the processor
/// is taken when the program starts. Neither contracts products and sums: both give the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define LUMIBOX_FOR_NEWER_PROCESSORS [[gnu::target_clones("default", "avx2"), gnu::flatten]]
#else
#define LUMIBOX_FOR_NEWER_PROCESSORS
#endif
