// The table of a folder's DICOM stacks (series_table.h), read again: which stacks there are to choose from.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace bonemill {

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

}  // namespace bonemill
