#include "render_client/look/hud/scale_bar.h"

#include <cmath>
#include <cstdio>

#include "common/base/units.h"

namespace bonemill {
ScaleBar makeScaleBar(double metres_per_pixel, double max_pixels) {
    const double longest = metres_per_pixel * max_pixels;
    if (!(longest > 0) || !std::isfinite(longest)) return {};
    const double decade = std::pow(10.0, std::floor(std::log10(longest) + 1e-9));
    const double length = decade * (longest >= 5 * decade ? 5 : longest >= 2 * decade ? 2 : 1);
    const double length_mm = length * kPerMillimetre;
    char text[32];
    std::snprintf(text, sizeof text, "%g mm", length_mm);
    return {length, text};
}

}  // namespace bonemill
