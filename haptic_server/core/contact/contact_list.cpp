// Lists the contacts of a pose one by one, for those who ask what the solve ended with.
#include <algorithm>

#include "haptic_server/core/contact/gradient_contact.h"
#include "haptic_server/core/contact/into_tool.h"

namespace bonemill {

size_t GradientContact::list(const ToolField& tool, const Pose& X_VT,
                             std::span<SurfaceContact> out) const noexcept {
    constexpr int kBatch = PointBatch<float>::kCapacity;
    const double depth_cap = kDepthCap * tool.thinnestRadius();
    const IntoTool<float> into_tool(X_VT, origin_);
    const Eigen::Vector3d to_origin = origin_ - X_VT.position;
    PointBatch<float> batch;
    SampleBatch<float> at;
    size_t count = 0;
    for (size_t first = 0; first < candidates_.count; first += kBatch) {
        const int points = int(std::min(size_t(kBatch), candidates_.count - first));
        into_tool.fill(batch, &candidates_.x[first], &candidates_.y[first], &candidates_.z[first], points);
        tool.sample(batch, at);
        for (int i = 0; i < points; ++i) {
            if (!(at.distance[i] < 0)) continue;
            if (count == out.size()) return count;
            const size_t n = first + size_t(i);
            const Eigen::Vector3d gradient_T(at.gx[i], at.gy[i], at.gz[i]);
            const double depth = -double(at.distance[i]), slope = gradient_T.norm();
            const double force = double(candidates_.weight[n]) * std::min(depth, depth_cap) * slope;
            if (!(force > 0)) continue;
            out[count++] = {(candidates_.position(n).cast<double>() + to_origin).cast<float>(),
                            (X_VT.rotation * gradient_T / -slope).cast<float>(), float(depth), float(force),
                            uint32_t(n)};
        }
    }
    return count;
}

}  // namespace bonemill
