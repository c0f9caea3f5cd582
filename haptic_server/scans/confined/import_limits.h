// Refuses sizes that cannot be right before anything is allocated for them, and keeps a library from
// allocating whatever a damaged length field says. There is no Eigen in here: ITK's sources include it.
#pragma once

#include <sys/resource.h>

#include <cstdint>
#include <string>
#include <vector>

namespace bonemill {

inline constexpr uint64_t kMaxVoxels = uint64_t(1) << 31;

// deflate shrinks at most 1032 : 1 (zlib technical details); a header that promises more than
// that is damaged.
inline constexpr uint64_t kMaxDeflateRatio = 1040;

// Throws UserError naming `file` unless `dims` are three axes of >= 2 voxels (one slice is no volume), at
// most kMaxVoxels in all, and the import fits into the memory that is free now. `bytes_per_voxel` is what the
// reader takes at the most.
void checkVolumeSize(const std::vector<uint64_t>& dims, uint64_t bytes_per_voxel, const std::string& file);

// Throws UserError naming `file` unless the densities of all these voxels fit into the memory that is free
// now, wherever bone may be.
void checkAllCanBeBone(const std::vector<uint64_t>& dims, const std::string& file);

// Of a reader that had no memory left under a cap of so many bytes (MemoryCap). Throws UserError: the memory
// is short, or the file is damaged where there was more than that.
[[noreturn]] void refuseMemory(uint64_t bytes, const std::string& file);

// Throws UserError when fewer bytes are stored than the header promises.
void checkStoredBytes(uint64_t promised_bytes, uint64_t stored_bytes, const std::string& file);

// While it lives, the process may map at most `extra_bytes` more than it does now; beyond that, allocation
// fails with std::bad_alloc. It has no effect under sanitizers, which map terabytes themselves, and none
// while another one lives: that of several files (memoryForAll) counts for each of them. It is for start-up
// only; one that has an effect lives longer than all threads that begin after it.
class MemoryCap {
  public:
    explicit MemoryCap(uint64_t extra_bytes);
    ~MemoryCap();
    MemoryCap(const MemoryCap&) = delete;
    MemoryCap& operator=(const MemoryCap&) = delete;

  private:
    rlimit before_{};
    bool is_outermost_ = false, is_set_ = false;
};

// What reading a folder by several threads (work_ahead.h) may take: so much for one file, and for what comes
// of all.
uint64_t memoryForAll(uint64_t bytes_of_one, uint64_t bytes_taken);

// Does the same for all that this process will do, and cannot be taken back.
void capMemoryForGood(uint64_t extra_bytes) noexcept;

}  // namespace bonemill
