// Our own reading of a NRRD header: what ITK does not tell of it (units, where the data are, our exact
// geometry) or tells wrongly (nrrd_place.h), and what a reader without ITK needs
// (scans/import/plain_nrrd.cpp).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"
#include "haptic_server/scans/nrrd/nrrd_segments.h"

namespace bonemill {

// As the file says it, unchecked; absent fields are empty.
struct NrrdFields {
    std::string type, endian, space, space_units, axis_units;
    std::string sizes, space_directions, space_origin, spacings, kinds, axis_mins, axis_maxs, centers;
    bool has_skip = false;  // data begin later than right behind the header
};

struct NrrdHeader {
    uint64_t bytes = 0;                            // length of the header; attached data begin here
    std::string encoding;                          // "raw", "gzip", "ascii", ...
    std::string data_file;                         // empty: attached
    double mm_per_unit = 1;                        // from "space units", else from "units" of the axes
    bool has_spacing = false;                      // says something of the voxels' size
    std::optional<VolumeGeometry> exact_geometry;  // from nrrd_writer.h
    NrrdSegments segments;                         // of a label map
    NrrdFields fields;
};

// Reads at most 1 MiB. Throws UserError when it is no NRRD file, or its units or directions are not lengths,
// or its units differ from axis to axis, or it states a field twice.
NrrdHeader readNrrdHeader(const std::filesystem::path& path);

inline constexpr const char* kNrrdGeometryKey = "bonemill geometry";

// The text is "nx ny nz sx sy sz px py pz qw qx qy qz": voxels, then hexadecimal floats in m.
std::string geometryToText(const VolumeGeometry& geometry);
// Nothing when that is no geometry, such as one with a spacing that is not above 0.
std::optional<VolumeGeometry> geometryFromText(const std::string& text);

// Are these the same voxels at the same places, within the rounding of decimal text?
bool isSameGeometry(const VolumeGeometry& a, const VolumeGeometry& b);

// The numbers of a field; the brackets and commas of vectors part them, too, and what is no number counts as
// 0.
std::vector<double> numbersIn(std::string text);

// For any header of text at the start of a file that may be endless: one line of it could fill the memory.
// These are the file's first bytes, `most` of them where it has as many; none when it cannot be read.
std::string firstBytes(const std::filesystem::path& path, size_t most);

// The text without blanks and the carriage return of a line around it.
std::string trimmed(const std::string& text);

}  // namespace bonemill
