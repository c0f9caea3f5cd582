#include "haptic_server/scans/confined/import_limits.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <optional>

#include "common/base/user_error.h"
#include "common/process/work_ahead.h"
#include "haptic_server/core/kernels/brick_layout.h"
#include "haptic_server/scans/confined/free_memory.h"
#include "haptic_server/scans/confined/sanitized.h"

namespace bonemill {
namespace {

std::atomic<bool> is_capped = false;

// Returns the limits with `extra_bytes` more than is mapped now; nothing when there is no capping.
std::optional<rlimit> cappedLimit(uint64_t extra_bytes, rlimit& now) {
    uint64_t pages = 0;
    if (kIsSanitized || !(std::ifstream("/proc/self/statm") >> pages) || getrlimit(RLIMIT_AS, &now) != 0)
        return std::nullopt;
    rlimit capped = now;
    capped.rlim_cur = std::min<rlim_t>(now.rlim_cur, pages * uint64_t(sysconf(_SC_PAGESIZE)) + extra_bytes);
    return capped;
}

std::string sizeText(const std::vector<uint64_t>& dims) {
    std::string text;
    for (const uint64_t n : dims) text += (text.empty() ? "" : " x ") + std::to_string(n);
    return text;
}

}  // namespace

MemoryCap::MemoryCap(uint64_t extra_bytes) : is_outermost_(!is_capped.exchange(true)) {
    if (!is_outermost_) return;
    const auto capped = cappedLimit(extra_bytes, before_);
    is_set_ = capped && setrlimit(RLIMIT_AS, &*capped) == 0;
}

MemoryCap::~MemoryCap() {
    if (is_set_) setrlimit(RLIMIT_AS, &before_);
    if (is_outermost_) is_capped = false;
}

uint64_t memoryForAll(uint64_t bytes_of_one, uint64_t bytes_taken) {
    constexpr uint64_t kThread = uint64_t(256) << 20;  // its stack and its heap, most of it never used
    return mostAtATime() * (bytes_of_one + kThread) + bytes_taken;
}

void capMemoryForGood(uint64_t extra_bytes) noexcept {
    rlimit now{};
    auto capped = cappedLimit(extra_bytes, now);
    if (!capped) return;
    capped->rlim_max = capped->rlim_cur;
    if (capped->rlim_max < now.rlim_max) noteOwnAddressLimit(capped->rlim_max);
    setrlimit(RLIMIT_AS, &*capped);
}

void checkVolumeSize(const std::vector<uint64_t>& dims, uint64_t bytes_per_voxel, const std::string& file) {
    if (dims.size() != 3)
        throw UserError(file + ": has " + std::to_string(dims.size()) + " dimensions (" + sizeText(dims) +
                        "); one volume of three is needed");
    uint64_t voxels = 1;
    for (const uint64_t n : dims) {
        if (n < 2)
            throw UserError(file + ": is only " + sizeText(dims) +
                            " voxels; a volume needs 2 or more per axis");
        if (n > kMaxVoxels || (voxels *= n) > kMaxVoxels)
            throw UserError(file + ": claims " + sizeText(dims) +
                            " voxels, more than 2^31; crop or resample it");
    }
    // Samples move from the reader's process to this one; what was moved is given back.
    const uint64_t needed = voxels * bytes_per_voxel;
    if (const FreeMemory free = freeMemory(); !free.holds(needed))
        throw UserError(file + ": " + sizeText(dims) + " voxels need " + std::to_string(needed >> 20) +
                        " MiB to import and " + free.text() + "; crop or resample it");
}

void refuseMemory(uint64_t bytes, const std::string& file) {
    const FreeMemory free = freeMemory();
    if (!free.holds(bytes))
        throw UserError(file + ": there is not enough memory to read it: it may take " +
                        std::to_string(bytes >> 20) + " MiB, and " + free.text() + "; crop or resample it");
    throw UserError(file + ": asks for more than " + std::to_string(bytes >> 20) +
                    " MiB of memory, which no file of its size needs; it is damaged");
}

void checkAllCanBeBone(const std::vector<uint64_t>& dims, const std::string& file) {
    uint64_t bricks = 1;
    for (const uint64_t n : dims) bricks *= (n + 2 + kBrickCells - 1) / kBrickCells;
    const uint64_t needed = bricks * kBrickSize * sizeof(uint16_t);
    if (const FreeMemory free = freeMemory(); !free.holds(needed))
        throw UserError(file + ": all of its " + sizeText(dims) + " voxels may need " +
                        std::to_string(needed >> 20) + " MiB as bone and " + free.text() +
                        "; name the part that is milled in volume.region, or crop or resample it");
}

void checkStoredBytes(uint64_t promised_bytes, uint64_t stored_bytes, const std::string& file) {
    if (promised_bytes > stored_bytes)
        throw UserError(file + ": the header promises " + std::to_string(promised_bytes) +
                        " bytes of voxels, the file cannot hold more than " + std::to_string(stored_bytes) +
                        "; it is cut short or damaged");
}

}  // namespace bonemill
