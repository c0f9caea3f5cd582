#include "tests/unit/haptic_server/scans/import/dicom_seg_bytes.h"

#include "tests/unit/haptic_server/scans/import/deflated_bytes.h"
#include "tests/unit/haptic_server/scans/import/dicom_elements.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

using namespace dicom;

std::string textElement(uint32_t tag, const std::string& vr, const std::string& value) {
    return value.empty() ? "" : element(tag, vr, value);
}

std::string segmentItem(const DicomSegmentation::Item& segment) {
    std::string lab;
    for (const int value : segment.lab) lab += number(uint32_t(value), 2);
    return item((segment.number ? shortElement(0x00620004, *segment.number) : "") +
                textElement(0x00620005, "LO", segment.label) + textElement(0x0062000d, "US", lab));
}

std::string orientationGroup(const std::string& orientation) {
    return element(0x00209116, "SQ", item(element(0x00200037, "DS", orientation)));
}

std::string sharedGroups(const DicomSegmentation& file) {
    return orientationGroup(file.orientation) +
           element(0x00289110, "SQ",
                   item(textElement(0x00180050, "DS", file.thickness) +
                        textElement(0x00180088, "DS", file.spacing_between) +
                        element(0x00280030, "DS", file.pixel_spacing)));
}

std::string frameGroups(const DicomSegmentation::Frame& frame) {
    return item(
        (frame.position.empty()
             ? ""
             : element(0x00209113, "SQ", item(element(0x00200032, "DS", frame.position)))) +
        (frame.orientation.empty() ? "" : orientationGroup(frame.orientation)) +
        (frame.segment ? element(0x0062000a, "SQ", item(shortElement(0x0062000b, *frame.segment))) : ""));
}

// Frames follow each other without a gap, in bits too; the first pixel is the lowest bit.
std::string framePixels(const DicomSegmentation& file, int bits) {
    std::string bytes;
    size_t bit = 0;
    for (const DicomSegmentation::Frame& frame : file.frames)
        for (const uint8_t value : frame.values) {
            if (bits != 1) {
                bytes += char(value);
                continue;
            }
            if (bit % 8 == 0) bytes += '\0';
            bytes.back() |= char(value << bit++ % 8);
        }
    bytes.resize(bytes.size() - std::min(bytes.size(), file.missing_bytes));
    return bytes;
}

}  // namespace

std::string dicomSegBytes(const DicomSegmentation& file) {
    const int bits = file.bits.value_or(file.type == "FRACTIONAL" ? 8 : 1);
    std::string segments, frames;
    for (const auto& segment : file.segments) segments += segmentItem(segment);
    for (const auto& frame : file.frames) frames += frameGroups(frame);
    const std::string data =
        textElement(0x00080005, "CS", file.character_set) + element(0x00080016, "UI", file.sop_class) +
        element(0x00080018, "UI", "1.2.3.4.9") + element(0x00080060, "CS", "SEG") +
        element(0x0020000d, "UI", "1.2.3") + element(0x0020000e, "UI", "1.2.3.5") +
        shortElement(0x00280002, 1) + element(0x00280004, "CS", "MONOCHROME2") +
        element(0x00280008, "IS", std::to_string(file.frames_said.value_or(int(file.frames.size())))) +
        shortElement(0x00280010, file.rows) + shortElement(0x00280011, file.columns) +
        shortElement(0x00280100, bits) + shortElement(0x00280101, bits) + shortElement(0x00280102, bits - 1) +
        shortElement(0x00280103, 0) + textElement(0x00620001, "CS", file.type) +
        (segments.empty() ? "" : element(0x00620002, "SQ", segments)) +
        (file.most_fraction ? shortElement(0x0062000e, *file.most_fraction) : "") +
        element(0x52009229, "SQ", item(sharedGroups(file))) + element(0x52009230, "SQ", frames) +
        (file.has_pixels ? element(0x7fe00010, "OB", framePixels(file, bits)) : "");
    const bool is_deflated = file.transfer_syntax == "1.2.840.10008.1.2.1.99";
    return metaHeader(file.sop_class, "1.2.3.4.9", file.transfer_syntax) +
           // As PS3.5 A.5 asks: without zlib's head.
           (is_deflated ? deflated(data, DeflateHead::kNone) : data);
}

void writeDicomSeg(const std::filesystem::path& path, const DicomSegmentation& file) {
    writeBytes(path, dicomSegBytes(file));
}

}  // namespace bonemill
