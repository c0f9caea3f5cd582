#include "haptic_server/assessment/product/product.h"

#include "haptic_server/assessment/product/breach.h"
#include "haptic_server/assessment/product/cavity_form.h"
#include "haptic_server/assessment/product/plan_error.h"
#include "haptic_server/assessment/product/structures_left.h"
#include "haptic_server/assessment/product/zone_tally.h"

namespace bonemill {
namespace {

constexpr int64_t kMaxGridVoxels = 16'000'000;  // time and memory are bounded
constexpr double kMargin = 4e-3;                // m around what is gone or shall be

IndexBox gridBoxOf(const IndexBox& changed, const VoxelVolume& volume) {
    const Eigen::Vector3i margin = (kMargin / volume.spacing().array()).ceil().cast<int>();
    return IndexBox{changed.min - margin, changed.max + margin}.clamped(Eigen::Vector3i::Constant(-1),
                                                                        volume.dims());
}

// Without a way into the bone it is seen from where most of what is judged looks out.
Eigen::Vector3d viewOf(const Deviation& deviation, const JudgedTask& task) {
    if (task.approach_V) return *task.approach_V;
    if (task.plan) return (task.plan->tip_V - task.plan->entry_V).normalized();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const CutPiece& piece : deviation.pieces) sum -= piece.area * piece.normal_V;
    return sum.norm() > 0 ? Eigen::Vector3d(sum.normalized()) : Eigen::Vector3d(-Eigen::Vector3d::UnitZ());
}

void measureShape(const ProductInput& input, const IndexBox& changed, Product& product) {
    const JudgedTask& task = input.task;
    const ChangeGrid changes(gridBoxOf(changed, input.now), input.scanned, input.now, task);
    const std::vector<CutPiece> pieces = surfaceIn(input.now, changes);
    const Deviation deviation = deviationOf(changes, pieces);
    addDeviationFigures(deviation, product.figures);
    if (task.approach_V) addCavityFigures(changes, pieces, *task.approach_V, product.figures);
    product.picture =
        drawDeviation(deviation, pieces, viewOf(deviation, task), input.now.spacing().maxCoeff());
    if (task.plan) addPlanFigures(changes, *task.plan, SolidBone(input.scanned, *task.plan), product.figures);
}

}  // namespace

Product measureProduct(const ProductInput& input) {
    Product product;
    const ProductCounts counts = countProduct(input.scanned, input.now, input.task);
    const double voxel_volume = input.scanned.voxelVolume();
    addZoneFigures(counts, input.task, voxel_volume, product.figures);
    if (input.breach) addBreachFigures(*input.breach, product.figures);
    if (!counts.changed.isEmpty()) {
        if (gridBoxOf(counts.changed, input.now).count() <= kMaxGridVoxels)
            measureShape(input, counts.changed, product);
        else
            product.left_out.push_back(
                "over- and under-cut, form and plan: what is gone and what should be lie too far apart for "
                "the time there is");
    }
    addStructureFigures(structuresLeft(input.scanned, input.now, input.task), voxel_volume, product.figures);
    return product;
}

}  // namespace bonemill
