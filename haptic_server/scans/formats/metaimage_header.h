// Our own reading of a MetaImage header: what the library does not tell of it, or passes over.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "haptic_server/scans/frame/physical_frame.h"

namespace bonemill {

struct MetaImageHeader {
    uint64_t bytes = 0;     // length of the header; attached data begin here
    std::string data_file;  // empty: attached (LOCAL)
    bool is_compressed = false;
    uint64_t packed_bytes = 0;  // of the compressed voxels
    bool has_spacing = false;   // says something of the voxels' size; else it is 1 mm
    FilePlace place;            // the patient's where AnatomicalOrientation names the patient's sides
};

// Reads at most 64 KiB. Throws UserError naming the file when it is no three-dimensional MetaImage, when it
// says in two ways where its voxels lie, or of a kind that the library reads otherwise than it is meant:
// voxels as text, behind another header, in several files, or to be scaled.
MetaImageHeader readMetaImageHeader(const std::filesystem::path& path);

}  // namespace bonemill
