// Box of integer indices, both ends included; empty when any min > max.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace bonemill {

struct IndexBox {
    Eigen::Vector3i min = Eigen::Vector3i::Constant(1);
    Eigen::Vector3i max = Eigen::Vector3i::Zero();

    bool isEmpty() const noexcept { return (min.array() > max.array()).any(); }
    bool contains(const Eigen::Vector3i& index) const noexcept {
        return (index.array() >= min.array()).all() && (index.array() <= max.array()).all();
    }
    void include(const Eigen::Vector3i& index) noexcept {
        if (isEmpty()) {
            min = max = index;
            return;
        }
        min = min.cwiseMin(index);
        max = max.cwiseMax(index);
    }
    void include(const IndexBox& other) noexcept {
        if (other.isEmpty()) return;
        include(other.min);
        include(other.max);
    }
    int64_t count() const noexcept {
        return isEmpty() ? 0 : (max - min + Eigen::Vector3i::Ones()).cast<int64_t>().prod();
    }
    IndexBox grown(int steps) const noexcept { return {min.array() - steps, max.array() + steps}; }
    IndexBox clamped(const Eigen::Vector3i& low, const Eigen::Vector3i& high) const noexcept {
        return {min.cwiseMax(low), max.cwiseMin(high)};
    }
};

// Its place in a box that begins at 0 and has `size` indices per axis, x fastest.
inline size_t placeIn(const Eigen::Vector3i& size, const Eigen::Vector3i& index) noexcept {
    return size_t(index.x()) + size_t(size.x()) * (size_t(index.y()) + size_t(size.y()) * size_t(index.z()));
}

template <class Visit>
void forEachIndex(const IndexBox& box, Visit&& visit) {
    for (int k = box.min.z(); k <= box.max.z(); ++k)
        for (int j = box.min.y(); j <= box.max.y(); ++j)
            for (int i = box.min.x(); i <= box.max.x(); ++i) visit(Eigen::Vector3i(i, j, k));
}

}  // namespace bonemill
