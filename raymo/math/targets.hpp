// Which instruction sets Highway compiles lanes for: one ray at a time (the baseline of the build), SSE4, AVX2 and AVX-512;
// the steps between bring little. To be included before any header of Highway.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
