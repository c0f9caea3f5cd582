#include "haptic_server/scans/dicom/series_rows.h"

#include "common/text/printed_text.h"

namespace bonemill {
namespace {

using Starts = std::array<size_t, kSeriesColumns.size()>;

bool findColumns(const std::string& head, Starts& starts) {
    size_t from = 0;
    for (size_t column = 0; column < starts.size(); ++column) {
        starts[column] = head.find(kSeriesColumns[column], from);
        if (starts[column] == std::string::npos) return false;
        from = starts[column] + std::string(kSeriesColumns[column]).size();
    }
    return starts[0] == 0;
}

std::string cellAt(const std::string& line, const Starts& starts, size_t column) {
    if (starts[column] >= line.size()) return "-";
    const size_t end = column + 1 < starts.size() ? starts[column + 1] : line.size();
    const std::string cell = line.substr(starts[column], end - starts[column]);
    return cell.substr(0, cell.find_last_not_of(' ') + 1);
}

SeriesRow rowAt(const std::string& line, const Starts& starts) {
    const auto cell = [&](size_t column) { return cellAt(line, starts, column); };
    return {cell(0), cell(1), cell(2), cell(3), cell(4), cell(5), cell(6), cell(7), cell(8), cell(9)};
}

// As the table says how to take one.
bool isTakenBy(const std::string& line, const SeriesRow& row) {
    const bool is_named = line.find(" acquisition: ") != std::string::npos;
    if (line.find("series_uid: " + sceneText(row.uid)) == std::string::npos) return false;
    return row.acquisition == "-"
               ? !is_named
               : line.find("acquisition: " + sceneText(row.acquisition)) != std::string::npos;
}

}  // namespace

std::vector<SeriesRow> rowsOfTable(const std::vector<std::string>& lines) {
    std::vector<SeriesRow> rows;
    Starts starts{};
    if (lines.empty() || !findColumns(lines[0], starts)) return rows;
    size_t n = 1;
    for (; n < lines.size() && !lines[n].starts_with("recommended for bone:"); ++n)
        if (!lines[n].starts_with("and ")) rows.push_back(rowAt(lines[n], starts));
    for (; n < lines.size(); ++n)
        for (SeriesRow& row : rows)
            if (lines[n].starts_with("to take it:") && isTakenBy(lines[n], row)) row.is_recommended = true;
    return rows;
}

}  // namespace bonemill
