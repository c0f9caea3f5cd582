// Walks through the elements of a DICOM file without believing any length, before GDCM reads it.
//
// GDCM allocates what an element's length says (up to 4 GiB) and then finds the file too short; and a folder
// of a study also holds files that are no images. This scan reads tags and lengths only.
#pragma once

#include <filesystem>
#include <string>

namespace bonemill {

enum class DicomKind {
    kNotDicom,  // neither "DICM" at byte 128 nor a data set that starts like one
    kNoImage,   // DICOM without pixel data: DICOMDIR, report, plan
    kImage,     // holds pixel data, or cannot be told (deflated, or odd coding that GDCM may know)
    kCutShort,  // an element claims more bytes than the file has left
};

struct DicomScan {
    DicomKind kind = DicomKind::kNotDicom;
    std::string problem;            // for people, with kCutShort
    std::string media_class;        // UID of what the file is, where its first lines say it
    bool holds_structures = false;  // what was drawn on a scan (SEG, RTSTRUCT), and no scan
};

// Throws UserError when the file cannot be opened.
DicomScan scanDicomFile(const std::filesystem::path& path);

}  // namespace bonemill
