// Reads the lines of a NRRD header in which 3D Slicer describes the segments of a label map (.seg.nrrd).
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "haptic_server/core/volume/raw_values.h"
#include "haptic_server/core/volume/segments.h"

namespace bonemill {

struct NrrdSegment {
    std::string name;
    std::optional<Eigen::Vector3d> color;
    std::optional<uint32_t> value;  // of its voxels in its layer
    std::optional<uint32_t> layer;
};

// By their number in the file.
using NrrdSegments = std::map<uint32_t, NrrdSegment>;

// Takes "Segment<number>_<field>" with its value, and leaves all other keys alone. Throws UserError.
void takeSegmentLine(const std::string& key, const std::string& value, const std::filesystem::path& path,
                     NrrdSegments& segments);

// `values` has one number of each of `layers` layers per voxel, layers fastest. A single layer stays as it
// is; several become one, where each combination of segments has a number of its own, and 0 stands for none.
// Throws UserError naming `file` when names are missing or too long, or there are too many combinations.
Segments joinLayers(const NrrdSegments& segments, uint32_t layers, RawValues& values,
                    const std::string& file);

}  // namespace bonemill
