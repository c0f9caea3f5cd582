// Takes any densities, volume size, leaf size, iso-value and edits. rapidcheck prints the seed of the run.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <map>

#include "haptic_server/surface/mesh/mesh_check.h"
#include "haptic_server/surface/mesh/mesher.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

Eigen::Vector3i anySize(int largest) {
    return {*rc::gen::inRange(1, largest + 1), *rc::gen::inRange(1, largest + 1),
            *rc::gen::inRange(1, largest + 1)};
}

// Densities lie around iso and at both ends, so that equality, thin walls and clamping all turn up.
Density anyDensity(Density iso) {
    return *rc::gen::element<Density>(0, kMaxDensity, iso, Density(iso - 1),
                                      Density(iso + (iso < kMaxDensity ? 1 : 0)), Density(iso / 2));
}

VoxelVolume anyVolume() {
    const Density iso = *rc::gen::element<Density>(1, 2, 300, 32768, 65534, 65535);
    VoxelVolume volume(test::boxGeometry(anySize(7)), iso);
    test::forEachVoxel(test::wholeBox(volume),
                       [&](int i, int j, int k) { volume.set(i, j, k, anyDensity(iso)); });
    return volume;
}

size_t crossedGridEdges(const VoxelVolume& volume) {
    size_t crossed = 0;
    test::forEachVoxel({Eigen::Vector3i::Constant(-1), volume.dims()}, [&](int i, int j, int k) {
        for (int axis = 0; axis < 3; ++axis) {
            const Eigen::Vector3i high = Eigen::Vector3i(i, j, k) + Eigen::Vector3i::Unit(axis);
            if (high[axis] > volume.dims()[axis]) continue;
            const bool is_bone = volume.at(i, j, k) >= volume.iso();
            if (is_bone != (volume.at(high.x(), high.y(), high.z()) >= volume.iso())) ++crossed;
        }
    });
    return crossed;
}

RC_GTEST_PROP(MeshProperties, EverySurfaceIsClosedAndOutward, ()) {
    const VoxelVolume volume = anyVolume();
    const LeafLattice lattice(volume, anySize(9));
    const MeshCheck check = checkMesh(test::meshAll(volume, lattice), MeshGrid(volume, lattice));
    RC_ASSERT(check.isClosed());
    RC_ASSERT(check.vertices == crossedGridEdges(volume));
    RC_ASSERT((check.volume > 0) == (check.triangles > 0));
}

RC_GTEST_PROP(MeshProperties, LeavesAreAPartition, ()) {
    const VoxelVolume volume = anyVolume();
    const LeafLattice cut(volume, anySize(5));
    const LeafLattice whole(volume, cut.leavesPerAxis().cwiseProduct(cut.leafCells()));
    RC_ASSERT(checkMesh(test::meshAll(volume, cut), MeshGrid(volume, cut)).triangles ==
              checkMesh(test::meshAll(volume, whole), MeshGrid(volume, whole)).triangles);
}

RC_GTEST_PROP(MeshProperties, IncrementalEqualsFull, ()) {
    VoxelVolume volume = anyVolume();
    LeafLattice lattice(volume, anySize(4));
    const BoneProperties properties(
        volume, [](const Eigen::Vector3i&) { return *rc::gen::element<MaterialId>(0, 1, 2, 127); });
    Mesher mesher(volume, lattice, MeshGrid::kMaxStepsPerCell, {&properties});
    std::map<LeafId, NodeMesh> model;
    const auto sink = [&](NodeMesh&& mesh) {
        const LeafId leaf = mesh.leaf;
        if (mesh.isEmpty()) {
            RC_ASSERT(model.erase(leaf) == 1u);
        } else {
            model[leaf] = std::move(mesh);
        }
    };
    mesher.pass(sink);
    for (int edits = *rc::gen::inRange(1, 6); edits > 0; --edits) {
        IndexBox box;
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = *rc::gen::inRange(0, volume.dims()[axis]);
            box.max[axis] = *rc::gen::inRange(box.min[axis], volume.dims()[axis]);
        }
        test::writeLikeTick(volume, lattice, box, [&](int, int, int) { return anyDensity(volume.iso()); });
        mesher.pass(sink, *rc::gen::inRange(0u, 5u));
    }
    RC_ASSERT(mesher.pass(sink).pending == 0u);

    const std::vector<NodeMesh> full = test::meshAll(volume, lattice, &properties);
    RC_ASSERT(model.size() == full.size());
    for (const NodeMesh& mesh : full)
        RC_ASSERT(model.contains(mesh.leaf) && test::sameMesh(model[mesh.leaf], mesh));
}

}  // namespace
}  // namespace bonemill
