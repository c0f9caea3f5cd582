#include "haptic_server/volume/import/nrrd_writer.h"

#include <zlib.h>

#include <bit>
#include <cstdio>
#include <fstream>
#include <vector>

#include "common/config/user_error.h"
#include "haptic_server/volume/import/nrrd_header.h"

namespace bonemill {
namespace {

static_assert(std::endian::native == std::endian::little, "the header says little endian");

std::string vectorText(const Eigen::Vector3d& v) {
    char text[128];
    std::snprintf(text, sizeof text, "(%.17g,%.17g,%.17g)", v.x(), v.y(), v.z());
    return text;
}

std::string headerText(const VolumeGeometry& geometry, const char* type, NrrdEncoding encoding) {
    const Eigen::Matrix3d R_WV = geometry.X_WV.rotation.toRotationMatrix();
    const Eigen::Vector3d spacing_mm = geometry.spacing * 1000;
    std::string text = "NRRD0004\n";
    text += std::string("type: ") + type + "\ndimension: 3\nspace: left-posterior-superior\nsizes:";
    for (int a = 0; a < 3; ++a) text += ' ' + std::to_string(geometry.dims[a]);
    text += "\nspace directions:";
    for (int a = 0; a < 3; ++a) text += ' ' + vectorText(R_WV.col(a) * spacing_mm[a]);
    text += "\nkinds: domain domain domain\nendian: little\n";
    text += std::string("encoding: ") + (encoding == NrrdEncoding::kGzip ? "gzip" : "raw");
    text += "\nspace units: \"mm\" \"mm\" \"mm\"\n";
    text += "space origin: " + vectorText(geometry.X_WV.position * 1000) + "\n";
    text += std::string(kNrrdGeometryKey) + ":=" + geometryToText(geometry) + "\n\n";
    return text;
}

void writeGzip(std::ofstream& file, std::span<const std::byte> bytes) {
    constexpr int kGzipWindow = 15 + 16;  // zlib: 16 added asks for a gzip wrapper, without a time stamp
    z_stream stream{};
    if (deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, kGzipWindow, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::bad_alloc();
    std::vector<Bytef> out(size_t(1) << 18);
    constexpr size_t kChunk = size_t(1) << 26;
    size_t done = 0;
    int state = Z_OK;
    while (state != Z_STREAM_END) {
        if (stream.avail_in == 0 && done < bytes.size()) {
            const size_t chunk = std::min(kChunk, bytes.size() - done);
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data() + done));
            stream.avail_in = uInt(chunk);
            done += chunk;
        }
        stream.next_out = out.data();
        stream.avail_out = uInt(out.size());
        state = deflate(&stream, done == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
        file.write(reinterpret_cast<const char*>(out.data()), std::streamsize(out.size() - stream.avail_out));
    }
    deflateEnd(&stream);
}

template <class T>
void write(const std::filesystem::path& path, const VolumeGeometry& geometry, std::span<const T> values,
           const char* type, NrrdEncoding encoding) {
    if (values.size() != geometry.voxelCount())
        throw UserError(path.string() + ": " + std::to_string(values.size()) +
                        " values do not fill the volume");
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    const std::string header = headerText(geometry, type, encoding);
    file.write(header.data(), std::streamsize(header.size()));
    const auto bytes = std::as_bytes(values);
    if (encoding == NrrdEncoding::kGzip)
        writeGzip(file, bytes);
    else
        file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    file.close();
    if (!file)
        throw UserError("cannot write " + path.string() + "; check that the folder exists and has room");
}

}  // namespace

void writeNrrd(const std::filesystem::path& path, const VolumeGeometry& geometry,
               std::span<const uint8_t> values, NrrdEncoding encoding) {
    write(path, geometry, values, "uint8", encoding);
}

void writeNrrd(const std::filesystem::path& path, const VolumeGeometry& geometry,
               std::span<const uint16_t> values, NrrdEncoding encoding) {
    write(path, geometry, values, "uint16", encoding);
}

void writeNrrd(const std::filesystem::path& path, const VolumeGeometry& geometry,
               std::span<const float> values, NrrdEncoding encoding) {
    write(path, geometry, values, "float", encoding);
}

void writeNrrd(const std::filesystem::path& path, const VoxelVolume& volume, NrrdEncoding encoding) {
    const Eigen::Vector3i n = volume.dims();
    std::vector<uint16_t> values;
    values.reserve(volume.geometry().voxelCount());
    for (int k = 0; k < n.z(); ++k)
        for (int j = 0; j < n.y(); ++j)
            for (int i = 0; i < n.x(); ++i) values.push_back(volume.at(i, j, k));
    writeNrrd(path, volume.geometry(), std::span<const uint16_t>(values), encoding);
}

}  // namespace bonemill
