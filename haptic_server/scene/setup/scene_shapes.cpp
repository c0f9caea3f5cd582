#include "haptic_server/scene/setup/scene_shapes.h"

#include "common/base/user_error.h"
#include "haptic_server/scene/tool_build/build_tool.h"

namespace bonemill {
namespace {

struct BoxShape {
    Pose X_WB;
    Eigen::Vector3d half_size;
};

BoxShape boxOf(const scene::Task::Box& box) {
    return {{metresOf(box.center_mm()), rotationOf(box.q_wb())}, metresOf(box.size_mm()) / 2};
}

Eigen::AlignedBox3d aroundBox(const BoxShape& box) {
    Eigen::AlignedBox3d around;
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d sides(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        around.extend(box.X_WB * box.half_size.cwiseProduct(sides));
    }
    return around;
}

// Voxels whose centres may lie in this box of W.
IndexBox voxelsAround(const Eigen::AlignedBox3d& box_W, const VolumeGeometry& geometry) {
    const Pose X_VW = geometry.X_WV.inverse();
    Eigen::AlignedBox3d box_V;
    for (int corner = 0; corner < 8; ++corner)
        box_V.extend(X_VW * box_W.corner(Eigen::AlignedBox3d::CornerType(corner)));
    const Eigen::Array3d far = geometry.dims.cast<double>().array();
    const auto voxel = [&](const Eigen::Vector3d& p_V, double shift) -> Eigen::Vector3i {
        return (p_V.array() / geometry.spacing.array() + shift).max(-1).min(far).round().cast<int>();
    };
    return IndexBox{voxel(box_V.min(), -1), voxel(box_V.max(), 1)}.clamped(Eigen::Vector3i::Zero(),
                                                                           geometry.dims.array() - 1);
}

template <class IsInside>
void mark(const IndexBox& box, const VolumeGeometry& geometry, std::vector<uint8_t>& marks,
          IsInside&& is_inside_W) {
    forEachIndex(box, [&](const Eigen::Vector3i& v) {
        if (!is_inside_W(geometry.X_WV * v.cast<double>().cwiseProduct(geometry.spacing))) return;
        const size_t row = size_t(v.y()) + size_t(geometry.dims.y()) * size_t(v.z());
        marks[size_t(v.x()) + size_t(geometry.dims.x()) * row] = 1;
    });
}

void checkSolid(const LoadedScene& loaded, const ToolShape& shape, const std::string& path, int number) {
    try {
        checkShape(shape, path + ".shape[" + std::to_string(number) + "]");
    } catch (const UserError& error) {
        throw UserError(placeOf(loaded.file.string(), loaded.lines, path) + error.what());
    }
}

}  // namespace

std::vector<uint8_t> voxelsInside(const LoadedScene& loaded,
                                  const google::protobuf::RepeatedPtrField<scene::Task::Shape>& shapes,
                                  const VolumeGeometry& geometry, const std::string& path) {
    std::vector<uint8_t> marks(geometry.voxelCount());
    for (int n = 0; n < shapes.size(); ++n) {
        if (shapes[n].has_box()) {
            const BoxShape box = boxOf(shapes[n].box());
            const Pose X_BW = box.X_WB.inverse();
            mark(voxelsAround(aroundBox(box), geometry), geometry, marks, [&](const Eigen::Vector3d& p_W) {
                return ((X_BW * p_W).array().abs() <= box.half_size.array()).all();
            });
            continue;
        }
        const ToolShape shape = toolShapeOf(shapes[n]);
        checkSolid(loaded, shape, path, n);
        mark(voxelsAround(boundingBox(shape), geometry), geometry, marks,
             [&](const Eigen::Vector3d& p_W) { return signedDistance(shape, p_W) <= 0; });
    }
    return marks;
}

}  // namespace bonemill
