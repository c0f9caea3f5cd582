// Writes values as a NRRD file at once: x fastest, exactly geometry.voxelCount() of them.
#pragma once

#include "haptic_server/scans/nrrd/nrrd_writer.h"

namespace bonemill {

template <class T>
void writeValues(const std::filesystem::path& path, const VolumeGeometry& geometry,
                 std::span<const T> values) {
    NrrdStream<T> file(path, geometry);
    file.append(values);
    file.close();
}
inline void writeNrrd(const std::filesystem::path& path, const VolumeGeometry& geometry,
                      std::span<const uint8_t> values) {
    writeValues(path, geometry, values);
}
inline void writeNrrd(const std::filesystem::path& path, const VolumeGeometry& geometry,
                      std::span<const uint16_t> values) {
    writeValues(path, geometry, values);
}
inline void writeNrrd(const std::filesystem::path& path, const VolumeGeometry& geometry,
                      std::span<const float> values) {
    writeValues(path, geometry, values);
}

}  // namespace bonemill
