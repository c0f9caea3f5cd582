#include "haptic_server/scans/dicom/dicom_headers.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>

#include "common/base/user_error.h"
#include "common/process/work_ahead.h"
#include "common/text/printed_text.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/dicom/dicom_file.h"
#include "haptic_server/scans/dicom/dicom_groups.h"
#include "haptic_server/scans/dicom/dicom_pixels.h"
#include "haptic_server/scans/dicom/dicom_scan.h"
#include "haptic_server/scans/dicom/dicom_slice.h"
#include "haptic_server/scans/dicom/real_world_scale.h"
#include "haptic_server/scans/pixels/dicom_rescale.h"
#include "haptic_server/scans/pixels/itk_image_file.h"

namespace bonemill {
namespace {

const gdcm::Tag kValueTransformation(0x0028, 0x9145);
const gdcm::Tag kRealWorldMapping(0x0040, 0x9096);
const gdcm::Tag kFrameContent(0x0020, 0x9111);
const gdcm::Tag kMrDiffusion(0x0018, 0x9117);
const gdcm::Tag kCtReconstruction(0x0018, 0x9314);
const gdcm::Tag kCtFrameType(0x0018, 0x9329);
const gdcm::Tag kMrFrameType(0x0018, 0x9226);

// Of an element whose value is one number of this type, as text.
template <class Number>
std::string numberText(const FunctionalGroups& groups, size_t frame, const gdcm::Tag& group,
                       const gdcm::Tag& element) {
    const auto number = groups.number<Number>(frame, group, element);
    return number ? printed("%.10g", double(*number)) : std::string();
}

DicomTraits readTraits(const FunctionalGroups& groups, size_t frame) {
    DicomTraits traits;
    traits.acquisition_number = numberText<uint16_t>(groups, frame, kFrameContent, gdcm::Tag(0x0020, 0x9156));
    traits.temporal_position = numberText<uint32_t>(groups, frame, kFrameContent, gdcm::Tag(0x0020, 0x9128));
    traits.b_value = numberText<double>(groups, frame, kMrDiffusion, gdcm::Tag(0x0018, 0x9087));
    traits.kernel = groups.text(frame, kCtReconstruction, gdcm::Tag(0x0018, 0x1210));
    for (const gdcm::Tag& frame_type : {kCtFrameType, kMrFrameType})
        if (traits.image_type.empty())
            traits.image_type = groups.text(frame, frame_type, gdcm::Tag(0x0008, 0x9007));
    traits.acquisition_time = groups.text(frame, kFrameContent, gdcm::Tag(0x0018, 0x9074));
    return traits;
}

// What stands outside of the functional groups is the place of a file's only picture.
DicomPlaceTexts placeTextsOf(const DicomFile& image, const FunctionalGroups& groups, size_t frame) {
    DicomPlaceTexts texts = groups.placeTexts(frame);
    if (image.layout().frames > 1) return texts;
    if (texts.position.empty()) texts.position = image.dicomTag("0020|0032");
    if (texts.orientation.empty()) texts.orientation = image.dicomTag("0020|0037");
    if (texts.pixel_spacing.empty()) texts.pixel_spacing = image.dicomTag("0028|0030");
    return texts;
}

// What a frame says goes before what its file does, and a rescale before a mapping.
std::optional<DicomRescale> rescaleOf(const DicomFile& image, const FunctionalGroups& groups, size_t frame,
                                      const std::string& name) {
    const auto of_frame =
        rescaleFromTexts(groups.text(frame, kValueTransformation, gdcm::Tag(0x0028, 0x1053)),
                         groups.text(frame, kValueTransformation, gdcm::Tag(0x0028, 0x1052)), name);
    if (of_frame) return of_frame;
    const auto of_file =
        rescaleFromTexts(image.dicomTag("0028|1053"), image.dicomTag("0028|1052"), image.name());
    if (of_file) return of_file;
    const DicomItems mappings = groups.items(frame, kRealWorldMapping);
    return realWorldScale(mappings ? mappings : itemsOf(image.data(), kRealWorldMapping), name);
}

constexpr int kMaxEdge = 16384;  // detectors of today have 4096; more is a damaged header

DicomTraits traitsOf(const DicomFile& image) {
    const auto text = [&](const char* tag) { return image.dicomTag(tag); };
    const auto b_value = numberOf<double>(bytesOf(image.data(), gdcm::Tag(0x0018, 0x9087)));
    return {.acquisition_number = text("0020|0012"),
            .temporal_position = text("0020|0100"),
            .b_value = b_value ? printed("%.10g", *b_value) : "",
            .kernel = text("0018|1210"),
            .image_type = text("0008|0008"),
            .acquisition_time = text("0008|0032"),
            .content_time = text("0008|0033")};
}

// All images of one file have this in common.
DicomSlice headerOf(const DicomFile& image, const std::filesystem::path& path) {
    const DicomPixelLayout& layout = image.layout();
    DicomSlice slice;
    slice.path = path;
    slice.series_uid = image.dicomTag("0020|000e");
    slice.series_description = image.dicomTag("0008|103e");
    slice.modality = image.dicomTag("0008|0060");
    slice.patient = image.dicomTag("0010|0020") + '\n' + image.dicomTag("0010|0010");
    slice.space_uid = image.dicomTag("0020|0052");
    slice.traits = traitsOf(image);
    slice.contrast = image.dicomTag("0018|0010");
    const auto isEdge = [](int pixels) { return pixels >= 1 && pixels <= kMaxEdge; };
    if (!isEdge(layout.columns) || !isEdge(layout.rows))
        throw UserError(path.string() + ": claims an image of absurd size; the header is damaged");
    slice.columns = layout.columns;
    slice.rows = layout.rows;
    return slice;
}

// What a frame says goes before what its file does.
void takeTraits(const DicomTraits& of_frame, DicomTraits& traits) {
    for (const auto trait :
         {&DicomTraits::acquisition_number, &DicomTraits::temporal_position, &DicomTraits::b_value,
          &DicomTraits::kernel, &DicomTraits::image_type, &DicomTraits::acquisition_time})
        if (!(of_frame.*trait).empty()) traits.*trait = of_frame.*trait;
}

void checkFrameCount(const FunctionalGroups& groups, const DicomFile& image) {
    const size_t described = groups.frameCount(), frames = image.layout().frames;
    if (described > 0 && described != frames)
        throw UserError(image.name() + ": describes " + std::to_string(described) +
                        " frames, but its Number of Frames is " + std::to_string(frames) +
                        "; export it anew");
}

// Empty: the file says for each of its pictures where it lies.
std::string whyNowhere(const DicomFile& image, const FunctionalGroups& groups) {
    if (image.layout().frames == 1) {
        const DicomPlaceTexts texts = placeTextsOf(image, groups, 0);
        const bool is_somewhere = !texts.position.empty() && !texts.orientation.empty();
        return is_somewhere ? "" : "images without a position in the patient";
    }
    for (size_t f = 0; f < image.layout().frames; ++f)
        if (!groups.placeTexts(f).areComplete())
            return "multi-frame images that do not say where each frame lies";
    return {};
}

// Throws UserError naming file and frame when what it says is no place or no scale.
std::vector<DicomSlice> slicesOf(const DicomFile& image, const FunctionalGroups& groups,
                                 const DicomSlice& common) {
    const size_t frames = image.layout().frames;
    const double most_rounding = groups.frameCount() > 0 ? kThreeDigits : kTwoDigits;
    std::vector<DicomSlice> slices(frames, common);
    for (size_t f = 0; f < frames; ++f) {
        const std::string name = image.name() + (frames > 1 ? " frame " + std::to_string(f + 1) : "");
        slices[f].frame = int(f);
        static_cast<DicomPlace&>(slices[f]) =
            placeFromTexts(placeTextsOf(image, groups, f), most_rounding, name);
        slices[f].rescale = rescaleOf(image, groups, f, name);
        takeTraits(readTraits(groups, f), slices[f].traits);
    }
    return slices;
}

// Empty: its values are grey. MONOCHROME1 and 2 differ in how they are to be shown.
std::string whyNotGrey(const DicomFile& image) {
    if (image.layout().samples_per_pixel != 1) return "colour images (several values per pixel)";
    const std::string photometric = image.dicomTag("0028|0004");
    if (photometric.starts_with("PALETTE"))
        return "colour images (values are numbers of a palette's colours)";
    const std::string presentation = image.dicomTag("0008|9205");
    if (presentation == "COLOR" || presentation == "MIXED")
        return "colour images (some values are numbers of a palette's colours)";
    if (photometric.empty() || photometric.starts_with("MONOCHROME")) return {};
    return "colour images (of a photometric interpretation that is not grey)";
}

// Reads the slices of one file, or none and the reason: the file cannot belong to a volume.
std::vector<DicomSlice> readHeader(const std::filesystem::path& path, const DicomScan& scan,
                                   LeftOut& left_out) {
    const DicomFile image(path);
    if (const std::string reason = whyNotGrey(image); !reason.empty()) {
        left_out.add(reason, path);
        return {};
    }
    const FunctionalGroups groups(image.data());
    checkFrameCount(groups, image);
    if (const std::string reason = whyNowhere(image, groups); !reason.empty()) {
        left_out.add(reason, path);
        return {};
    }
    const DicomSlice common = headerOf(image, path);
    checkPixels(image, scan.pixel_bytes);
    return slicesOf(image, groups, common);
}

std::string reasonToLeaveOut(const DicomScan& scan) {
    if (scan.kind == DicomKind::kNotDicom) return "files that are not DICOM";
    if (scan.drawing == DicomDrawing::kNone) return "DICOM files without an image";
    if (scan.drawing == DicomDrawing::kSegmentation)
        return "DICOM segmentations (SEG), each of which is a label map: give its file by name "
               "(volume.label_path, make-case --labels)";
    return "DICOM contours, surfaces or label maps (RTSTRUCT and others), which 3D Slicer loads and exports "
           "as .seg.nrrd or NIfTI";
}

std::vector<DicomSlice> slicesOfScanned(const std::filesystem::path& path, const DicomScan& scan,
                                        LeftOut& left_out) {
    if (scan.kind == DicomKind::kCutShort)
        throw UserError(path.string() + ": the DICOM file is cut short or damaged: " + scan.problem);
    if (scan.kind == DicomKind::kImage && scan.drawing == DicomDrawing::kNone)
        return readHeader(path, scan, left_out);
    left_out.add(reasonToLeaveOut(scan), path);
    return {};
}

}  // namespace

void LeftOut::add(const std::string& reason, const std::filesystem::path& file) {
    add({reason, file.filename().string(), 1});
}

void LeftOut::add(const LeftOut& more) {
    for (const Entry& entry : more.entries_) add(entry);
}

void LeftOut::add(const Entry& entry) {
    const auto same = std::ranges::find(entries_, entry.reason, &Entry::reason);
    if (same == entries_.end()) return entries_.push_back(entry);
    same->count += entry.count;
}

std::string LeftOut::text() const {
    std::string text;
    for (const Entry& entry : entries_)
        text += (text.empty() ? "" : ", ") + std::to_string(entry.count) + " " + entry.reason + " (" +
                entry.example + (entry.count > 1 ? ", ...)" : ")");
    return text;
}

std::vector<DicomSlice> slicesOfFile(const std::filesystem::path& path, LeftOut& left_out) {
    return slicesOfScanned(path, scanDicomFile(path), left_out);
}

DicomFiles readDicomFiles(const std::vector<std::filesystem::path>& files) {
    uint64_t bytes = 0;
    for (const auto& file : files) bytes = std::max(bytes, mostMemoryToRead(file, 0));
    const MemoryCap cap(memoryForAll(bytes, bytes));
    DicomFiles all;
    workAhead(
        files,
        [&](const std::filesystem::path& file) {
            DicomFiles of_file;
            DicomScan scan;
            try {
                scan = scanDicomFile(file);
                of_file.slices = slicesOfScanned(file, scan, of_file.left_out);
            } catch (const UserError& error) {
                of_file.damaged.push_back({file, error.what(), scan.series_uid});
            }
            return of_file;
        },
        [&](const std::filesystem::path&, DicomFiles of_file) {
            all.left_out.add(of_file.left_out);
            std::ranges::move(of_file.slices, std::back_inserter(all.slices));
            std::ranges::move(of_file.damaged, std::back_inserter(all.damaged));
        });
    return all;
}

// Links to folders are not followed, for they may lead in circles.
std::vector<std::filesystem::path> filesOf(const std::filesystem::path& folder, Subfolders subfolders,
                                           LeftOut& left_out) {
    std::vector<std::filesystem::path> files, others;
    std::error_code error, unreadable;
    for (std::filesystem::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        if (subfolders == Subfolders::kNo) entry.disable_recursion_pending();
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

}  // namespace bonemill
