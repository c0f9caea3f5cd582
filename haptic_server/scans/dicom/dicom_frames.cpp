#include "haptic_server/scans/dicom/dicom_frames.h"

#include <gdcmReader.h>

#include <cstdint>
#include <optional>
#include <string>

#include "common/text/printed_text.h"
#include "haptic_server/scans/dicom/dicom_groups.h"

namespace bonemill {
namespace {

const gdcm::Tag kPixelDataElement(0x7fe0, 0x0010);
const gdcm::Tag kValueTransformation(0x0028, 0x9145);
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

std::optional<DicomFrame> readFrame(const FunctionalGroups& groups, size_t frame, const std::string& name) {
    const DicomPlaceTexts texts = groups.placeTexts(frame);
    if (!texts.areComplete()) return std::nullopt;
    return DicomFrame{
        placeFromTexts(texts, kThreeDigits, name),
        rescaleFromTexts(groups.text(frame, kValueTransformation, gdcm::Tag(0x0028, 0x1053)),
                         groups.text(frame, kValueTransformation, gdcm::Tag(0x0028, 0x1052)), name),
        readTraits(groups, frame)};
}

}  // namespace

std::vector<DicomFrame> readFrames(const std::filesystem::path& path) {
    gdcm::Reader reader;
    reader.SetFileName(path.c_str());
    if (!reader.ReadUpToTag(kPixelDataElement)) return {};
    const FunctionalGroups groups(reader.GetFile().GetDataSet());
    std::vector<DicomFrame> frames;
    for (size_t f = 0; f < groups.frameCount(); ++f) {
        const auto frame = readFrame(groups, f, path.string() + " frame " + std::to_string(f + 1));
        if (!frame) return {};
        frames.push_back(*frame);
    }
    return frames;
}

}  // namespace bonemill
