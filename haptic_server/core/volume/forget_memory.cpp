#include "haptic_server/core/volume/forget_memory.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace bonemill {

void forgetBytes(std::span<std::byte> bytes) noexcept {
    const auto page = uintptr_t(sysconf(_SC_PAGESIZE));
    const auto first = reinterpret_cast<uintptr_t>(bytes.data());
    const uintptr_t begin = (first + page - 1) / page * page, end = (first + bytes.size()) / page * page;
    if (begin < end) madvise(bytes.data() + (begin - first), end - begin, MADV_DONTNEED);
}

}  // namespace bonemill
