// Walks through the elements of a DICOM file without believing any length, before GDCM reads it.
//
// GDCM allocates what an element's length says (up to 4 GiB) and then finds the file too short; and a folder
// of a study also holds files that are no images. This scan reads tags and lengths only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace bonemill {

enum class DicomKind {
    kNotDicom,  // neither "DICM" at byte 128 nor a data set that starts like one
    kNoImage,   // DICOM without pixel data: DICOMDIR, report, plan
    kImage,     // holds pixel data, or cannot be told (deflated, or odd coding that GDCM may know)
    kCutShort,  // an element claims more bytes than the file has left
};

// What was drawn on a scan is no scan.
enum class DicomDrawing {
    kNone,
    kSegmentation,  // SEG, which dicom_segments.h reads
    kOther          // surfaces, label maps of frames, contours (RTSTRUCT)
};

struct DicomScan {
    DicomKind kind = DicomKind::kNotDicom;
    std::string problem;      // for people, with kCutShort
    std::string media_class;  // UID of what the file is, where its first lines say it
    DicomDrawing drawing = DicomDrawing::kNone;
    std::string series_uid;                    // empty: nothing before the file's end or its damage says it
    std::optional<uint64_t> pixel_bytes = {};  // of Pixel Data that is not compressed
};

// Throws UserError when the file cannot be opened.
DicomScan scanDicomFile(const std::filesystem::path& path);

}  // namespace bonemill
