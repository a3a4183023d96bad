#pragma once

// Before hwy/foreach_target.h: instruction sets that code is not compiled for. SIMD vectors are members of structures
// and of arrays here, which sets of unknown vector length (SVE, RVV) do not allow. On ARM, NEON remains.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
