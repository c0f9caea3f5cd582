#include "common/base/units.h"
#include "haptic_server/apps/python/arrays.h"
#include "haptic_server/apps/python/inputs.h"
#include "haptic_server/apps/python/runs.h"
#include "haptic_server/lab/stepping/depth_picture.h"

namespace bonemill::python {
namespace {

DepthCamera cameraOf(const py::object& camera) {
    const Pose X_WC = handOf(camera.attr("position_m"), camera.attr("orientation_wxyz"), py::int_(0)).X_WT;
    try {
        return {X_WC, kDegree * camera.attr("fov_degrees").cast<double>(), camera.attr("width").cast<int>(),
                camera.attr("height").cast<int>(), camera.attr("far_m").cast<double>()};
    } catch (const py::cast_error&) {
        throw UserError("a camera's fov_degrees and far_m are numbers, its width and height whole numbers");
    }
}

}  // namespace

py::array depthOf(Run& run, const py::object& camera) {
    const DepthCamera of = cameraOf(camera);
    const InUse in_use(run.isUsed());
    std::vector<float> depths;
    {
        const py::gil_scoped_release release;
        depths = depthPicture(run.own(), of);
    }
    return rowsOf<float>(std::move(depths), size_t(of.width)).reshape({of.height, of.width});
}

}  // namespace bonemill::python
