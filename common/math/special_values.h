#pragma once

#include <limits>

namespace bonemill::pinned {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace bonemill::pinned
