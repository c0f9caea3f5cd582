#include "haptic_server/volume/import/volume_file.h"

#include "common/config/user_error.h"
#include "haptic_server/volume/import/import_limits.h"
#include "haptic_server/volume/import/itk_image_file.h"
#include "haptic_server/volume/import/meta_image_header.h"
#include "haptic_server/volume/import/nifti_header.h"
#include "haptic_server/volume/import/nrrd_header.h"
#include "haptic_server/volume/import/physical_frame.h"

namespace bonemill {
namespace {

struct FileFacts {
    std::string format;
    double mm_per_unit = 1;
    uint64_t stored_bytes = 0;   // that can hold voxels; 0: not known
    bool may_be_compressed = false;
};

uint64_t sizeOf(const std::filesystem::path& path) {
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    return error ? 0 : uint64_t(size);
}

// Axes of one voxel beyond the third do not make it less of a volume.
std::vector<uint64_t> volumeDims(std::vector<uint64_t> dims) {
    while (dims.size() > 3 && dims.back() == 1) dims.pop_back();
    return dims;
}

FileFrame frameOf(const ItkImageHeader& header, double mm_per_unit) {
    FileFrame frame;
    for (int a = 0; a < 3; ++a) {
        frame.dims[a] = int(header.dims[size_t(a)]);
        frame.spacing_mm[a] = header.spacing[size_t(a)] * mm_per_unit;
        frame.origin_mm[a] = header.origin[size_t(a)] * mm_per_unit;
        frame.directions.col(a) = Eigen::Vector3d(header.axis[size_t(a)].data());
    }
    return frame;
}

RawVolume readThrough(ItkFormat format, const std::filesystem::path& path, const FileFacts& facts) {
    const std::string file = path.string();
    ItkImageFile image(format, path);
    const ItkImageHeader& header = image.header();
    if (header.components != 1)
        throw UserError(file + ": has " + std::to_string(header.components) +
                        " values per voxel (colour or vectors); one number per voxel is needed");
    const std::vector<uint64_t> dims = volumeDims(header.dims);
    checkVolumeSize(dims, header.bytes_per_voxel, file);
    const uint64_t voxels = dims[0] * dims[1] * dims[2];
    if (facts.stored_bytes != 0)
        checkStoredBytes(voxels * header.bytes_per_voxel, facts.stored_bytes, facts.may_be_compressed, file);
    RawVolume raw;
    raw.values.reserve(size_t(voxels));
    image.appendValues(raw.values);
    const bool flipped = makeRightHanded(frameOf(header, facts.mm_per_unit), file, raw.geometry, raw.values);
    raw.description = facts.format + (flipped ? ", left-handed: third axis reversed" : "");
    return raw;
}

}  // namespace

RawVolume importNrrd(const std::filesystem::path& path) {
    const NrrdHeader header = readNrrdHeader(path);
    FileFacts facts{"NRRD", header.mm_per_unit, sizeOf(path), header.encoding != "raw"};
    if (!header.data_file.empty()) facts.stored_bytes = sizeOf(path.parent_path() / header.data_file);
    RawVolume raw = readThrough(ItkFormat::kNrrd, path, facts);
    if (header.exact_geometry && isSameGeometry(*header.exact_geometry, raw.geometry))
        raw.geometry = *header.exact_geometry;
    return raw;
}

RawVolume importNifti(const std::filesystem::path& path) {
    checkNiftiHeader(path);
    return readThrough(ItkFormat::kNifti, path, {"NIfTI", 1, sizeOf(path), path.extension() == ".gz"});
}

RawVolume importMetaImage(const std::filesystem::path& path) {
    const MetaImageHeader header = readMetaImageHeader(path);
    FileFacts facts{"MetaImage", 1, sizeOf(path), header.is_compressed};
    if (!header.data_file.empty()) facts.stored_bytes = sizeOf(path.parent_path() / header.data_file);
    return readThrough(ItkFormat::kMetaImage, path, facts);
}

}  // namespace bonemill
