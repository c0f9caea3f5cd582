#include "haptic_server/app/state_hash.h"

#include <bit>

namespace bonemill {

static_assert(std::endian::native == std::endian::little, "the digest is defined over little-endian bytes");

void StateHash::addBytes(const void* data, size_t size) noexcept {
    constexpr uint64_t kFnvPrime = 1099511628211ull;
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * kFnvPrime;
}

void StateHash::addRecord(const TickRecord& record) noexcept {
    const auto add = [this](const auto& field) { addBytes(&field, sizeof field); };
    add(record.tick), add(record.t_s);
    add(record.p_WT), add(record.q_WT), add(record.p_WT_device), add(record.q_WT_device);
    add(record.f_hand_W), add(record.t_hand_W);
    add(record.max_penetration), add(record.contacts);
    add(record.removed_voxels), add(record.added_voxels), add(record.buttons), add(record.faults);
}

void StateHash::addVolume(const VoxelVolume& volume) noexcept {
    const Eigen::Vector3i& dims = volume.dims();
    for (int k = 0; k < dims.z(); ++k)
        for (int j = 0; j < dims.y(); ++j) {
            const size_t row = volume.offset(0, j, k);
            for (int i = 0; i < dims.x(); ++i) {
                const Density density = volume.at(row + size_t(i));
                addBytes(&density, sizeof density);
            }
        }
}

}  // namespace bonemill
