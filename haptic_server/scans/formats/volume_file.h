// Reads what is no DICOM: NRRD and MetaImage through ITK, NIfTI, InVesalius projects, bone that is given as
// its closed surface, and folders of pictures, one of each slice, as micro-CT scanners and ImageJ write them.
// All throw UserError with one message that names the file.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// `spacing_mm` is the voxels' size, for files that do not say it; others are refused with it.
RawVolume importNrrd(const std::filesystem::path& path,
                     const std::optional<Eigen::Vector3d>& spacing_mm = {});
RawVolume importNifti(const std::filesystem::path& path);
RawVolume importMetaImage(const std::filesystem::path& path,
                          const std::optional<Eigen::Vector3d>& spacing_mm = {});

// An InVesalius 3 project (.inv3) is a compressed tar archive of main.plist and the matrix file it names.
//
// The plist's shape counts slices, rows, columns (docs/reference/volumes.md); spacing is given column, row,
// slice in mm; columns run to the patient's left, slices upwards, and InVesalius stores the rows from back to
// front (it flips the rows of each DICOM slice), so they are reversed here. The project keeps no origin: W
// has its origin at the centre of voxel (0, 0, 0).
RawVolume importInv3(const std::filesystem::path& path);

// A closed surface, such as a segmented bone that was saved as STL or PLY, in mm, LPS unless its head says
// SPACE=RAS as 3D Slicer writes it. Voxels are cubes of `voxel_mm`, by default 1/128 of the longest edge;
// they have `inside` in the bone and 0 outside, and surface_ramp.h between. A mesh is refused that is not
// closed or contradicts itself, and one of too many voxels.
RawVolume importSurface(const std::filesystem::path& path, std::optional<double> voxel_mm, double inside);

// Are most of the folder's files PNG or TIFF? Hidden ones do not count.
bool isImageStack(const std::filesystem::path& folder);

// Throws UserError where most of them are JPEG, BMP or other pictures that lose values or are seldom grey.
void refuseOtherPictures(const std::filesystem::path& folder);

// Grey pictures of 8 or 16 bit, all of one size, in the natural order of their names (slice_names.h), which
// leave no number out: columns go along x, rows along y, slices along z. `spacing_mm` is the voxels' size,
// which pictures do not say. Throws UserError.
RawVolume importImageStack(const std::filesystem::path& folder,
                           const std::optional<Eigen::Vector3d>& spacing_mm);

// Throws UserError unless all three are lengths above 0 that voxels can have.
void checkSpacing(const Eigen::Vector3d& spacing_mm, const std::string& file);

}  // namespace bonemill
