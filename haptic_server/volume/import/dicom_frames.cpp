#include "haptic_server/volume/import/dicom_frames.h"

#include <gdcmAttribute.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>

namespace bonemill {
namespace {

const gdcm::Tag kPixelData(0x7fe0, 0x0010);
const gdcm::Tag kPerFrameGroups(0x5200, 0x9230);
const gdcm::Tag kPlanePosition(0x0020, 0x9113);
const gdcm::Tag kImagePosition(0x0020, 0x0032);

gdcm::SmartPointer<gdcm::SequenceOfItems> sequence(const gdcm::DataSet& data, const gdcm::Tag& tag) {
    if (!data.FindDataElement(tag)) return nullptr;
    return data.GetDataElement(tag).GetValueAsSQ();
}

}  // namespace

std::vector<Eigen::Vector3d> framePositions(const std::filesystem::path& path) {
    std::vector<Eigen::Vector3d> positions;
    gdcm::Reader reader;
    reader.SetFileName(path.c_str());
    if (!reader.ReadUpToTag(kPixelData)) return positions;
    const auto frames = sequence(reader.GetFile().GetDataSet(), kPerFrameGroups);
    if (!frames) return positions;
    for (size_t f = 1; f <= frames->GetNumberOfItems(); ++f) {  // GDCM counts items from 1
        const auto planes = sequence(frames->GetItem(f).GetNestedDataSet(), kPlanePosition);
        if (!planes || planes->GetNumberOfItems() == 0) return positions;
        const gdcm::DataSet& plane = planes->GetItem(1).GetNestedDataSet();
        if (!plane.FindDataElement(kImagePosition)) return positions;
        gdcm::Attribute<0x0020, 0x0032> position;
        position.SetFromDataElement(plane.GetDataElement(kImagePosition));
        positions.emplace_back(position.GetValue(0), position.GetValue(1), position.GetValue(2));
    }
    return positions;
}

}  // namespace bonemill
