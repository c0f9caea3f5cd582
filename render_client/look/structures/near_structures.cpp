#include "render_client/look/structures/near_structures.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace bonemill {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

constexpr float kFinest = 4e-4f;  // m
constexpr int kBlock = 4;         // samples: one look says whether any of a block is near

uint8_t byteOf(float share) {
    return uint8_t(std::lround(255 * std::clamp(share, 0.0f, 1.0f)));
}

// Lays the grid around the box with the reach on all sides.
void layGrid(const Eigen::AlignedBox3f& box, NearStructures& near) {
    const Vector3f margin = Vector3f::Constant(near.reach), wide = box.sizes() + 2 * margin;
    near.first_V = box.min() - margin;
    near.step = std::max(kFinest, wide.maxCoeff() / float(NearStructures::kMaxPerAxis - 2));
    const auto sizeOf = [&wide](float step) {
        return Vector3i((wide / step).array().ceil().cast<int>().matrix() + Vector3i::Ones());
    };
    while (sizeOf(near.step).cast<int64_t>().prod() > NearStructures::kMaxSamples) near.step *= 1.05f;
    near.size = sizeOf(near.step);
}

}  // namespace

NearStructures nearStructures(const StructureSet& structures, const std::map<uint32_t, Vector3f>& colours,
                              double reach) {
    NearStructures near;
    Eigen::AlignedBox3f box;
    for (const auto& [id, structure] : structures.all())
        if (colours.contains(id)) box.extend(structure.tree.box());
    if (box.isEmpty() || !(reach > 0)) return near;
    near.reach = float(reach);
    layGrid(box, near);
    near.samples.assign(size_t(near.size.prod()), {0, 0, 0, 255});
    const auto nearest = [&](const Vector3f& p_V, float within) {
        return structures.nearest(p_V, within, [&](uint32_t id) { return colours.contains(id); });
    };
    const Vector3i blocks = (near.size.array() + kBlock - 1) / kBlock;
    const float half = 0.5f * std::sqrt(3.0f) * float(kBlock) * near.step;
    for (int block = 0; block < blocks.prod(); ++block) {
        const Vector3i at(block % blocks.x(), block / blocks.x() % blocks.y(),
                          block / blocks.x() / blocks.y());
        const Vector3i low = kBlock * at, high = (low.array() + kBlock).min(near.size.array());
        const Vector3f middle =
            near.first_V + near.step * (low.cast<float>() + Vector3f::Constant(0.5f * kBlock));
        if (!nearest(middle, near.reach + half)) continue;
        for (int k = low.z(); k < high.z(); ++k)
            for (int j = low.y(); j < high.y(); ++j)
                for (int i = low.x(); i < high.x(); ++i) {
                    const Vector3f p = near.first_V + near.step * Vector3f(float(i), float(j), float(k));
                    const auto next = nearest(p, near.reach + half);
                    if (!next) continue;
                    const Vector3f& colour = colours.at(next->structure);
                    near.samples[size_t(i + near.size.x() * (j + near.size.y() * k))] = {
                        byteOf(colour.x()), byteOf(colour.y()), byteOf(colour.z()),
                        byteOf(next->distance / near.reach)};
                }
    }
    return near;
}

float shineThrough(float thickness) {
    const float least = std::exp(-kShineReach / kShineLength);
    const float through = std::exp(-std::max(thickness, 0.0f) / kShineLength);
    return kMostShine * std::max(through - least, 0.0f) / (1 - least);
}

const std::array<Vector3f, kThicknessColours>& thicknessColours() {
    static const std::array<Vector3f, kThicknessColours> kColours = {
        Vector3f(0.50f, 0.01f, 0.03f), Vector3f(0.85f, 0.20f, 0.02f), Vector3f(0.95f, 0.72f, 0.05f),
        Vector3f(0.42f, 0.80f, 0.62f), Vector3f(0.10f, 0.38f, 0.78f)};
    return kColours;
}

}  // namespace bonemill
