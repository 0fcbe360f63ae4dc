/* Instruction sets: what this machine and its system run. */
#include "core_impl.h"

#if defined(__x86_64__)

static int32_t runs_avx2(void) {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

static int32_t runs_avx512(void) {
  return runs_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
}

#else

static int32_t runs_avx2(void) { return 0; }
static int32_t runs_avx512(void) { return 0; }

#endif

int32_t sph_isa_available(int32_t isa) {
  switch (isa) {
  case SPH_ISA_AUTO:
  case SPH_ISA_PORTABLE:
    return 1;
  case SPH_ISA_AVX2:
    return runs_avx2();
  case SPH_ISA_AVX512:
    return runs_avx512();
  }
  return 0;
}

const char *sph_isa_name(int32_t isa) {
  switch (isa) {
  case SPH_ISA_PORTABLE:
    return "portable";
  case SPH_ISA_AVX2:
    return "avx2";
  case SPH_ISA_AVX512:
    return "avx512";
  }
  return "unknown";
}

sph_status sphi_isa_choose(int32_t wanted, int32_t *chosen) {
  if (wanted < SPH_ISA_AUTO || wanted > SPH_ISA_AVX512) return SPH_ERR_ARG;
  if (wanted == SPH_ISA_AUTO) {
    wanted = SPH_ISA_AVX512;
    while (!sph_isa_available(wanted)) --wanted;
  }
  if (!sph_isa_available(wanted)) return SPH_ERR_UNSUPPORTED;
  *chosen = wanted;
  return SPH_OK;
}
