// Reads a scanned volume from any format we accept; the one entrance for files of bone.
//
//   folder                DICOM series (how one is chosen, ordered and checked: docs/reference/volumes.md)
//   .nrrd .nhdr           NRRD, attached or detached, raw/gzip/text, either byte order
//   .nii .nii.gz          NIfTI-1
//   .mha .mhd             MetaImage
//   .inv3                 InVesalius project
//   .dcm, any DICOM file  a multi-frame file; of a single slice its series, of a DICOMDIR its folder
//   folder                PNG or TIFF images, one of each slice
//   .stl .ply             closed surface
//   .zip .tar .tar.gz     archive of one of these but the last (docs/reference/volumes.md#archives)
//   .tgz .tar.xz
//
// Lengths in m, world frame W = LPS of the file (x to the patient's left, y back, z up). Start-up
// only: allocates, and starts a process that reads (guarded_import.h); not RT-safe, not for two threads at
// once.
//
// The reader may be a program of its own: haptic_server starts itself once more for it. A child that is
// forked while other threads run may only call what is safe in a signal handler: a lock that another thread
// held stays locked in it for ever. A process that is spawned begins anew, and the kernel copies no page
// table of locked memory for it, which the tick would feel.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

struct ImportOptions {
    std::string series_uid = {};   // which DICOM series of the folder; empty: by rule (dicom_series.h)
    std::string acquisition = {};  // which of its stacks, as listSeries() names them; empty: by rule
    std::optional<double> surface_voxel_mm = {};     // of a surface's voxels; default: its longest edge / 128
    double surface_value = 1000;                     // of voxels inside of a surface
    std::optional<Eigen::Vector3d> spacing_mm = {};  // of voxels whose file or folder does not say it
};

// Throws UserError with one message: what is wrong, in which file, what to do.
RawVolume importVolume(const std::filesystem::path& path, const ImportOptions& options = {});

// Does the same in this process, but for archives: for debuggers and sanitizers. A damaged DICOM file may
// abort it.
RawVolume importVolumeHere(const std::filesystem::path& path, const ImportOptions& options = {});

// A table of the DICOM stacks in a folder, and which of them to take for bone: printable lines. Throws
// UserError.
std::vector<std::string> listSeries(const std::filesystem::path& path);
std::vector<std::string> listSeriesHere(const std::filesystem::path& path);

// Runs the reader's own end if the words of the command line call it, and does not return then.
void runReaderIfCalled(int argc, char** argv);

// From now on importVolume() and listSeries() start this program as a reader: `haptic_server`'s main says it
// first of all.
void setReaderProgram(const std::string& program);

// What reads volumes in this build, for the reader's process: every_reader.cpp, or nrrd_reader.cpp where it
// has no readers of scans. The file or folder is there. Both throw UserError with one message that names it.
RawVolume readVolume(const std::filesystem::path& path, const ImportOptions& options);
std::vector<std::string> readSeries(const std::filesystem::path& path);

// NRRD without ITK, for builds that have none: attached, three axes, one number per voxel, raw or gzip.
// `spacing_mm` is the voxels' size, for a file that does not say it; others are refused with it. Throws
// UserError with one message that names the file: it is damaged, or of a kind that needs ITK.
RawVolume readPlainNrrd(const std::filesystem::path& path, const std::optional<Eigen::Vector3d>& spacing_mm);

}  // namespace bonemill
