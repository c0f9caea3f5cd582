#include "haptic_server/scans/dicom/dicom_groups.h"

#include <gdcmByteValue.h>

#include "haptic_server/scans/pixels/dicom_rescale.h"

namespace bonemill {
namespace {

const gdcm::Tag kSharedGroups(0x5200, 0x9229);
const gdcm::Tag kPerFrameGroups(0x5200, 0x9230);
const gdcm::Tag kPlanePosition(0x0020, 0x9113);
const gdcm::Tag kPlaneOrientation(0x0020, 0x9116);
const gdcm::Tag kPixelMeasures(0x0028, 0x9110);

constexpr size_t kFirst = 1;  // GDCM counts items from 1

// Null when there are none.
DicomItems itemsIn(const DicomItems& places, size_t number, const gdcm::Tag& group) {
    if (!places || places->GetNumberOfItems() < number) return nullptr;
    const DicomItems items = itemsOf(places->GetItem(number).GetNestedDataSet(), group);
    return items && items->GetNumberOfItems() > 0 ? items : nullptr;
}

}  // namespace

DicomItems itemsOf(const gdcm::DataSet& data, const gdcm::Tag& tag) {
    if (!data.FindDataElement(tag)) return nullptr;
    return data.GetDataElement(tag).GetValueAsSQ();
}

std::string bytesOf(const gdcm::DataSet& data, const gdcm::Tag& tag) {
    if (!data.FindDataElement(tag)) return {};
    const gdcm::ByteValue* bytes = data.GetDataElement(tag).GetByteValue();
    return bytes ? std::string(bytes->GetPointer(), bytes->GetLength()) : std::string();
}

FunctionalGroups::FunctionalGroups(const gdcm::DataSet& data)
    : per_frame_(itemsOf(data, kPerFrameGroups)), shared_(itemsOf(data, kSharedGroups)) {}

size_t FunctionalGroups::frameCount() const {
    return per_frame_ ? per_frame_->GetNumberOfItems() : 0;
}

DicomItems FunctionalGroups::items(size_t frame, const gdcm::Tag& group) const {
    const DicomItems own = itemsIn(per_frame_, frame + kFirst, group);
    return own ? own : itemsIn(shared_, kFirst, group);
}

std::string FunctionalGroups::bytes(size_t frame, const gdcm::Tag& group, const gdcm::Tag& element) const {
    const auto in = [&](const DicomItems& places, size_t number) -> std::string {
        const DicomItems items = itemsIn(places, number, group);
        return items ? bytesOf(items->GetItem(kFirst).GetNestedDataSet(), element) : "";
    };
    const std::string own = in(per_frame_, frame + kFirst);
    return own.empty() ? in(shared_, kFirst) : own;
}

std::string FunctionalGroups::text(size_t frame, const gdcm::Tag& group, const gdcm::Tag& element) const {
    return withoutPadding(bytes(frame, group, element));
}

DicomPlaceTexts FunctionalGroups::placeTexts(size_t frame) const {
    return {text(frame, kPlanePosition, gdcm::Tag(0x0020, 0x0032)),
            text(frame, kPlaneOrientation, gdcm::Tag(0x0020, 0x0037)),
            text(frame, kPixelMeasures, gdcm::Tag(0x0028, 0x0030))};
}

}  // namespace bonemill
