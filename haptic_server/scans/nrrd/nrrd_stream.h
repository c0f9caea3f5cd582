// Writes one attached NRRD file (NRRD0004, little endian) of T = uint8_t, int16_t, uint16_t or float as the
// values come: no volume is too large for it. It is not RT-safe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

enum class NrrdEncoding { kRaw, kGzip };

template <class T>
class NrrdStream {
  public:
    NrrdStream(const std::filesystem::path& path, const VolumeGeometry& geometry, NrrdEncoding encoding,
               bool lacks_patient_axes = false);
    ~NrrdStream();
    NrrdStream(const NrrdStream&) = delete;
    NrrdStream& operator=(const NrrdStream&) = delete;

    void append(std::span<const T> values);  // x fastest
    // Throws UserError when the file could not be written or has not geometry.voxelCount() values. A file
    // that was not closed is damaged.
    void close();

  private:
    class File;

    std::unique_ptr<File> file_;
    uint64_t missing_;  // values still to come
};

}  // namespace bonemill
