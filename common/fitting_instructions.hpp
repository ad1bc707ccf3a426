#pragma once

/// Before a function: it is compiled for several processors, and the widest instructions of the one
/// at hand are taken; Debian's baseline has two numbers in one.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define CHLADNI_FITTING_INSTRUCTIONS \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define CHLADNI_FITTING_INSTRUCTIONS
#endif
