#include "haptic_server/scans/dicom/series_table.h"

#include <algorithm>
#include <utility>

#include "common/text/printed_text.h"
#include "haptic_server/scans/dicom/dicom_series.h"

namespace bonemill {
namespace {

constexpr size_t kMaxRows = 1000, kMaxProblems = 8;
constexpr size_t kLongestCell = 64, kLongestLine = 600;  // a damaged header may claim to have any text

using Row = std::array<std::string, kSeriesColumns.size()>;

std::string shortened(std::string text, size_t most) {
    text = printable(std::move(text));
    return text.size() > most ? text.substr(0, most - 3) + "..." : text;
}

std::string cell(const std::string& text) {
    return text.empty() ? "-" : shortened(text, kLongestCell);
}

std::string voxelOf(const DicomStack& stack) {
    const Eigen::Vector2d& pixel_mm = stack.slices.front().pixel_spacing_mm;
    const std::string z = stack.slice_spacing_mm > 0 ? printed("%.4g", stack.slice_spacing_mm) : "?";
    return printed("%.4g x %.4g x ", pixel_mm.x(), pixel_mm.y()) + z;
}

void add(std::string& remark, const std::string& text) {
    remark += (remark.empty() || text.empty() ? "" : "; ") + text;
}

std::string remarkOf(const DicomStack& stack) {
    std::string remark = stack.problem.empty() ? "" : "cannot be used: " + stack.problem;
    if (stack.problem.empty() && isScout(stack)) add(remark, "scout");
    add(remark, stack.remark);
    if (!stack.told_by.empty()) add(remark, "told from stacks that overlap it by " + stack.told_by);
    return remark.empty() ? "-" : shortened(remark, kLongestLine);
}

Row rowOf(const DicomStack& stack) {
    const DicomSlice& first = stack.slices.front();
    return {cell(first.series_uid),
            cell(stack.name),
            cell(first.modality),
            cell(first.series_description),
            cell(first.traits.kernel),
            cell(first.contrast),
            std::to_string(stack.slices.size()),
            std::to_string(first.columns) + "x" + std::to_string(first.rows),
            voxelOf(stack),
            remarkOf(stack)};
}

// Columns begin below each other; the last one has no end.
std::vector<std::string> aligned(const std::vector<Row>& rows) {
    std::vector<std::string> lines(rows.size());
    for (size_t column = 0; column < kSeriesColumns.size(); ++column) {
        size_t width = 0;
        for (const Row& row : rows) width = std::max(width, row[column].size());
        for (size_t r = 0; r < rows.size(); ++r) {
            lines[r] += rows[r][column];
            if (column + 1 < kSeriesColumns.size())
                lines[r] += std::string(width + 2 - rows[r][column].size(), ' ');
        }
    }
    return lines;
}

void recommend(const std::vector<DicomStack>& stacks, std::vector<std::string>& lines) {
    const BoneRecommendation best = recommendForBone(stacks);
    if (!best.stack) {
        lines.push_back("recommended for bone: none, for no stack here is a scan that can be used");
        return;
    }
    const std::string &uid = best.stack->slices.front().series_uid, &name = best.stack->name;
    lines.push_back("recommended for bone: " + titleOf(*best.stack) + ": " + best.why);
    lines.push_back("to take it: volume { series_uid: " + sceneText(uid) +
                    (name.empty() ? "" : " acquisition: " + sceneText(name)) + " } in a scene, --series " +
                    quoted(uid) + (name.empty() ? "" : " --acquisition " + quoted(name)) + " for make-case");
}

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

std::vector<std::string> seriesTable(const std::vector<DicomStack>& stacks, const SeriesTableNotes& notes) {
    std::vector<Row> rows(1);
    std::ranges::copy(kSeriesColumns, rows.front().begin());
    for (size_t s = 0; s < std::min(stacks.size(), kMaxRows); ++s) rows.push_back(rowOf(stacks[s]));
    std::vector<std::string> lines = aligned(rows);
    if (stacks.size() > kMaxRows)
        lines.push_back("and " + std::to_string(stacks.size() - kMaxRows) + " more");
    recommend(stacks, lines);
    for (size_t n = 0; n < std::min(notes.damaged.size(), kMaxProblems); ++n)
        lines.push_back("cannot be read: " + notes.damaged[n].problem);
    if (notes.damaged.size() > kMaxProblems)
        lines.push_back("cannot be read: " + std::to_string(notes.damaged.size() - kMaxProblems) + " more");
    if (!notes.left_out.empty()) lines.push_back("files left out: " + notes.left_out);
    for (std::string& line : lines) line = shortened(line, 2 * kLongestLine);
    return lines;
}

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
