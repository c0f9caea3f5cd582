#include "haptic_server/scans/dicom/dicom_folder.h"

#include <algorithm>
#include <cctype>

#include "common/base/user_error.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/dicom/dicom_headers.h"
#include "haptic_server/scans/dicom/dicom_scan.h"
#include "haptic_server/scans/dicom/dicom_segments.h"
#include "haptic_server/scans/dicom/series_table.h"
#include "haptic_server/scans/dicom/slice_values.h"
#include "haptic_server/scans/frame/physical_frame.h"

namespace bonemill {
namespace {

bool isSamePicture(const DicomSlice& a, const DicomSlice& b) {
    if (a.frame != 0 || b.frame != 0) return false;
    RawValues of_a, of_b;
    readSlices({a}, of_a);
    readSlices({b}, of_b);
    return of_a == of_b;
}

void requireSlices(const DicomFiles& files, const std::filesystem::path& path) {
    if (!files.slices.empty()) return;
    const std::string why = files.damaged.empty() ? files.left_out.text() : files.damaged.front().problem;
    throw UserError(path.string() + ": holds no DICOM slice that can be used: " + why);
}

// What a reader of the scan asks first.
std::string describe(const DicomChoice& choice) {
    const DicomStack& stack = choice.stack;
    const DicomSlice& first = stack.slices.front();
    std::string text = "DICOM " + titleOf(stack);
    if (!first.series_description.empty()) text += " (" + first.series_description + ")";
    if (!first.modality.empty()) text += ", " + first.modality;
    if (!first.traits.kernel.empty()) text += ", kernel " + first.traits.kernel;
    if (!first.contrast.empty()) text += ", contrast " + first.contrast;
    text += ", " + std::to_string(stack.slices.size()) + " slices";
    if (!stack.remark.empty()) text += "; " + stack.remark;
    if (!choice.how_chosen.empty()) text += "; " + choice.how_chosen;
    if (!choice.left_out.empty()) text += "; other series left out: " + choice.left_out;
    if (!choice.damaged.empty()) text += "; damaged files of other series left out: " + choice.damaged;
    return text;
}

RawVolume readChoice(const DicomChoice& choice, const std::string& name) {
    const DicomStack& stack = choice.stack;
    const DicomSlice& first = stack.slices.front();
    const size_t depth = stack.slices.size();
    constexpr uint64_t kPixelBytes = 4;  // a multi-frame file is read as a whole
    checkVolumeSize({uint64_t(first.columns), uint64_t(first.rows), depth}, kPixelBytes, name);
    RawVolume raw;
    raw.values.reserve(size_t(first.columns) * size_t(first.rows) * depth);
    const std::string said = readSlices(stack.slices, raw.values);
    FileFrame frame;
    frame.dims = {first.columns, first.rows, int(depth)};
    frame.spacing_mm = {first.pixel_spacing_mm.x(), first.pixel_spacing_mm.y(), stack.slice_spacing_mm};
    frame.directions << first.row_direction, first.column_direction, first.normal();
    frame.origin_mm = first.position_mm;
    if (!stack.places.empty()) {
        const Eigen::Vector2i size(first.columns, first.rows);
        const SliceGrid grid = gridAround(stack.places, size, first.pixel_spacing_mm, stack.slice_spacing_mm);
        checkVolumeSize({uint64_t(grid.dims.x()), uint64_t(grid.dims.y()), uint64_t(grid.dims.z())},
                        kPixelBytes, name);
        raw.values = resampleStack(raw.values, stack.places, size, grid);
        frame.dims = grid.dims;
        frame.origin_mm +=
            first.row_direction * grid.aside_mm.x() + first.column_direction * grid.aside_mm.y();
    }
    makeRightHanded(frame, name, raw.geometry, raw.values);
    raw.is_hounsfield = first.isCt() && raw.values.range().low <= -500;  // air is negative on no other scale
    raw.description = describe(choice);
    if (!said.empty()) raw.description += "; " + said;
    return raw;
}

// Throws UserError where there is no picture at all.
DicomFiles filesIn(const std::filesystem::path& folder, Subfolders subfolders) {
    LeftOut left_out;
    const auto paths = filesOf(folder, subfolders, left_out);
    if (paths.empty()) throw UserError(folder.string() + ": the folder is empty; a DICOM series is needed");
    DicomFiles files = readDicomFiles(paths);
    left_out.add(files.left_out);
    files.left_out = left_out;
    requireSlices(files, folder);
    return files;
}

RawVolume importFolder(const std::filesystem::path& folder, Subfolders subfolders, const DicomWish& wish) {
    const DicomFiles files = filesIn(folder, subfolders);
    RawVolume raw = readChoice(chooseStack(files.slices, wish, folder.string(), isSamePicture, files.damaged),
                               folder.string());
    if (!files.left_out.text().empty()) raw.description += "; files left out: " + files.left_out.text();
    return raw;
}

std::filesystem::path folderOf(const std::filesystem::path& file) {
    return file.has_parent_path() ? file.parent_path() : ".";
}

// What belongs to a file that is one slice lies beside it: folders below may be anything.
RawVolume importAroundSlice(const std::filesystem::path& file, const DicomSlice& slice, DicomWish wish) {
    if (wish.series_uid.empty()) wish.series_uid = slice.series_uid;
    wish.file = folderOf(file) / file.filename();
    RawVolume raw = importFolder(folderOf(file), Subfolders::kNo, wish);
    raw.description += "; " + file.filename().string() + " is a slice of this series: the folder " +
                       folderOf(file).string() + " was read";
    return raw;
}

std::vector<std::string> tableOf(const DicomFiles& files) {
    return seriesTable(stacksOf(files.slices, isSamePicture, files.damaged),
                       {.left_out = files.left_out.text(), .damaged = files.damaged});
}

}  // namespace

bool isDicomDirectory(const std::filesystem::path& file) {
    constexpr const char* kMediaStorageDirectory = "1.2.840.10008.1.3.10";
    std::string name = file.filename().string();
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    return name == "DICOMDIR" || scanDicomFile(file).media_class == kMediaStorageDirectory;
}

bool isDicom(const std::filesystem::path& file) {
    return scanDicomFile(file).kind != DicomKind::kNotDicom;
}

RawVolume importDicomFolder(const std::filesystem::path& folder, const DicomWish& wish) {
    return importFolder(folder, Subfolders::kYes, wish);
}

RawVolume importDicomDirectory(const std::filesystem::path& file, const DicomWish& wish) {
    RawVolume raw = importDicomFolder(folderOf(file), wish);
    raw.description += "; " + file.filename().string() + " only names files: the folder " +
                       folderOf(file).string() + " was read";
    return raw;
}

RawVolume importDicomFile(const std::filesystem::path& file, const DicomWish& wish) {
    const DicomScan scan = scanDicomFile(file);
    if (scan.drawing == DicomDrawing::kSegmentation && scan.kind != DicomKind::kCutShort)
        return importDicomSegments(file);
    LeftOut left_out;
    const auto slices = slicesOfFile(file, left_out);
    if (slices.empty()) throw UserError(file.string() + ": cannot be used: " + left_out.text());
    if (slices.size() == 1) return importAroundSlice(file, slices.front(), wish);
    return readChoice(chooseStack(slices, wish, file.string(), isSamePicture), file.string());
}

std::vector<std::string> listDicomSeries(const std::filesystem::path& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) return tableOf(filesIn(path, Subfolders::kYes));
    if (isDicomDirectory(path)) return tableOf(filesIn(folderOf(path), Subfolders::kYes));
    const DicomFiles of_file = readDicomFiles({path});
    requireSlices(of_file, path);
    if (of_file.slices.size() > 1) return tableOf(of_file);
    return tableOf(filesIn(folderOf(path), Subfolders::kNo));
}

}  // namespace bonemill
