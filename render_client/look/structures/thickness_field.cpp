#include "render_client/look/structures/thickness_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace bonemill {
namespace {

constexpr float kFinest = 4e-4f;  // m
constexpr int kBlock = 4;         // samples: one look says whether any of a block is near

}  // namespace

ThicknessField thicknessField(const StructureSet& structures, double reach) {
    ThicknessField field;
    const Eigen::AlignedBox3f box = structures.box();
    if (box.isEmpty() || !(reach > 0)) return field;
    field.reach = float(reach);
    const Eigen::Vector3f margin = Eigen::Vector3f::Constant(field.reach);
    const Eigen::Vector3f wide = box.sizes() + 2 * margin;
    field.first_V = box.min() - margin;
    field.step = std::max(kFinest, wide.maxCoeff() / float(ThicknessField::kMaxPerAxis - 2));
    const auto sizeOf = [&wide](float step) {
        return Eigen::Vector3i((wide / step).array().ceil().cast<int>().matrix() + Eigen::Vector3i::Ones());
    };
    while (sizeOf(field.step).cast<int64_t>().prod() > ThicknessField::kMaxSamples) field.step *= 1.05f;
    field.size = sizeOf(field.step);
    field.shares.assign(size_t(field.size.prod()), 255);
    const Eigen::Vector3i blocks = (field.size.array() + kBlock - 1) / kBlock;
    const float half = 0.5f * std::sqrt(3.0f) * float(kBlock) * field.step;
    for (int block = 0; block < blocks.prod(); ++block) {
        const Eigen::Vector3i at(block % blocks.x(), block / blocks.x() % blocks.y(),
                                 block / blocks.x() / blocks.y());
        const Eigen::Vector3i low = kBlock * at, high = (low.array() + kBlock).min(field.size.array());
        const Eigen::Vector3f middle =
            field.first_V + field.step * (low.cast<float>() + Eigen::Vector3f::Constant(0.5f * kBlock));
        if (structures.distance(middle, field.reach + half) >= field.reach + half) continue;
        for (int k = low.z(); k < high.z(); ++k)
            for (int j = low.y(); j < high.y(); ++j)
                for (int i = low.x(); i < high.x(); ++i) {
                    const Eigen::Vector3f p =
                        field.first_V + field.step * Eigen::Vector3f(float(i), float(j), float(k));
                    const float share = structures.distance(p, field.reach) / field.reach;
                    field.shares[size_t(i + field.size.x() * (j + field.size.y() * k))] =
                        uint8_t(std::lround(255 * share));
                }
    }
    return field;
}

}  // namespace bonemill
