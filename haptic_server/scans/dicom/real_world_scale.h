// What the Real World Value Mapping (PS3.3 C.7.6.16.2.11) of a DICOM picture makes of its stored values.
#pragma once

#include <optional>
#include <string>

#include "haptic_server/scans/dicom/dicom_groups.h"
#include "haptic_server/scans/pixels/dicom_rescale.h"

namespace bonemill {

// Of the items of the sequence; nothing when they are null or there are none. Throws UserError naming `image`
// when there are several mappings, or the only one is a table or no line.
std::optional<DicomRescale> realWorldScale(const DicomItems& mappings, const std::string& image);

}  // namespace bonemill
