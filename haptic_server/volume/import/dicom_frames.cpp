#include "haptic_server/volume/import/dicom_frames.h"

#include <gdcmAttribute.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>

#include <optional>

namespace bonemill {
namespace {

const gdcm::Tag kPixelDataElement(0x7fe0, 0x0010);
const gdcm::Tag kSharedGroups(0x5200, 0x9229);
const gdcm::Tag kPerFrameGroups(0x5200, 0x9230);
const gdcm::Tag kPlanePosition(0x0020, 0x9113);
const gdcm::Tag kPlaneOrientation(0x0020, 0x9116);
const gdcm::Tag kPixelMeasures(0x0028, 0x9110);

using Sequence = gdcm::SmartPointer<gdcm::SequenceOfItems>;

Sequence sequence(const gdcm::DataSet& data, const gdcm::Tag& tag) {
    if (!data.FindDataElement(tag)) return nullptr;
    return data.GetDataElement(tag).GetValueAsSQ();
}

// Reads the numbers of an attribute in the only item of a group, looked for in one place after the other.
template <uint16_t kGroup, uint16_t kElement>
std::optional<gdcm::Attribute<kGroup, kElement>> find(const std::vector<const gdcm::DataSet*>& places,
                                                      const gdcm::Tag& group) {
    gdcm::Attribute<kGroup, kElement> attribute;
    for (const gdcm::DataSet* place : places) {
        const Sequence items = sequence(*place, group);
        if (!items || items->GetNumberOfItems() == 0) continue;
        const gdcm::DataSet& data = items->GetItem(1).GetNestedDataSet();
        if (!data.FindDataElement(attribute.GetTag())) continue;
        attribute.SetFromDataElement(data.GetDataElement(attribute.GetTag()));
        return attribute;
    }
    return std::nullopt;
}

std::optional<DicomFrame> readFrame(const std::vector<const gdcm::DataSet*>& places) {
    const auto position = find<0x0020, 0x0032>(places, kPlanePosition);
    const auto orientation = find<0x0020, 0x0037>(places, kPlaneOrientation);
    const auto spacing = find<0x0028, 0x0030>(places, kPixelMeasures);
    if (!position || !orientation || !spacing) return std::nullopt;
    DicomFrame frame;
    for (unsigned a = 0; a < 3; ++a) {
        frame.position_mm[a] = position->GetValue(a);
        frame.row_direction[a] = orientation->GetValue(a);
        frame.column_direction[a] = orientation->GetValue(a + 3);
    }
    frame.pixel_spacing_mm = {spacing->GetValue(1), spacing->GetValue(0)};  // DICOM: between rows first
    return frame;
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
        const auto frame = readFrame(places);
        if (!frame) return {};
        frames.push_back(*frame);
    }
    return frames;
}

}  // namespace bonemill
