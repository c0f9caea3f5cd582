// The readers of a build with BONEMILL_WITH_SCANS: all formats.
#include <algorithm>
#include <cctype>

#include "common/base/user_error.h"
#include "haptic_server/scans/archive/unpack_archive.h"
#include "haptic_server/scans/archive/unpacked_scan.h"
#include "haptic_server/scans/dicom/dicom_folder.h"
#include "haptic_server/scans/formats/volume_file.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scans/import/packed_scan.h"

namespace bonemill {
namespace {

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

bool isFolder(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_directory(path, error);
}

}  // namespace

RawVolume readVolume(const std::filesystem::path& path, const ImportOptions& options) {
    const DicomWish wish{options.series_uid, options.acquisition, {}};
    const bool is_folder = isFolder(path);
    if (is_folder && isImageStack(path)) return importImageStack(path, options.spacing_mm);
    if (is_folder) refuseOtherPictures(path);
    const std::string name = lowerCase(path.filename().string());
    if (!is_folder && (name.ends_with(".nrrd") || name.ends_with(".nhdr")))
        return importNrrd(path, options.spacing_mm);
    if (!is_folder && (name.ends_with(".mha") || name.ends_with(".mhd")))
        return importMetaImage(path, options.spacing_mm);
    if (options.spacing_mm)
        throw UserError(path.string() +
                        ": says the voxels' size itself, or has none; leave volume.spacing_mm out");
    if (is_folder) return importDicomFolder(path, wish);
    if (name.ends_with(".nii") || name.ends_with(".nii.gz")) return importNifti(path);
    if (name.ends_with(".inv3")) return importInv3(path);
    if (isDicomDirectory(path)) return importDicomDirectory(path, wish);
    if (name.ends_with(".dcm") || isDicom(path)) return importDicomFile(path, wish);
    if (name.ends_with(".stl") || name.ends_with(".ply"))
        return importSurface(path, options.surface_voxel_mm, options.surface_value);
    throw UserError(
        path.string() +
        ": is of no known type; give a folder with a DICOM series or PNG or TIFF images, or a file "
        ".nrrd, .nhdr, .nii, .nii.gz, .mha, .mhd, .inv3, .dcm, .stl or .ply, or a .zip or .tar of them");
}

std::vector<std::string> readSeries(const std::filesystem::path& path) {
    if (!isFolder(path) && !isDicomDirectory(path) && !isDicom(path))
        throw UserError(path.string() + ": is no DICOM file; give a folder with DICOM series");
    return listDicomSeries(path);
}

bool isPacked(const std::filesystem::path& path) {
    return isArchive(path);
}

void sendPackedAsChild(int pipe, const std::filesystem::path& path) {
    sendArchiveAsChild(pipe, path);
}

void readUnpacked(const std::filesystem::path& path, const StartReader& start, const ReadUnpacked& read) {
    const UnpackedScan scan(path, start);
    try {
        read(scan.path(), [&](const std::string& text) { return scan.named(text); });
    } catch (const UserError& error) {
        throw UserError(scan.named(error.what()));
    }
}

}  // namespace bonemill
