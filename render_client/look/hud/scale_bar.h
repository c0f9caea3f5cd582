// Beside a bar of a round length one sees how large the bone is. The function is pure; any thread
// may call it.
#pragma once

#include <string>

namespace bonemill {

struct ScaleBar {
    double length = 0;  // m; 0: there is none
    std::string label;
};

// Returns the longest length of 1, 2 or 5 times a power of ten that spans at most max_pixels.
ScaleBar makeScaleBar(double metres_per_pixel, double max_pixels);

}  // namespace bonemill
