// Which instruction sets this processor has, for Highway's dispatch.
//
// Highway's own library answers this too, but loading it costs 4 ms: it measures the resolution of the clock when it is
// loaded. Only these two functions of it were used, so they stand here and the library is not linked.
#include <hwy/targets.h>

namespace hwy {

int64_t SupportedTargets() {
    static const int64_t kTargets = [] {
        int64_t out = HWY_ENABLED_BASELINE;
#if HWY_ARCH_X86
        __builtin_cpu_init();
        const bool sse4 = __builtin_cpu_supports("sse4.1") && __builtin_cpu_supports("sse4.2") &&
                          __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("aes");
        const bool avx2 = sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                          __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                          __builtin_cpu_supports("lzcnt") && __builtin_cpu_supports("f16c");
        const bool avx3 = avx2 && __builtin_cpu_supports("avx512f") &&
                          __builtin_cpu_supports("avx512vl") &&
                          __builtin_cpu_supports("avx512dq") &&
                          __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd");
        if (sse4) out |= HWY_SSE4;
        if (avx2) out |= HWY_AVX2;
        if (avx3) out |= HWY_AVX3;
#endif
        return out;
    }();
    return kTargets;
}

ChosenTarget& GetChosenTarget() {
    static ChosenTarget chosen;
    return chosen;
}

}  // namespace hwy
