// Writes label maps as 3D Slicer does, byte by byte.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "haptic_server/core/volume/index_box.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {

struct SegmentsFile {
    Eigen::Vector3i dims{4, 3, 2};
    double voxel_mm = 1;
    int layers = 1;
    std::string segments;  // lines of the header
    std::function<int(const Eigen::Vector3i& v, int layer)> label;
};

inline std::string segmentLines(int number, const std::string& name, int label, int layer,
                                const std::string& color = "1 0.5 0") {
    const std::string start = "Segment" + std::to_string(number) + "_";
    return start + "Color:=" + color + "\n" + start + "ID:=Segment_" + std::to_string(number + 1) + "\n" +
           start + "LabelValue:=" + std::to_string(label) + "\n" + start + "Layer:=" + std::to_string(layer) +
           "\n" + start + "Name:=" + name + "\n" + start + "Tags:=Segmentation.Status:inprogress|\n";
}

inline void writeSegNrrd(const std::filesystem::path& path, const SegmentsFile& file) {
    const bool is_layered = file.layers > 1;
    const auto text = [](double n) { return std::to_string(n); };
    const std::string list = is_layered ? "list " : "", none = is_layered ? "none " : "";
    std::string bytes = "NRRD0004\n# Complete NRRD file format specification at:\ntype: unsigned char\n";
    bytes +=
        std::string("dimension: ") + (is_layered ? "4" : "3") + "\nspace: left-posterior-superior\nsizes:";
    if (is_layered) bytes += " " + std::to_string(file.layers);
    for (const int n : file.dims) bytes += " " + std::to_string(n);
    const std::string edge = text(file.voxel_mm);
    bytes += "\nspace directions: " + none + "(" + edge + ",0,0) (0," + edge + ",0) (0,0," + edge +
             ")\nkinds: " + list + "domain domain domain\nencoding: raw\nspace origin: (0,0,0)\n" +
             file.segments + "Segmentation_MasterRepresentation:=Binary labelmap\n\n";
    forEachIndex({Eigen::Vector3i::Zero(), file.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        for (int layer = 0; layer < file.layers; ++layer) bytes += char(file.label(v, layer));
    });
    writeBytes(path, bytes);
}

}  // namespace bonemill
