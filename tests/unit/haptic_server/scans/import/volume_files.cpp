#include "tests/unit/haptic_server/scans/import/volume_files.h"

#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <set>
#include <stdexcept>

#include "tests/unit/haptic_server/scans/import/deflated_bytes.h"

namespace bonemill {
namespace {

std::string samplesAsBytes(const std::vector<int16_t>& values, bool is_big_endian) {
    std::string bytes;
    for (const int16_t v : values) {
        const char low = char(v & 0xff), high = char(v >> 8 & 0xff);
        bytes += is_big_endian ? high : low;
        bytes += is_big_endian ? low : high;
    }
    return bytes;
}

std::string vectorText(const Eigen::Vector3d& v, const char* format) {
    char text[128];
    std::snprintf(text, sizeof text, format, v.x(), v.y(), v.z());
    return text;
}

std::string dimsText(const Eigen::Vector3i& n) {
    return std::to_string(n.x()) + " " + std::to_string(n.y()) + " " + std::to_string(n.z());
}

}  // namespace

std::vector<int16_t> SampleVolume::values() const {
    std::vector<int16_t> values;
    for (int k = 0; k < dims.z(); ++k)
        for (int j = 0; j < dims.y(); ++j)
            for (int i = 0; i < dims.x(); ++i) values.push_back(int16_t(i + 10 * j + 100 * k));
    return values;
}

Eigen::Vector3d SampleVolume::place(double value) const {
    const int v = int(std::lround(value));
    const Eigen::Vector3d index(v % 10, v / 10 % 10, v / 100);
    return (origin_mm + directions * spacing_mm.cwiseProduct(index)) / 1000;
}

void expectSamePlaces(const RawVolume& raw, const SampleVolume& sample, double tolerance) {
    if (raw.values.size() != raw.geometry.voxelCount())
        throw std::runtime_error("values do not fill the volume");
    std::set<float> seen;
    size_t next = 0;
    for (int k = 0; k < raw.geometry.dims.z(); ++k)
        for (int j = 0; j < raw.geometry.dims.y(); ++j)
            for (int i = 0; i < raw.geometry.dims.x(); ++i) {
                const float value = raw.values[next++];
                seen.insert(value);
                const Eigen::Vector3d p_W =
                    raw.geometry.X_WV * raw.geometry.spacing.cwiseProduct(Eigen::Vector3d(i, j, k));
                if (!((p_W - sample.place(value)).norm() < tolerance))
                    throw std::runtime_error("sample " + std::to_string(value) + " lies at the wrong place");
            }
    if (seen.size() != size_t(sample.dims.prod())) throw std::runtime_error("samples are missing");
}

void writeNrrdFile(const std::filesystem::path& path, const SampleVolume& sample, const Storage& storage,
                   const std::string& space) {
    std::string bytes = samplesAsBytes(sample.values(), storage.is_big_endian);
    if (storage.is_compressed) bytes = deflated(bytes, DeflateHead::kGzip);
    std::string header = "NRRD0004\n# made by a test\ntype: short\ndimension: 3\nspace: " + space +
                         "\nsizes: " + dimsText(sample.dims) + "\nspace directions:";
    for (int a = 0; a < 3; ++a)
        header += ' ' + vectorText(sample.directions.col(a) * sample.spacing_mm[a], "(%.17g,%.17g,%.17g)");
    header += "\nspace origin: " + vectorText(sample.origin_mm, "(%.17g,%.17g,%.17g)");
    header += std::string("\nendian: ") + (storage.is_big_endian ? "big" : "little");
    header += std::string("\nencoding: ") + (storage.is_compressed ? "gzip" : "raw") + "\n";
    if (!storage.is_detached) return writeBytes(path, header + "\n" + bytes);
    const std::string data_name = path.stem().string() + ".raw";
    writeBytes(path, header + "data file: " + data_name + "\n");
    writeBytes(path.parent_path() / data_name, bytes);
}

void writeNiftiFile(const std::filesystem::path& path, const SampleVolume& sample, const Storage& storage) {
    std::string header(352, '\0');
    const auto put = [&](size_t offset, auto value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        if (storage.is_big_endian) std::reverse(raw, raw + sizeof value);
        std::memcpy(header.data() + offset, raw, sizeof value);
    };
    put(0, int32_t(348));
    put(40, int16_t(3));
    for (int a = 0; a < 4; ++a) put(42 + 2 * size_t(a), int16_t(a < 3 ? sample.dims[a] : 1));
    put(70, int16_t(4));  // DT_INT16
    put(72, int16_t(16));
    put(76, 1.0f);
    for (int a = 0; a < 3; ++a) put(80 + 4 * size_t(a), float(sample.spacing_mm[a]));
    put(108, 352.0f);
    put(112, 1.0f);        // scl_slope
    header[123] = 2;       // mm
    put(254, int16_t(1));  // sform: scanner coordinates
    for (int row = 0; row < 3; ++row) {
        const double sign = row < 2 ? -1 : 1;  // NIfTI is RAS
        for (int a = 0; a < 3; ++a)
            put(280 + 16 * size_t(row) + 4 * size_t(a),
                float(sign * sample.directions(row, a) * sample.spacing_mm[a]));
        put(292 + 16 * size_t(row), float(sign * sample.origin_mm[row]));
    }
    std::memcpy(header.data() + 344, "n+1", 4);
    const std::string bytes = header + samplesAsBytes(sample.values(), storage.is_big_endian);
    writeBytes(path, storage.is_compressed ? deflated(bytes, DeflateHead::kGzip) : bytes);
}

void writeMetaImageFile(const std::filesystem::path& path, const SampleVolume& sample,
                        const Storage& storage) {
    std::string bytes = samplesAsBytes(sample.values(), storage.is_big_endian);
    if (storage.is_compressed) bytes = deflated(bytes, DeflateHead::kZlib);
    std::string header = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = ";
    header += storage.is_big_endian ? "True" : "False";
    if (storage.is_compressed)
        header += "\nCompressedData = True\nCompressedDataSize = " + std::to_string(bytes.size());
    header += "\nTransformMatrix =";
    for (int a = 0; a < 3; ++a) header += ' ' + vectorText(sample.directions.col(a), "%.17g %.17g %.17g");
    header += "\nOffset = " + vectorText(sample.origin_mm, "%.17g %.17g %.17g");
    header += "\nElementSpacing = " + vectorText(sample.spacing_mm, "%.17g %.17g %.17g");
    header += "\nDimSize = " + dimsText(sample.dims) + "\nElementType = MET_SHORT\nElementDataFile = ";
    if (!storage.is_detached) return writeBytes(path, header + "LOCAL\n" + bytes);
    const std::string data_name = path.stem().string() + (storage.is_compressed ? ".zraw" : ".raw");
    writeBytes(path, header + data_name + "\n");
    writeBytes(path.parent_path() / data_name, bytes);
}

void writeInv3File(const std::filesystem::path& path, const SampleVolume& sample, const Inv3Text& text) {
    const auto& n = sample.dims;
    std::vector<int16_t> values;
    const std::vector<int16_t> all = sample.values();
    for (int k = 0; k < n.z(); ++k)
        for (int j = n.y() - 1; j >= 0; --j)
            for (int i = 0; i < n.x(); ++i) values.push_back(all[size_t(i + n.x() * (j + n.y() * k))]);
    std::string matrix = samplesAsBytes(values, false);
    matrix.resize(matrix.size() - size_t(text.missing_bytes));
    const auto integer = [](int v) { return std::string("<integer>") + std::to_string(v) + "</integer>"; };
    const auto real = [](double v) { return std::string("<real>") + std::to_string(v) + "</real>"; };
    const std::string plist =
        "<?xml version=\"1.0\"?>\n<!DOCTYPE plist PUBLIC \"x\" \"y\">\n<plist version=\"1.0\"><dict>"
        "<key>matrix</key><dict><key>dtype</key><string>" +
        text.dtype + "</string><key>filename</key><string>matrix.dat</string><key>shape</key><array>" +
        integer(n.z()) + integer(n.y()) + integer(n.x()) + "</array></dict><key>modality</key><string>" +
        text.modality + "</string><key>name</key><string>made by a test</string><key>spacing</key><array>" +
        real(sample.spacing_mm.x()) + real(sample.spacing_mm.y()) + real(sample.spacing_mm.z()) +
        "</array><key>window_level</key><real>100</real><key>window_width</key><real>400</real></dict></"
        "plist>";
    archive* writer = archive_write_new();
    archive_write_add_filter_gzip(writer);
    archive_write_set_format_gnutar(writer);
    archive_write_open_filename(writer, path.c_str());
    const std::pair<const char*, const std::string*> files[] = {{"project/matrix.dat", &matrix},
                                                                {"project/main.plist", &plist}};
    for (const auto& [name, bytes] : files) {
        archive_entry* entry = archive_entry_new();
        archive_entry_set_pathname(entry, name);
        archive_entry_set_size(entry, la_int64_t(bytes->size()));
        archive_entry_set_filetype(entry, AE_IFREG);
        archive_entry_set_perm(entry, 0644);
        archive_write_header(writer, entry);
        archive_write_data(writer, bytes->data(), bytes->size());
        archive_entry_free(entry);
    }
    archive_write_free(writer);
}

void writeBytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(bytes.data(), std::streamsize(bytes.size()));
    if (!file) throw std::runtime_error("cannot write " + path.string());
}

std::string readBytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("no " + from + " to replace");
    return text.replace(at, from.size(), to);
}

}  // namespace bonemill
