#include "haptic_server/volume/import/dicom_frames.h"

#include <gdcmByteValue.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>

#include <optional>
#include <string>

#include "haptic_server/volume/import/decimal_numbers.h"

namespace bonemill {
namespace {

const gdcm::Tag kPixelDataElement(0x7fe0, 0x0010);
const gdcm::Tag kSharedGroups(0x5200, 0x9229);
const gdcm::Tag kPerFrameGroups(0x5200, 0x9230);
const gdcm::Tag kPlanePosition(0x0020, 0x9113);
const gdcm::Tag kPlaneOrientation(0x0020, 0x9116);
const gdcm::Tag kPixelMeasures(0x0028, 0x9110);
const gdcm::Tag kValueTransformation(0x0028, 0x9145);

using Sequence = gdcm::SmartPointer<gdcm::SequenceOfItems>;

Sequence sequence(const gdcm::DataSet& data, const gdcm::Tag& tag) {
    if (!data.FindDataElement(tag)) return nullptr;
    return data.GetDataElement(tag).GetValueAsSQ();
}

// Returns the text of an element in the only item of a group, looked for in one place after the other; empty
// when there is none.
std::string find(const std::vector<const gdcm::DataSet*>& places, const gdcm::Tag& group,
                 const gdcm::Tag& element) {
    for (const gdcm::DataSet* place : places) {
        const Sequence items = sequence(*place, group);
        if (!items || items->GetNumberOfItems() == 0) continue;
        const gdcm::DataSet& data = items->GetItem(1).GetNestedDataSet();
        if (!data.FindDataElement(element)) continue;
        const gdcm::ByteValue* bytes = data.GetDataElement(element).GetByteValue();
        if (bytes) return withoutPadding(std::string(bytes->GetPointer(), bytes->GetLength()));
    }
    return {};
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
                                       find(places, kValueTransformation, gdcm::Tag(0x0028, 0x1052)), name)};
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
