// Checks a MetaImage header before the MetaIO library trusts its numbers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace bonemill {

struct MetaImageHeader {
    std::string data_file;  // empty: attached (LOCAL)
    bool is_compressed = false;
    uint64_t packed_bytes = 0;  // of the compressed voxels
    double mm_per_unit = 1;
    bool has_spacing = false;        // says something of the voxels' size
    bool has_patient_space = false;  // AnatomicalOrientation names the patient's sides
    uint64_t bytes = 0;              // length of the header; attached data begin here
};

// Reads at most 64 KiB. Throws UserError naming the file when it is no three-dimensional MetaImage, or of a
// kind that the library reads otherwise than it is meant: voxels as text, behind another header, in several
// files, or to be scaled.
MetaImageHeader readMetaImageHeader(const std::filesystem::path& path);

}  // namespace bonemill
