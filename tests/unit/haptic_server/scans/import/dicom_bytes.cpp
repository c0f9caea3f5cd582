#include "tests/unit/haptic_server/scans/import/dicom_bytes.h"

#include <cstring>

#include "tests/unit/haptic_server/scans/import/dicom_elements.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

using namespace dicom;

// Nothing of an empty text.
std::string optionalElement(uint32_t tag, const std::string& vr, const std::string& value) {
    return value.empty() ? "" : element(tag, vr, value);
}

std::string bytesOf(const std::vector<double>& numbers) {
    std::string bytes(numbers.size() * sizeof(double), '\0');
    if (!numbers.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
}

std::string decimal(double value) {
    std::string text = std::to_string(value);
    return text.substr(0, 16);
}

std::string sopClass(const DicomImage& image) {
    if (!image.sop_class.empty()) return image.sop_class;
    if (!image.frame_positions.empty()) return "1.2.840.10008.5.1.4.1.1.2.1";  // Enhanced CT
    return image.samples_per_pixel == 1 ? "1.2.840.10008.5.1.4.1.1.2" : "1.2.840.10008.5.1.4.1.1.7";
}

std::string pixelBytes(const DicomImage& image) {
    if (!image.pixel_bytes.empty()) return image.pixel_bytes;
    std::string bytes;
    for (const int16_t v : image.pixels)
        bytes += image.bits == 8 ? std::string(1, char(v)) : number(uint16_t(v), 2);
    return bytes;
}

int wordBits(const DicomImage& image) {
    return image.allocated > 0 ? image.allocated : image.bits;
}

// The first item is an offset table, which may be empty.
std::string pixelElement(const DicomImage& image) {
    if (image.fragments.empty())
        return element(0x7fe00010, wordBits(image) == 8 ? "OB" : "OW", pixelBytes(image));
    std::string bytes = number(0x00107fe0, 4) + "OB" + number(0, 2) + number(0xffffffff, 4) + item("");
    for (const std::string& fragment : image.fragments) bytes += item(fragment);
    return bytes + number(0xe0ddfffe, 4) + number(0, 4);
}

// Of "slope|intercept"; nothing of an empty text.
std::string valueTransformation(const std::string& rescale) {
    if (rescale.empty()) return {};
    const size_t bar = rescale.find('|');
    return element(0x00289145, "SQ",
                   item(element(0x00281052, "DS", rescale.substr(bar + 1)) +
                        element(0x00281053, "DS", rescale.substr(0, bar)) + element(0x00281054, "LO", "HU")));
}

std::string functionalGroups(const DicomImage& image) {
    const std::string shared =
        element(0x00209116, "SQ", item(element(0x00200037, "DS", image.orientation))) +
        element(0x00289110, "SQ",
                item(element(0x00180050, "DS", "1") + element(0x00280030, "DS", image.pixel_spacing))) +
        valueTransformation(image.shared_rescale) + image.shared_groups;
    std::string frames;
    for (size_t f = 0; f < image.frame_positions.size(); ++f)
        frames += item(
            (image.frame_phases.empty()
                 ? ""
                 : element(0x00209111, "SQ",
                           item(element(0x00209128, "UL", number(uint32_t(image.frame_phases[f]), 4))))) +
            element(0x00209113, "SQ", item(element(0x00200032, "DS", image.frame_positions[f]))) +
            (image.frame_rescales.empty() ? "" : valueTransformation(image.frame_rescales[f])));
    return element(0x52009229, "SQ", item(shared)) + element(0x52009230, "SQ", frames);
}

}  // namespace

std::string dicomBytes(const DicomImage& image) {
    const bool is_enhanced = !image.frame_positions.empty();
    std::string bytes =
        metaHeader(sopClass(image), image.sop_uid, image.transfer_syntax) +
        optionalElement(0x00080008, "CS", image.image_type) + element(0x00080016, "UI", sopClass(image)) +
        element(0x00080018, "UI", image.sop_uid) + optionalElement(0x00080032, "TM", image.acquisition_time) +
        optionalElement(0x00080033, "TM", image.content_time) + element(0x00080060, "CS", image.modality) +
        optionalElement(0x0008103e, "LO", image.series_description) + element(0x00100010, "PN", "TEST^FILE") +
        optionalElement(0x00100020, "LO", image.patient_id) +
        optionalElement(0x00180010, "LO", image.contrast) + optionalElement(0x00181210, "SH", image.kernel) +
        optionalElement(0x00189087, "FD", bytesOf(image.b_value)) + element(0x0020000d, "UI", "1.2.3") +
        element(0x0020000e, "UI", image.series_uid) +
        optionalElement(0x00200012, "IS", image.acquisition_number);
    if (!is_enhanced && !image.position.empty())
        bytes += element(0x00200032, "DS", image.position) + element(0x00200037, "DS", image.orientation);
    bytes += optionalElement(0x00200052, "UI", image.space_uid);
    bytes += optionalElement(0x00200100, "IS", image.temporal_position);
    bytes += shortElement(0x00280002, image.samples_per_pixel) + element(0x00280004, "CS", image.photometric);
    if (image.samples_per_pixel > 1) bytes += shortElement(0x00280006, 0);
    if (is_enhanced)
        bytes += element(
            0x00280008, "IS",
            image.frame_count.empty() ? std::to_string(image.frame_positions.size()) : image.frame_count);
    bytes += shortElement(0x00280010, image.rows) + shortElement(0x00280011, image.columns);
    if (!is_enhanced && !image.pixel_spacing.empty()) bytes += element(0x00280030, "DS", image.pixel_spacing);
    const bool is_signed = image.is_signed.value_or(image.bits != 8);
    bytes += shortElement(0x00280100, wordBits(image)) + shortElement(0x00280101, image.bits) +
             shortElement(0x00280102, image.high > 0 ? image.high : image.bits - 1) +
             shortElement(0x00280103, is_signed ? 1 : 0) + image.elements;
    if (image.samples_per_pixel == 1 && !is_enhanced && image.has_rescale && image.last_elements.empty())
        bytes += element(0x00281052, "DS", decimal(image.intercept)) +
                 element(0x00281053, "DS", decimal(image.slope));
    bytes += image.last_elements;
    if (image.photometric == "PALETTE COLOR")
        for (const uint32_t table : {0x1101u, 0x1102u, 0x1103u})
            bytes += element(0x00280000 | table, "US", number(256, 2) + number(0, 2) + number(8, 2));
    if (image.photometric == "PALETTE COLOR")
        for (const uint32_t table : {0x1201u, 0x1202u, 0x1203u})
            bytes += element(0x00280000 | table, "OW", std::string(256, char(table)));
    if (is_enhanced) bytes += functionalGroups(image);
    if (image.has_pixels) bytes += pixelElement(image);
    return bytes;
}

void writeDicomFile(const std::filesystem::path& path, const DicomImage& image) {
    writeBytes(path, dicomBytes(image));
}

}  // namespace bonemill
