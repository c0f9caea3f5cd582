#include "haptic_server/volume/import/dicom_frames.h"

#include <gdcmByteValue.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

#include "haptic_server/volume/import/decimal_numbers.h"
#include "haptic_server/volume/import/printed_text.h"

namespace bonemill {
namespace {

const gdcm::Tag kPixelDataElement(0x7fe0, 0x0010);
const gdcm::Tag kSharedGroups(0x5200, 0x9229);
const gdcm::Tag kPerFrameGroups(0x5200, 0x9230);
const gdcm::Tag kPlanePosition(0x0020, 0x9113);
const gdcm::Tag kPlaneOrientation(0x0020, 0x9116);
const gdcm::Tag kPixelMeasures(0x0028, 0x9110);
const gdcm::Tag kValueTransformation(0x0028, 0x9145);
const gdcm::Tag kFrameContent(0x0020, 0x9111);
const gdcm::Tag kMrDiffusion(0x0018, 0x9117);
const gdcm::Tag kCtReconstruction(0x0018, 0x9314);
const gdcm::Tag kCtFrameType(0x0018, 0x9329);
const gdcm::Tag kMrFrameType(0x0018, 0x9226);

using Sequence = gdcm::SmartPointer<gdcm::SequenceOfItems>;

Sequence sequence(const gdcm::DataSet& data, const gdcm::Tag& tag) {
    if (!data.FindDataElement(tag)) return nullptr;
    return data.GetDataElement(tag).GetValueAsSQ();
}

// Returns the bytes of an element in the only item of a group, looked for in one place after the other; empty
// when there is none.
std::string findBytes(const std::vector<const gdcm::DataSet*>& places, const gdcm::Tag& group,
                      const gdcm::Tag& element) {
    for (const gdcm::DataSet* place : places) {
        const Sequence items = sequence(*place, group);
        if (!items || items->GetNumberOfItems() == 0) continue;
        const gdcm::DataSet& data = items->GetItem(1).GetNestedDataSet();
        if (!data.FindDataElement(element)) continue;
        const gdcm::ByteValue* bytes = data.GetDataElement(element).GetByteValue();
        if (bytes) return std::string(bytes->GetPointer(), bytes->GetLength());
    }
    return {};
}

std::string find(const std::vector<const gdcm::DataSet*>& places, const gdcm::Tag& group,
                 const gdcm::Tag& element) {
    return withoutPadding(findBytes(places, group, element));
}

// Of an element whose value is one number of this type (VR US, UL, FD), as text.
template <class Number>
std::string findNumber(const std::vector<const gdcm::DataSet*>& places, const gdcm::Tag& group,
                       const gdcm::Tag& element) {
    const std::string bytes = findBytes(places, group, element);
    Number number;
    if (bytes.size() != sizeof number) return {};
    std::memcpy(&number, bytes.data(), sizeof number);
    return printed("%.10g", double(number));
}

DicomTraits readTraits(const std::vector<const gdcm::DataSet*>& places) {
    DicomTraits traits;
    traits.acquisition_number = findNumber<uint16_t>(places, kFrameContent, gdcm::Tag(0x0020, 0x9156));
    traits.temporal_position = findNumber<uint32_t>(places, kFrameContent, gdcm::Tag(0x0020, 0x9128));
    traits.b_value = findNumber<double>(places, kMrDiffusion, gdcm::Tag(0x0018, 0x9087));
    traits.kernel = find(places, kCtReconstruction, gdcm::Tag(0x0018, 0x1210));
    for (const gdcm::Tag& frame_type : {kCtFrameType, kMrFrameType})
        if (traits.image_type.empty())
            traits.image_type = find(places, frame_type, gdcm::Tag(0x0008, 0x9007));
    traits.acquisition_time = find(places, kFrameContent, gdcm::Tag(0x0018, 0x9074));
    return traits;
}

std::optional<DicomFrame> readFrame(const std::vector<const gdcm::DataSet*>& places,
                                    const std::string& name) {
    const DicomPlaceTexts texts{find(places, kPlanePosition, gdcm::Tag(0x0020, 0x0032)),
                                find(places, kPlaneOrientation, gdcm::Tag(0x0020, 0x0037)),
                                find(places, kPixelMeasures, gdcm::Tag(0x0028, 0x0030))};
    if (texts.position.empty() || texts.orientation.empty() || texts.pixel_spacing.empty())
        return std::nullopt;
    return DicomFrame{placeFromTexts(texts, kThreeDigits, name),
                      rescaleFromTexts(find(places, kValueTransformation, gdcm::Tag(0x0028, 0x1053)),
                                       find(places, kValueTransformation, gdcm::Tag(0x0028, 0x1052)), name),
                      readTraits(places)};
}

}  // namespace

std::vector<DicomFrame> readFrames(const std::filesystem::path& path) {
    gdcm::Reader reader;
    reader.SetFileName(path.c_str());
    if (!reader.ReadUpToTag(kPixelDataElement)) return {};
    const gdcm::DataSet& data = reader.GetFile().GetDataSet();
    const Sequence per_frame = sequence(data, kPerFrameGroups), shared = sequence(data, kSharedGroups);
    if (!per_frame) return {};
    std::vector<DicomFrame> frames;
    for (size_t f = 1; f <= per_frame->GetNumberOfItems(); ++f) {  // GDCM counts items from 1
        std::vector<const gdcm::DataSet*> places{&per_frame->GetItem(f).GetNestedDataSet()};
        if (shared && shared->GetNumberOfItems() > 0)
            places.push_back(&shared->GetItem(1).GetNestedDataSet());
        const auto frame = readFrame(places, path.string() + " frame " + std::to_string(f));
        if (!frame) return {};
        frames.push_back(*frame);
    }
    return frames;
}

}  // namespace bonemill
