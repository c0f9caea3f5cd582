#include "haptic_server/scans/dicom/real_world_scale.h"

#include <cmath>

#include "common/base/user_error.h"

namespace bonemill {

std::optional<DicomRescale> realWorldScale(const DicomItems& mappings, const std::string& image) {
    if (!mappings || mappings->GetNumberOfItems() == 0) return std::nullopt;
    if (mappings->GetNumberOfItems() > 1)
        throw UserError(image + ": has no Rescale Slope and Intercept but " +
                        std::to_string(mappings->GetNumberOfItems()) +
                        " Real World Value Mappings, of which none goes first; export it with a rescale");
    const gdcm::DataSet& mapping = mappings->GetItem(1).GetNestedDataSet();
    const auto slope = numberOf<double>(bytesOf(mapping, gdcm::Tag(0x0040, 0x9225)));
    const auto intercept = numberOf<double>(bytesOf(mapping, gdcm::Tag(0x0040, 0x9224)));
    if (!slope || !intercept || !std::isfinite(*slope) || !std::isfinite(*intercept) || *slope == 0)
        throw UserError(image +
                        ": its values are to go through a Real World Value Mapping that is no slope and "
                        "intercept (a table, or damaged), which is not supported; export it with a rescale");
    return DicomRescale{*slope, *intercept};
}

}  // namespace bonemill
