#include "haptic_server/cases/phantom_dicom/dicom_series_writer.h"

#include <cmath>
#include <cstdint>
#include <cstdio>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "haptic_server/cases/phantom_dicom/dicom_slice_writer.h"

namespace bonemill {
namespace {

uint64_t fnv1a(const std::string& text, uint64_t hash) {
    for (const unsigned char c : text) hash = (hash ^ c) * 0x100000001b3u;
    return hash;
}

using Tags = std::vector<std::pair<std::string, std::string>>;

// All files of the series share this, with a fixed date, so that equal phantoms are equal files.
Tags seriesTags(const CtSeriesText& text, double slice_spacing_mm) {
    char spacing[32];
    std::snprintf(spacing, sizeof spacing, "%.10g", slice_spacing_mm);
    return {{"0008|0008", "ORIGINAL\\PRIMARY\\AXIAL"},
            {"0008|0016", "1.2.840.10008.5.1.4.1.1.2"},  // CT Image Storage
            {"0008|0020", "20120101"},
            {"0008|0030", "120000"},
            {"0008|0060", "CT"},
            {"0008|0070", "bonemill"},
            {"0008|103e", text.series_description},
            {"0010|0010", text.patient_name},
            {"0010|0020", "PHANTOM"},
            {"0018|0050", spacing},
            {"0018|0060", "80"},
            {"0018|5100", "HFS"},
            {"0020|000d", uidFromText(text.uid_seed + " study")},
            {"0020|000e", uidFromText(text.uid_seed + " series")},
            {"0020|0010", "1"},
            {"0020|0011", "1"},
            {"0020|0052", uidFromText(text.uid_seed + " frame of reference")},
            {"0028|1050", "1000"},
            {"0028|1051", "4000"},
            {"0028|1052", "0"},
            {"0028|1053", "1"},
            {"0028|1054", "HU"}};
}

std::vector<int16_t> sliceValues(const RawVolume& volume, int k) {
    const size_t size = size_t(volume.geometry.dims.x()) * size_t(volume.geometry.dims.y());
    std::vector<int16_t> values;
    values.reserve(size);
    for (size_t n = 0; n < size; ++n) {
        const float hu = volume.values[size * size_t(k) + n];
        if (!(hu >= -32768 && hu <= 32767)) throw UserError("a CT series holds whole HU within 16 bit only");
        values.push_back(int16_t(std::lround(hu)));
    }
    return values;
}

}  // namespace

std::string uidFromText(const std::string& text) {
    // It follows RFC 9562 version 8 (own hash), variant 1, written as one decimal number (ITU-T X.667).
    const uint64_t high = (fnv1a(text, 0xcbf29ce484222325u) & ~uint64_t(0xf000)) | 0x8000;
    const uint64_t low = (fnv1a(text, 0x9ae16a3b2f90404fu) & 0x3fffffffffffffffu) | 0x8000000000000000u;
    unsigned __int128 number = static_cast<unsigned __int128>(high) << 64 | low;
    std::string digits;
    for (; number > 0; number /= 10) digits += char('0' + int(number % 10));
    return "2.25." + std::string(digits.rbegin(), digits.rend());
}

void writeCtSeries(const std::filesystem::path& folder, const RawVolume& volume, const CtSeriesText& text) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw UserError("cannot make the folder " + folder.string() + ": " + error.message());
    const VolumeGeometry& geometry = volume.geometry;
    const Eigen::Matrix3d R_WV = geometry.X_WV.rotation.toRotationMatrix();
    CtSlice slice;
    slice.columns = geometry.dims.x();
    slice.rows = geometry.dims.y();
    for (int a = 0; a < 3; ++a) {
        slice.spacing_mm[size_t(a)] = geometry.spacing[a] * kPerMillimetre;
        for (int row = 0; row < 3; ++row) slice.axis[size_t(a)][size_t(row)] = R_WV(row, a);
    }
    const Tags shared = seriesTags(text, slice.spacing_mm[2]);
    for (int k = 0; k < geometry.dims.z(); ++k) {
        const Eigen::Vector3d p_mm =
            geometry.X_WV * Eigen::Vector3d(0, 0, k * geometry.spacing.z()) * kPerMillimetre;
        slice.position_mm = {p_mm.x(), p_mm.y(), p_mm.z()};
        const std::vector<int16_t> values = sliceValues(volume, k);
        slice.hu = values;
        slice.tags = shared;
        slice.tags.emplace_back("0008|0018", uidFromText(text.uid_seed + " image " + std::to_string(k)));
        slice.tags.emplace_back("0020|0013", std::to_string(k + 1));
        char name[32];
        std::snprintf(name, sizeof name, "slice_%04d.dcm", k + 1);
        writeCtSlice(folder / name, slice);
    }
}

}  // namespace bonemill
