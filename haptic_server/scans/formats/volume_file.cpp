#include "haptic_server/scans/formats/volume_file.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/confined/shared_name.h"
#include "haptic_server/scans/formats/metaimage_header.h"
#include "haptic_server/scans/formats/nifti_header.h"
#include "haptic_server/scans/formats/nifti_values.h"
#include "haptic_server/scans/formats/stored_bytes.h"
#include "haptic_server/scans/frame/physical_frame.h"
#include "haptic_server/scans/nrrd/nrrd_header.h"
#include "haptic_server/scans/nrrd/nrrd_place.h"
#include "haptic_server/scans/pixels/itk_image_file.h"

namespace bonemill {
namespace {

struct FileFacts {
    std::string format;
    StoredData data;
    std::function<FilePlace()> place;  // asked once the library took the file's axes for what they are
    bool has_spacing = true;           // libraries take 1 mm where it is not said
    bool has_other_data = false;       // beside its voxels, where the header says so
    NrrdSegments segments = {};
    std::optional<Eigen::Vector3d> spacing_mm = {};  // what the scene says of it
};

// Axes of one voxel beyond the third do not make it less of a volume.
std::vector<uint64_t> volumeDims(std::vector<uint64_t> dims) {
    while (dims.size() > 3 && dims.back() == 1) dims.pop_back();
    return dims;
}

std::string segmentRemark(const Segments& segments) {
    if (segments.list.empty()) return {};
    return ", " + std::to_string(segments.list.size()) + " segments" +
           (segments.are_layered ? " in layers" : "");
}

std::string descriptionOf(const std::string& format, bool is_flipped, const std::string& remark) {
    return format + (is_flipped ? ", left-handed: third axis reversed" : "") +
           (remark.empty() ? "" : ", " + remark);
}

// One byte may make their count even, or end a line. Of packed ones no more than the first few are counted.
std::string surplusRemark(const StoredData& data, uint64_t found, uint64_t needed) {
    if (data.packing == StoredData::Packing::kOther || found <= needed + 1) return {};
    const bool is_plain = data.packing == StoredData::Packing::kPlain;
    return "; " + data.file.filename().string() + " holds " +
           (is_plain ? std::to_string(found - needed) + " bytes more" : "more bytes") +
           " than the header's sizes need (" + std::to_string(needed) +
           "), which were not read: are they right?";
}

// Checks that the library took the same axes for those of space.
FilePlace placeOf(const FileFacts& facts, const std::vector<uint64_t>& dims, const std::string& file) {
    FilePlace place = facts.place();
    for (int a = 0; a < 3; ++a)
        if (uint64_t(place.frame.dims[a]) != dims[size_t(a)])
            throw UserError(
                file +
                ": it is not clear which of its axes are those of space; write one volume in three "
                "dimensions");
    if (facts.spacing_mm) place.frame.spacing_mm = *facts.spacing_mm;
    return place;
}

RawVolume readThrough(ItkFormat format, const std::filesystem::path& path, const FileFacts& facts) {
    const std::string file = path.string();
    requireFile(facts.data.file);  // The library opens it with the header.
    ItkImageFile image(format, path);
    const ItkImageHeader& header = image.header();
    if (header.components != 1 && (facts.segments.empty() || header.components > kMaxSegments))
        throw UserError(file + ": has " + std::to_string(header.components) +
                        " values per voxel (colour or vectors); one number per voxel is needed");
    const std::vector<uint64_t> dims = volumeDims(header.dims);
    const uint64_t layers = header.components;
    checkVolumeSize(dims, layers * header.bytes_per_voxel, file);
    requireOneSpacing(facts.has_spacing, facts.spacing_mm.has_value(),
                      format == ItkFormat::kNrrd ? "spacings or space directions" : "ElementSpacing = X Y Z",
                      file);
    if (facts.spacing_mm) checkSpacing(*facts.spacing_mm, file);
    const FilePlace place = placeOf(facts, dims, file);
    const uint64_t voxels = dims[0] * dims[1] * dims[2];
    const uint64_t needed = layers * voxels * header.bytes_per_voxel;
    const uint64_t found = countStoredBytes(facts.data, needed);
    checkStoredBytes(needed, found, file);
    RawVolume raw;
    raw.values.reserve(size_t(layers * voxels));
    image.appendValues(raw.values);
    if (!facts.segments.empty())
        raw.segments = joinLayers(facts.segments, uint32_t(layers), raw.values, file);
    const bool flipped = makeRightHanded(place.frame, file, raw.geometry, raw.values);
    raw.lacks_patient_axes = !place.is_patients;
    raw.description = descriptionOf(facts.format, flipped, {}) + segmentRemark(raw.segments) +
                      (facts.has_other_data ? "" : surplusRemark(facts.data, found, needed));
    return raw;
}

using Packing = StoredData::Packing;

}  // namespace

RawVolume importNrrd(const std::filesystem::path& path, const std::optional<Eigen::Vector3d>& spacing_mm) {
    const NrrdHeader header = readNrrdHeader(path);
    if (namesSeveralFiles(header.data_file))
        throw UserError(path.string() + ": spreads its voxels over several files (data file: " +
                        header.data_file + "); write them into one");
    checkNrrdSpace(header, path.string());  // before the library, which says it less clearly
    FileFacts facts{.format = "NRRD",
                    .data = StoredData{path, header.bytes},
                    .place = [&] { return nrrdPlaceOf(header, path.string()); },
                    .has_spacing = header.has_spacing,
                    .has_other_data = header.fields.has_skip,
                    .segments = header.segments,
                    .spacing_mm = spacing_mm};
    if (!header.data_file.empty()) facts.data = StoredData{path.parent_path() / header.data_file};
    // ITK's NRRD library finds short gzip data itself.
    if (header.encoding != "raw") facts.data.packing = Packing::kOther;
    RawVolume raw = readThrough(ItkFormat::kNrrd, path, facts);
    if (header.exact_geometry && isSameGeometry(*header.exact_geometry, raw.geometry))
        raw.geometry = *header.exact_geometry;
    return raw;
}

RawVolume importNifti(const std::filesystem::path& path) {
    const std::string file = path.string();
    noteFileBeingRead(path);
    const NiftiHeader header = readNiftiHeader(path);
    const uint64_t voxel_bytes = niftiVoxelBytes(header, path);
    const std::vector<uint64_t> dims = volumeDims(header.dims);
    checkVolumeSize(dims, std::min<uint64_t>(voxel_bytes, sizeof(float)), file);
    NiftiValues read = readNiftiValues(path, header);
    RawVolume raw;
    raw.values = std::move(read.values);
    const bool flipped = makeRightHanded(header.place.frame, file, raw.geometry, raw.values);
    raw.lacks_patient_axes = !header.place.is_patients;
    StoredData data{path};
    if (read.is_packed) data.packing = Packing::kDeflate;
    const uint64_t needed = voxel_bytes * dims[0] * dims[1] * dims[2];
    raw.description =
        descriptionOf("NIfTI", flipped, header.remark) + surplusRemark(data, needed + read.surplus, needed);
    return raw;
}

RawVolume importMetaImage(const std::filesystem::path& path,
                          const std::optional<Eigen::Vector3d>& spacing_mm) {
    const MetaImageHeader header = readMetaImageHeader(path);
    FileFacts facts{.format = "MetaImage",
                    .data = StoredData{path, header.bytes},
                    .place = [&] { return header.place; },
                    .has_spacing = header.has_spacing,
                    .spacing_mm = spacing_mm};
    if (!header.data_file.empty()) facts.data = StoredData{path.parent_path() / header.data_file};
    if (header.is_compressed) {
        checkStoredBytes(header.packed_bytes, countStoredBytes(facts.data, header.packed_bytes),
                         path.string());
        facts.data.packing = Packing::kDeflate;
        facts.data.packed_bytes = header.packed_bytes;
    }
    return readThrough(ItkFormat::kMetaImage, path, facts);
}

}  // namespace bonemill
