// Writes volumes as attached NRRD (NRRD0004, little endian), in LPS and mm as every viewer expects.
//
// A key/value line "bonemill geometry" repeats the geometry as hexadecimal floats, because decimal mm cannot
// bring back every double of m; importVolume uses it as long as it agrees with the standard fields, so that
// the geometry of our own files returns bit for bit. It is not RT-safe. Throws UserError when the file
// cannot be written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "haptic_server/core/volume/raw_volume.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// Writes a file of T = uint8_t, int16_t, uint16_t or float as the values come: no volume is too large for it.
template <class T>
class NrrdStream {
  public:
    NrrdStream(const std::filesystem::path& path, const VolumeGeometry& geometry,
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

// Writes the densities (counts, 16 bit) without the border of air.
void writeNrrd(const std::filesystem::path& path, const VoxelVolume& volume);

}  // namespace bonemill
