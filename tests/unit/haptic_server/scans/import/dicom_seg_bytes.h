// Writes DICOM segmentations byte by byte, so that any mistake can be put into one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace bonemill {

struct DicomSegmentation {
    struct Item {
        std::optional<int> number;
        std::string label;
        std::vector<int> lab = {};  // three, as stored; none: no colour
    };
    struct Frame {
        std::optional<int> segment;
        std::string position;          // empty: it is not said
        std::vector<uint8_t> values;   // of each pixel, 0 and 1 where it is BINARY
        std::string orientation = {};  // empty: that of all frames
    };

    std::string type = "BINARY", sop_class = "1.2.840.10008.5.1.4.1.1.66.4";
    std::string transfer_syntax = "1.2.840.10008.1.2.1";
    std::string character_set = {};  // empty: it is not said
    int rows = 3, columns = 4;
    std::string orientation = "1\\0\\0\\0\\1\\0", pixel_spacing = "1\\1";
    std::string spacing_between = {}, thickness = {};  // empty: it is not said
    std::optional<int> most_fraction = {};
    std::optional<int> bits = {};         // not given: as the type asks
    std::optional<int> frames_said = {};  // not given: as many as there are
    size_t missing_bytes = 0;             // of the pixels
    bool has_pixels = true;
    std::vector<Item> segments;
    std::vector<Frame> frames;
};

std::string dicomSegBytes(const DicomSegmentation& file);
void writeDicomSeg(const std::filesystem::path& path, const DicomSegmentation& file);

}  // namespace bonemill
