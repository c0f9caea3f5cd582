// Rounds places down to indices, as std::floor does where the result fits an int. It is quicker: the baseline
// of x86-64 has no instruction for that. RT-safe.
#pragma once

#include <Eigen/Core>

namespace bonemill {

template <class Scalar>
int floorIndex(Scalar place) noexcept {
    const int towards_zero = int(place);
    return towards_zero - int(place < Scalar(towards_zero));
}
template <class Derived>
Eigen::Vector3i floorIndices(const Eigen::MatrixBase<Derived>& place) noexcept {
    return {floorIndex(place.x()), floorIndex(place.y()), floorIndex(place.z())};
}

}  // namespace bonemill
