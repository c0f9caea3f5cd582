#include "haptic_server/assessment/product/cut_surface.h"

#include "haptic_server/surface/mesh/leaf_mesher.h"

namespace bonemill {
namespace {

constexpr int kCutLeafCells = 16;

bool isNearChange(const Eigen::Vector3d& p_V, const ChangeGrid& changes) {
    const Eigen::Vector3i low = (p_V.array() / changes.spacing().array()).floor().cast<int>();
    for (int corner = 0; corner < 8; ++corner)
        if (changes.isChangedOrIdeal(low + Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2)))
            return true;
    return false;
}

void addPieces(const NodeMesh& mesh, const MeshGrid& grid, const ChangeGrid& changes,
               std::vector<CutPiece>& pieces) {
    for (size_t n = 0; n + 2 < mesh.indices.size(); n += 3) {
        Eigen::Vector3d corner[3];
        for (size_t c = 0; c < 3; ++c)
            corner[c] = grid.position(grid.stepsOf(mesh.leaf, mesh.vertices[mesh.indices[n + c]]));
        const Eigen::Vector3d center = (corner[0] + corner[1] + corner[2]) / 3;
        const Eigen::Vector3d across = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
        const double area = across.norm() / 2;
        if (area > 0) pieces.push_back({center, across / (2 * area), area, isNearChange(center, changes)});
    }
}

}  // namespace

ChangeGrid::ChangeGrid(const IndexBox& box, const VoxelVolume& scanned, const VoxelVolume& now,
                       const JudgedTask& task)
    : box_(box), size_(box.max - box.min + Eigen::Vector3i::Ones()), spacing_(scanned.spacing()) {
    bits_.reserve(size_t(box.count()));
    const Density iso = scanned.iso();
    forEachIndex(box, [&](const Eigen::Vector3i& v) {
        const bool was = scanned.at(v.x(), v.y(), v.z()) >= iso, is = now.at(v.x(), v.y(), v.z()) >= iso;
        const bool is_ideal = was && task.isIdeal(v);
        bits_.push_back(uint8_t((was ? kWasBone : 0) | (is ? kIsBone : 0) | (is_ideal ? kIsIdeal : 0)));
    });
}

std::vector<CutPiece> surfaceIn(const VoxelVolume& now, const ChangeGrid& changes) {
    std::vector<CutPiece> pieces;
    const LeafLattice lattice(now, Eigen::Vector3i::Constant(kCutLeafCells));
    const MeshGrid grid(now, lattice);
    LeafMesher mesher(now, lattice);
    forEachIndex(lattice.leavesOfCells(changes.box().grown(1)), [&](const Eigen::Vector3i& leaf) {
        const auto mesh = mesher.mesh(lattice.leafId(leaf));
        if (mesh) addPieces(*mesh, grid, changes, pieces);
    });
    return pieces;
}

}  // namespace bonemill
