#include "haptic_server/scans/nrrd/nrrd_writer.h"

#include <vector>

namespace bonemill {
namespace {

template <class T>
void write(const std::filesystem::path& path, const VolumeGeometry& geometry, std::span<const T> values,
           NrrdEncoding encoding) {
    NrrdStream<T> file(path, geometry, encoding);
    file.append(values);
    file.close();
}

}  // namespace

void writeNrrd(const std::filesystem::path& path, const VolumeGeometry& geometry,
               std::span<const uint8_t> values, NrrdEncoding encoding) {
    write(path, geometry, values, encoding);
}

void writeNrrd(const std::filesystem::path& path, const VolumeGeometry& geometry,
               std::span<const uint16_t> values, NrrdEncoding encoding) {
    write(path, geometry, values, encoding);
}

void writeNrrd(const std::filesystem::path& path, const VolumeGeometry& geometry,
               std::span<const float> values, NrrdEncoding encoding) {
    write(path, geometry, values, encoding);
}

void writeNrrd(const std::filesystem::path& path, const VoxelVolume& volume, NrrdEncoding encoding) {
    const Eigen::Vector3i& n = volume.dims();
    NrrdStream<Density> file(path, volume.geometry(), encoding);
    std::vector<Density> row(size_t(n.x()));
    for (int k = 0; k < n.z(); ++k)
        for (int j = 0; j < n.y(); ++j) {
            for (int i = 0; i < n.x(); ++i) row[size_t(i)] = volume.at(i, j, k);
            file.append(row);
        }
    file.close();
}

}  // namespace bonemill
