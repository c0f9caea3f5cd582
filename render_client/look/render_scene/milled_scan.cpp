#include "render_client/look/render_scene/milled_scan.h"

#include <utility>

#include "render_client/look/slices/grey_window.h"
#include "render_client/look/slices/slice_plane.h"

namespace bonemill {
namespace {

constexpr uint16_t kMilled = 65535;
constexpr double kInsideBone =
    0.03;  // of all densities: a wall lay so far above the surface's, or it is the scan's

// Tells apart what is here of the bricks; never 0.
uint64_t stampOf(const std::vector<uint32_t>& bricks, const DensityStore& store) {
    uint64_t stamp = 1469598103934665603u;  // FNV-1a
    for (const uint32_t number : bricks) {
        const DensityBrick* const brick = store.find(number);
        stamp = (stamp ^ (brick ? uint64_t(brick->revision) + 2 : 1)) * 1099511628211u;
    }
    return stamp | 1;
}

std::vector<NodeStore::VertexScan> scanOf(const NodeMesh& mesh, const DensitySampler& sampler, double least) {
    std::vector<NodeStore::VertexScan> scan;
    scan.reserve(mesh.vertices.size());
    for (const PackedVertex& vertex : mesh.vertices) {
        const Eigen::Vector3f steps(vertex.x, vertex.y, vertex.z);
        const Eigen::Vector3f p_V = mesh.origin + mesh.step.cwiseProduct(steps);
        const SampledDensity sample = sampler.at(p_V.cast<double>());
        const bool is_milled = sample.was_changed && sample.scanned >= least;
        scan.push_back({sample.scanned, is_milled ? kMilled : uint16_t(0)});
    }
    return scan;
}

}  // namespace

void MilledScan::update(const DensitySampler& sampler, const DensityStore& store, NodeStore& nodes) {
    const DensityGrid& grid = *store.grid();
    const double least = densityOf(grid, grid.iso_value) + kInsideBone * 65535;
    struct Due {
        uint32_t leaf;
        uint64_t stamp;
        std::vector<NodeStore::VertexScan> scan;
    };
    std::vector<Due> due;
    bricks_.clear();
    nodes.visitMilled([&](const NodeMesh& mesh, const Eigen::AlignedBox3f& box, uint64_t stamp) {
        const std::vector<uint32_t> around = bricksIn(grid, box.cast<double>());
        bricks_.insert(bricks_.end(), around.begin(), around.end());
        const uint64_t now = stampOf(around, store);
        if (now != stamp) due.push_back({mesh.leaf, now, scanOf(mesh, sampler, least)});
    });
    for (const Due& node : due) nodes.setScan(node.leaf, node.scan, node.stamp);
}

}  // namespace bonemill
