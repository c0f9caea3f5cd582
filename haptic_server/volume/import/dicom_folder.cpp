#include "haptic_server/volume/import/dicom_folder.h"

#include <algorithm>
#include <cmath>

#include "common/user_error.h"
#include "haptic_server/volume/import/dicom_frames.h"
#include "haptic_server/volume/import/dicom_scan.h"
#include "haptic_server/volume/import/dicom_series.h"
#include "haptic_server/volume/import/import_limits.h"
#include "haptic_server/volume/import/itk_image_file.h"
#include "haptic_server/volume/import/physical_frame.h"

namespace bonemill {
namespace {

constexpr size_t kMaxEdge = 16384;  // detectors of today have 4096; more is a damaged header

// Counts files that are left out on purpose, by reason, with one example each.
class LeftOut {
  public:
    void add(const std::string& reason, const std::filesystem::path& file) {
        for (Entry& entry : entries_)
            if (entry.reason == reason) return void(++entry.count);
        entries_.push_back({reason, file.filename().string(), 1});
    }
    std::string text() const {
        std::string text;
        for (const Entry& entry : entries_)
            text += (text.empty() ? "" : ", ") + std::to_string(entry.count) + " " + entry.reason + " (" +
                    entry.example + (entry.count > 1 ? ", ...)" : ")");
        return text;
    }

  private:
    struct Entry {
        std::string reason, example;
        int count;
    };
    std::vector<Entry> entries_;
};

// All images of one file have this in common.
DicomSlice headerOf(const ItkImageFile& image, const std::filesystem::path& path) {
    const ItkImageHeader& header = image.header();
    DicomSlice slice;
    slice.path = path;
    slice.series_uid = image.dicomTag("0020|000e");
    slice.series_description = image.dicomTag("0008|103e");
    slice.modality = image.dicomTag("0008|0060");
    slice.kernel = image.dicomTag("0018|1210");
    slice.contrast = image.dicomTag("0018|0010");
    if (header.dims.size() < 2 || header.dims[0] > kMaxEdge || header.dims[1] > kMaxEdge)
        throw UserError(path.string() + ": claims an image of absurd size; the header is damaged");
    slice.columns = int(header.dims[0]);
    slice.rows = int(header.dims[1]);
    slice.rescale = rescaleFromTexts(image.dicomTag("0028|1053"), image.dicomTag("0028|1052"), path.string());
    return slice;
}

void putAt(const DicomPlace& place, DicomSlice& slice) {
    slice.position_mm = place.position_mm;
    slice.row_direction = place.row_direction;
    slice.column_direction = place.column_direction;
    slice.pixel_spacing_mm = place.pixel_spacing_mm;
    slice.axes_rounding = place.rounding;
}

// Frames of which only some say their scale would not be alike.
void checkRescales(const std::vector<DicomFrame>& frames, const DicomSlice& common) {
    if (common.rescale) return;
    const auto says = [](const DicomFrame& frame) { return frame.rescale.has_value(); };
    const auto silent = std::ranges::find_if_not(frames, says);
    if (silent != frames.end() && std::ranges::any_of(frames, says))
        throw UserError(common.path.string() + " frame " + std::to_string(silent - frames.begin() + 1) +
                        ": does not state its Rescale Slope and Intercept, other frames do; export it anew");
}

std::vector<DicomSlice> slicesOf(const std::vector<DicomFrame>& frames, const DicomSlice& common) {
    checkRescales(frames, common);
    std::vector<DicomSlice> slices(frames.size(), common);
    for (size_t f = 0; f < frames.size(); ++f) {
        slices[f].frame = int(f);
        putAt(frames[f].place, slices[f]);
        if (frames[f].rescale) slices[f].rescale = frames[f].rescale;
    }
    return slices;
}

// Reads the slices of one file, or none and the reason: the file cannot belong to a volume.
std::vector<DicomSlice> readHeader(const std::filesystem::path& path, LeftOut& left_out) {
    const ItkImageFile image(ItkFormat::kDicom, path);
    const size_t frames = image.header().dims.size() > 2 ? size_t(image.header().dims[2]) : 1;
    if (image.header().components != 1 || image.dicomTag("0028|0004").rfind("PALETTE", 0) == 0) {
        left_out.add("colour images (RGB or palette)", path);
        return {};
    }
    if (frames == 1 && (image.dicomTag("0020|0032").empty() || image.dicomTag("0020|0037").empty())) {
        left_out.add("images without a position in the patient", path);
        return {};
    }
    DicomSlice slice = headerOf(image, path);
    if (frames == 1) {
        putAt(placeFromTexts(
                  {image.dicomTag("0020|0032"), image.dicomTag("0020|0037"), image.dicomTag("0028|0030")},
                  kTwoDigits, path.string()),
              slice);
        return {slice};
    }
    const std::vector<DicomFrame> places = readFrames(path);
    if (places.size() != frames) {
        left_out.add("multi-frame images that do not say where each frame lies", path);
        return {};
    }
    return slicesOf(places, slice);
}

std::vector<DicomSlice> leaveStructuresOut(const std::filesystem::path& path, LeftOut& left_out) {
    left_out.add(
        "DICOM segmentations or contours (SEG, RTSTRUCT), which 3D Slicer loads and exports as .seg.nrrd or "
        "NIfTI",
        path);
    return {};
}

// Damage must not pass as "not an image": the volume would silently lose a slice.
std::vector<DicomSlice> inspect(const std::filesystem::path& path, LeftOut& left_out) {
    const DicomScan scan = scanDicomFile(path);
    switch (scan.kind) {
        case DicomKind::kNotDicom:
            left_out.add("files that are not DICOM", path);
            return {};
        case DicomKind::kNoImage:
            if (scan.holds_structures) return leaveStructuresOut(path, left_out);
            left_out.add("DICOM files without an image", path);
            return {};
        case DicomKind::kCutShort:
            throw UserError(path.string() + ": the DICOM file is cut short or damaged: " + scan.problem);
        case DicomKind::kImage:
            if (scan.holds_structures) return leaveStructuresOut(path, left_out);
            break;
    }
    return readHeader(path, left_out);
}

void readSlices(const std::vector<DicomSlice>& slices, RawValues& values) {
    std::filesystem::path read_path;
    RawValues pixels;
    DicomRescale applied;
    for (const DicomSlice& slice : slices) {
        if (slice.path != read_path) {
            pixels = {};
            ItkImageFile image(ItkFormat::kDicom, slice.path);
            image.appendValues(pixels);
            applied = image.appliedRescale();
            read_path = slice.path;
        }
        const size_t size = size_t(slice.columns) * size_t(slice.rows), begin = size * size_t(slice.frame);
        if (pixels.size() % size != 0 || pixels.size() < begin + size)
            throw UserError(slice.path.string() +
                            ": holds fewer pixels than its header says; the file is damaged");
        const bool is_scaled = pixels.visit([&](auto samples) {
            return appendRescaled(samples.subspan(begin, size), applied, slice.rescale.value_or(applied),
                                  values);
        });
        if (!is_scaled)
            throw UserError(slice.path.string() +
                            ": its frames are scaled too differently to be read; export it anew");
        pixels.forget(begin, begin + size);
    }
}

// Air is negative on no other scale.
bool reachesAir(const RawValues& values) {
    return values.range().low <= -500;
}

bool isSamePicture(const DicomSlice& a, const DicomSlice& b) {
    if (a.frame != 0 || b.frame != 0) return false;
    RawValues of_a, of_b;
    readSlices({a}, of_a);
    readSlices({b}, of_b);
    return of_a == of_b;
}

// What a reader of the scan asks first.
std::string describe(const DicomStack& stack) {
    const DicomSlice& first = stack.slices.front();
    std::string text = "DICOM series " + first.series_uid;
    if (!first.series_description.empty()) text += " (" + first.series_description + ")";
    if (!first.modality.empty()) text += ", " + first.modality;
    if (!first.kernel.empty()) text += ", kernel " + first.kernel;
    if (!first.contrast.empty()) text += ", contrast " + first.contrast;
    text += ", " + std::to_string(stack.slices.size()) + " slices";
    if (!stack.remark.empty()) text += "; " + stack.remark;
    if (!stack.left_out.empty()) text += "; other series left out: " + stack.left_out;
    return text;
}

RawVolume readStack(const DicomStack& stack, const std::string& name) {
    const DicomSlice& first = stack.slices.front();
    const size_t depth = stack.slices.size();
    constexpr uint64_t kPixelBytes = 4;  // a multi-frame file is read as a whole
    checkVolumeSize({uint64_t(first.columns), uint64_t(first.rows), depth}, kPixelBytes, name);
    RawVolume raw;
    raw.values.reserve(size_t(first.columns) * size_t(first.rows) * depth);
    readSlices(stack.slices, raw.values);
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
    raw.is_hounsfield = first.isCt() && reachesAir(raw.values);
    raw.description = describe(stack);
    return raw;
}

// Links to folders are not followed, for they may lead in circles.
std::vector<std::filesystem::path> filesOf(const std::filesystem::path& folder, LeftOut& left_out) {
    std::vector<std::filesystem::path> files, others;
    std::error_code error, unreadable;
    for (std::filesystem::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        if (entry->is_regular_file(unreadable))
            files.push_back(entry->path());
        else if (entry->is_symlink(unreadable) || !entry->is_directory(unreadable))
            others.push_back(entry->path());
    }
    if (error) throw UserError("cannot list the folder " + folder.string() + ": " + error.message());
    std::sort(files.begin(), files.end());  // the same messages and choices on every file system
    std::sort(others.begin(), others.end());
    for (const auto& other : others) left_out.add("links or devices that are no files", other);
    return files;
}

}  // namespace

RawVolume importDicomFolder(const std::filesystem::path& folder, const std::string& series_uid) {
    LeftOut left_out;
    const auto files = filesOf(folder, left_out);
    if (files.empty()) throw UserError(folder.string() + ": the folder is empty; a DICOM series is needed");
    std::vector<DicomSlice> slices;
    for (const auto& file : files)
        for (const DicomSlice& slice : inspect(file, left_out)) slices.push_back(slice);
    if (slices.empty())
        throw UserError(folder.string() + ": holds no DICOM slice that can be used: " + left_out.text());
    RawVolume raw =
        readStack(chooseStack(slices, series_uid, folder.string(), isSamePicture), folder.string());
    if (!left_out.text().empty()) raw.description += "; files left out: " + left_out.text();
    return raw;
}

RawVolume importDicomFile(const std::filesystem::path& file) {
    LeftOut left_out;
    const auto slices = inspect(file, left_out);
    if (slices.empty()) throw UserError(file.string() + ": cannot be used: " + left_out.text());
    return readStack(chooseStack(slices, {}, file.string(), isSamePicture), file.string());
}

}  // namespace bonemill
