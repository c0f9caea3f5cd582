// Volumes in what people read.
#pragma once

#include <string>

namespace bonemill {

// m³ as mm^3: three digits, or all that are before the point.
std::string volumeText(double cubic_metres);

}  // namespace bonemill
