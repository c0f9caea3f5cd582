#include "haptic_server/core/kernels/kernels.h"

#include <cstdio>
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

bool isCalled(CpuLevel level, const char* name) noexcept {
    return name && std::strcmp(name, cpuLevelName(level)) == 0;
}

// The programs have no log yet.
void sayThatThereIsNone(const char* level) noexcept {
    std::fprintf(stderr,
                 "BONEMILL_CPU_LEVEL: there is no '%s'; give x86-64, avx2 or avx512. The best is taken.\n",
                 level);
}

CpuLevel bestLevel() noexcept {
    CpuLevel best = CpuLevel::kBaseline;
    const char* wanted = std::getenv("BONEMILL_CPU_LEVEL");
    bool is_known = !wanted;
    for (const CpuLevel level : kCpuLevels) is_known |= isCalled(level, wanted);
    if (!is_known) sayThatThereIsNone(wanted);
    for (const CpuLevel level : kCpuLevels) {
        if (!isSupported(level)) break;
        best = level;
        if (isCalled(level, wanted)) break;
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
