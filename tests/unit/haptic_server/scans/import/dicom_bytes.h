// Writes DICOM files byte by byte (explicit VR little endian), so that any mistake can be put into one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace bonemill {

struct DicomImage {
    std::string series_uid = "1.2.3.4";
    std::string sop_uid = "1.2.3.4.1";
    std::string modality = "CT";
    // None of these is written when it is empty.
    std::string series_description, kernel, contrast, image_type;
    std::string acquisition_number, temporal_position, acquisition_time, content_time;
    std::string patient_id, space_uid;
    std::vector<double> b_value;       // one
    std::string sop_class;             // empty: CT, Enhanced CT or Secondary Capture, as the rest says
    std::string position = "0\\0\\0";  // empty: no Image Position
    std::string orientation = "1\\0\\0\\0\\1\\0";
    std::string pixel_spacing = "0.5\\0.5";  // row spacing first, as DICOM has it; empty: none
    std::string photometric = "MONOCHROME2";
    int rows = 4;
    int columns = 5;
    int samples_per_pixel = 1;
    int bits = 16;                  // of a value
    int allocated = 0, high = 0;    // of its word, and its highest bit there; 0: as the value is alone
    std::optional<bool> is_signed;  // nothing: all but those of 8 bit
    std::string elements;           // others of group 0028 up to (0028,0fff), as bytes
    std::string last_elements;      // others from (0028,1050) on, instead of a rescale
    bool has_rescale = true;
    double slope = 1;
    double intercept = 0;
    std::vector<int16_t> pixels;  // stored values; 8-bit files keep their low bytes
    std::string pixel_bytes;      // not empty: these instead
    std::string transfer_syntax = "1.2.840.10008.1.2.1";
    std::vector<std::string> fragments;  // not empty: compressed pixels, instead
    bool has_pixels = true;
    std::string frame_count;                   // empty: as many as have positions
    std::vector<std::string> frame_positions;  // not empty: an enhanced multi-frame file
    std::vector<int> frame_phases;             // temporal position of each frame; empty: none says it
    std::string shared_groups;                 // other functional groups of all frames, as bytes
    std::string shared_rescale;                // of all frames, as below
    std::vector<std::string> frame_rescales;   // slope|intercept of each frame; empty: none says its own
};

// Returns preamble, meta header and data set.
std::string dicomBytes(const DicomImage& image);
void writeDicomFile(const std::filesystem::path& path, const DicomImage& image);

}  // namespace bonemill
