#include "haptic_server/scans/nrrd/nrrd_writer.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <fstream>
#include <new>
#include <type_traits>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/files/whole_file.h"
#include "common/text/printed_text.h"
#include "haptic_server/scans/nrrd/nrrd_header.h"

namespace bonemill {
namespace {

static_assert(std::endian::native == std::endian::little, "the header says little endian");

std::string vectorText(const Eigen::Vector3d& v) {
    return printed("(%.17g,%.17g,%.17g)", v.x(), v.y(), v.z());
}

std::string headerText(const VolumeGeometry& geometry, const char* type, bool lacks_patient_axes) {
    const Eigen::Matrix3d R_WV = geometry.X_WV.rotation.toRotationMatrix();
    const Eigen::Vector3d spacing_mm = geometry.spacing * kPerMillimetre;
    std::string text = "NRRD0004\n";
    text += std::string("type: ") + type + "\ndimension: 3\n";
    text += lacks_patient_axes ? "space dimension: 3\nsizes:" : "space: left-posterior-superior\nsizes:";
    for (int a = 0; a < 3; ++a) text += ' ' + std::to_string(geometry.dims[a]);
    text += "\nspace directions:";
    for (int a = 0; a < 3; ++a) text += ' ' + vectorText(R_WV.col(a) * spacing_mm[a]);
    text += "\nkinds: domain domain domain\nendian: little\nencoding: gzip\n";
    text += "space units: \"mm\" \"mm\" \"mm\"\n";
    text += "space origin: " + vectorText(geometry.X_WV.position * kPerMillimetre) + "\n";
    text += std::string(kNrrdGeometryKey) + ":=" + geometryToText(geometry) + "\n\n";
    return text;
}

template <class T>
constexpr const char* typeName() {
    if (std::is_same_v<T, uint8_t>) return "uint8";
    if (std::is_same_v<T, int16_t>) return "int16";
    return std::is_same_v<T, uint16_t> ? "uint16" : "float";
}

}  // namespace

template <class T>
class NrrdStream<T>::File {
  public:
    File(const std::filesystem::path& path, const std::string& header)
        : whole_(path), file_(whole_.part(), std::ios::binary | std::ios::trunc) {
        constexpr int kGzipWindow = 15 + 16;  // zlib: 16 added asks for a gzip wrapper, without a time stamp
        file_.write(header.data(), std::streamsize(header.size()));
        if (deflateInit2(&stream_, Z_BEST_SPEED, Z_DEFLATED, kGzipWindow, 8, Z_DEFAULT_STRATEGY) != Z_OK)
            throw std::bad_alloc();
    }
    ~File() { deflateEnd(&stream_); }

    void write(std::span<const std::byte> bytes) {
        constexpr size_t kChunk = size_t(1) << 26;  // zlib counts with 32 bit
        for (size_t begin = 0; begin < bytes.size(); begin += kChunk)
            pack(bytes.subspan(begin, std::min(kChunk, bytes.size() - begin)), Z_NO_FLUSH);
    }
    void close(bool is_full) {
        pack({}, Z_FINISH);
        file_.close();
        if (!file_) throw UserError("cannot write " + whole_.path().string() + "; is its disk full?");
        if (!is_full) throw UserError(whole_.path().string() + ": too few or too many values for the volume");
        whole_.finish();
    }

  private:
    // `flush` is Z_NO_FLUSH, or Z_FINISH for the last bytes.
    void pack(std::span<const std::byte> bytes, int flush) {
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
        stream_.avail_in = uInt(bytes.size());
        do {
            stream_.next_out = out_.data();
            stream_.avail_out = uInt(out_.size());
            deflate(&stream_, flush);
            file_.write(reinterpret_cast<const char*>(out_.data()),
                        std::streamsize(out_.size() - stream_.avail_out));
        } while (stream_.avail_out == 0);  // zlib: room left means that all input is used
    }

    WholeFile whole_;
    std::ofstream file_;
    z_stream stream_{};
    std::vector<Bytef> out_ = std::vector<Bytef>(size_t(1) << 18);
};

template <class T>
NrrdStream<T>::NrrdStream(const std::filesystem::path& path, const VolumeGeometry& geometry,
                          bool lacks_patient_axes)
    : file_(std::make_unique<File>(path, headerText(geometry, typeName<T>(), lacks_patient_axes))),
      missing_(geometry.voxelCount()) {}

template <class T>
NrrdStream<T>::~NrrdStream() = default;

template <class T>
void NrrdStream<T>::append(std::span<const T> values) {
    missing_ -= values.size();
    file_->write(std::as_bytes(values));
}

template <class T>
void NrrdStream<T>::close() {
    file_->close(missing_ == 0);
}

template class NrrdStream<uint8_t>;
template class NrrdStream<int16_t>;
template class NrrdStream<uint16_t>;
template class NrrdStream<float>;

void writeNrrd(const std::filesystem::path& path, const VoxelVolume& volume) {
    const Eigen::Vector3i& n = volume.dims();
    NrrdStream<Density> file(path, volume.geometry());
    std::vector<Density> row(size_t(n.x()));
    for (int k = 0; k < n.z(); ++k)
        for (int j = 0; j < n.y(); ++j) {
            for (int i = 0; i < n.x(); ++i) row[size_t(i)] = volume.at(i, j, k);
            file.append(row);
        }
    file.close();
}

}  // namespace bonemill
