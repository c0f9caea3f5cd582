// What a folder of DICOM files holds, as a table for people; and that table read again: which stacks there
// are to choose from.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "haptic_server/scans/dicom/dicom_slice.h"

namespace bonemill {

struct DicomStack;

inline constexpr std::array<const char*, 10> kSeriesColumns = {
    "series",   "acquisition", "modality", "description", "kernel",
    "contrast", "slices",      "size",     "voxel mm",    "remark"};

// Each text is that of its column, "-" where the table has none.
struct SeriesRow {
    std::string uid, acquisition, modality, description, kernel, contrast, slices, size, voxel_mm, remark;
    bool is_recommended = false;  // for bone
};

// The rows of listSeries()' lines, in their order. What seriesTable() has not written has no rows.
std::vector<SeriesRow> rowsOfTable(const std::vector<std::string>& lines);

struct SeriesTableNotes {
    std::string left_out;              // files that belong to no stack; empty: none
    std::vector<DamagedFile> damaged;  // files that cannot be read
};

// Lines of printable text: a head, one line of each stack, which is the best for bone and how to choose it,
// and the notes. What a stack's name says is what DicomWish takes.
std::vector<std::string> seriesTable(const std::vector<DicomStack>& stacks, const SeriesTableNotes& notes);

}  // namespace bonemill
