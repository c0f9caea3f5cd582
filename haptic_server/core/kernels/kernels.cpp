#include "haptic_server/core/kernels/kernels.h"

#include <cstdlib>
#include <cstring>

namespace bonemill {

namespace baseline {
extern const Kernels kTable;
}
namespace avx2 {
extern const Kernels kTable;
}
namespace avx512 {
extern const Kernels kTable;
}

namespace {

CpuLevel bestLevel() noexcept {
    CpuLevel best = CpuLevel::kBaseline;
    const char* wanted = std::getenv("BONEMILL_CPU_LEVEL");
    for (const CpuLevel level : kCpuLevels) {
        if (!isSupported(level)) break;
        best = level;
        if (wanted && std::strcmp(wanted, cpuLevelName(level)) == 0) break;
    }
    return best;
}

// This does not stand inside a function: the lock of its first call has no place in a tick.
const Kernels& best_kernels = kernelsOf(bestLevel());

}  // namespace

const char* cpuLevelName(CpuLevel level) noexcept {
    constexpr const char* kNames[] = {"x86-64", "avx2", "avx512"};
    return kNames[size_t(level)];
}

bool isSupported(CpuLevel level) noexcept {
    __builtin_cpu_init();
    switch (level) {
        case CpuLevel::kAvx512:
            return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                   __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
        case CpuLevel::kAvx2:
            return __builtin_cpu_supports("avx2");
        default:
            return true;
    }
}

const Kernels& kernelsOf(CpuLevel level) noexcept {
    switch (level) {
        case CpuLevel::kAvx512:
            return avx512::kTable;
        case CpuLevel::kAvx2:
            return avx2::kTable;
        default:
            return baseline::kTable;
    }
}

const Kernels& kernels() noexcept {
    return best_kernels;
}

}  // namespace bonemill
