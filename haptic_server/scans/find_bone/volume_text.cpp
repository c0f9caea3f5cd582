#include "haptic_server/scans/find_bone/volume_text.h"

#include "common/base/units.h"
#include "common/text/printed_text.h"

namespace bonemill {

std::string volumeText(double cubic_metres) {
    const double cubic_mm = cubic_metres * kPerCubicMillimetre;
    return printed(cubic_mm < 100 ? "%.3g mm^3" : "%.0f mm^3", cubic_mm);
}

std::string edgesText(const Eigen::Vector3d& edges) {
    return printed("%.4g x %.4g x %.4g", edges.x(), edges.y(), edges.z());
}

}  // namespace bonemill
