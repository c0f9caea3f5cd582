// Checks a MetaImage header before the MetaIO library trusts its numbers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace bonemill {

struct MetaImageHeader {
    std::string data_file;  // empty: attached (LOCAL); a list of files or a pattern stays as it is written
    bool is_compressed = false;
    uint64_t packed_bytes = 0;       // of the compressed voxels; 0: not stated
    bool has_spacing = false;        // says something of the voxels' size
    bool has_patient_space = false;  // AnatomicalOrientation names the patient's sides
    uint64_t bytes = 0;              // length of the header; attached data begin here
};

// Throws UserError naming the file when it is no three-dimensional MetaImage.
MetaImageHeader readMetaImageHeader(const std::filesystem::path& path);

}  // namespace bonemill
